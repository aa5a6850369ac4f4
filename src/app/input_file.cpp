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

std::string read_text(const fs::path& file, const std::string& name) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::file_unreadable, "the " + name + " cannot be read: " + std::strerror(errno), file.string(),
                "check its permissions");
  }
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > kMaxYamlBytes) {
    throw Error(
        ErrorCode::file_too_large,
        "the " + name + " is too large: " + std::to_string(size) + " bytes, at most " + std::to_string(kMaxYamlBytes),
        file.string(), "give the " + name + ", not a mesh");
  }
  std::string text(kMaxYamlBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    throw Error(ErrorCode::file_unreadable, "the " + name + " cannot be read to its end", file.string(),
                "check the disk that it lies on");
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace vantage::internal::app
