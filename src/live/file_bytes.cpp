#include "live/file_bytes.h"

#include <fstream>
#include <iterator>

#include "vantage/error.h"

namespace vantage::live {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw Error(ErrorCode::file_unreadable, "the file cannot be read", file.string(), "try again");
  return bytes;
}

}  // namespace vantage::live
