#include "mission/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "vantage/error.h"

namespace vantage::mission_io {
namespace {

namespace fs = std::filesystem;

}  // namespace

bool is_obj(const fs::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name.ends_with(".obj") || name.ends_with(".obj.gz");
}

void check_readable(const fs::path& file, const std::string& what, const std::string& where) {
  const std::string place = where.empty() ? file.string() : where + " (" + file.string() + ")";
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    throw Error(ErrorKind::input, what + " does not exist", place,
                where.empty() ? "check the path" : "check the path; it starts from the mission file's folder");
  }
  if (error) throw Error(ErrorKind::input, what + " cannot be reached: " + error.message(), place, "check the path");
  if (fs::is_directory(status)) {
    throw Error(ErrorKind::input, what + " is a folder", place, "name a file in it");
  }
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorKind::input, what + " is not a regular file", place,
                "name a file on disk, not a pipe or a device");
  }
  if (::access(file.c_str(), R_OK) != 0) {
    throw Error(ErrorKind::input, what + " cannot be read: " + std::strerror(errno), place,
                "change its permissions, or name another file");
  }
}

}  // namespace vantage::mission_io
