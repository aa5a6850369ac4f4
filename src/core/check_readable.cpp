#include <algorithm>
#include <cstring>
#include <system_error>

#include "common/input.h"
#include "core/system_files.h"
#include "vantage/error.h"

namespace vantage {

namespace fs = std::filesystem;

void check_readable(const fs::path& file, const std::string& what, const std::string& where) {
  const std::string place = where.empty() ? file.string() : where + " (" + file.string() + ")";
  if (file == "-") {
    throw Error(ErrorCode::stdin_not_possible, what + " cannot come from standard input", place,
                "name a file; only a command's MISSION and the POINTS of query may be -");
  }
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    throw Error(
        ErrorCode::file_not_found, what + " does not exist", place,
        where.empty() ? "check the path" : "check the path; it starts from the folder of the file that names it");
  }
  if (error)
    throw Error(ErrorCode::file_unreadable, what + " cannot be reached: " + error.message(), place, "check the path");
  if (fs::is_directory(status)) {
    const fs::path tileset = file / "tileset.json";
    throw Error(ErrorCode::not_a_file, what + " is a folder", place,
                fs::exists(tileset, error) ? "name the file in it: " + tileset.string() : "name a file in it");
  }
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorCode::not_a_file, what + " is not a regular file", place,
                "name a file on disk, not a pipe or a device");
  }
  if (const int denied = internal::core::access_error(file, internal::core::Access::read)) {
    throw Error(ErrorCode::file_unreadable, what + " cannot be read: " + std::strerror(denied), place,
                "change its permissions, or name another file");
  }
}

bool is_obj(const fs::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name.ends_with(".obj") || name.ends_with(".obj.gz");
}

}  // namespace vantage
