#include "app/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "app/yaml_tree.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string read_text(const fs::path& file, const std::string& name, std::uintmax_t most_bytes) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::file_unreadable, "the " + name + " cannot be read: " + std::strerror(errno), file.string(),
                "check its permissions");
  }
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > most_bytes) {
    throw Error(
        ErrorCode::file_too_large,
        "the " + name + " is too large: " + std::to_string(size) + " bytes, at most " + std::to_string(most_bytes),
        file.string(), "give the " + name + ", not a mesh");
  }
  // In portions: what a pipe holds is not known before.
  std::string text;
  constexpr std::size_t kPortion = 1 << 20;
  while (stream.good() && text.size() <= most_bytes) {
    const std::size_t read = text.size();
    text.resize(read + std::min<std::size_t>(kPortion, most_bytes + 1 - read));
    stream.read(text.data() + read, static_cast<std::streamsize>(text.size() - read));
    text.resize(read + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw Error(ErrorCode::file_unreadable, "the " + name + " cannot be read to its end", file.string(),
                "check the disk that it lies on");
  }
  return text;
}

}  // namespace vantage::internal::app
