// One file out of a zip archive that is in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vantage::internal::io {

/// Why there is no such file, or why it cannot be read.
struct ZipProblem : std::exception {
  enum class Kind { damaged, too_large, missing };  ///< missing: the archive is right, and has no such file
  explicit ZipProblem(std::string why, Kind which = Kind::damaged) : text(std::move(why)), kind(which) {}
  const char* what() const noexcept override { return text.c_str(); }

  std::string text;  ///< ends a sentence about the archive: "it is cut off"
  Kind kind;
};

/// Whether it begins as an archive does.
bool is_zip(std::string_view bytes);

/// The file of that name in the outermost folder; else the first one in the archive whose name ends so, in upper or
/// lower case. Stored and deflated files are read, and their checksum is compared. No more than `most_bytes` are made,
/// whatever the archive says of itself. Throws ZipProblem.
std::string unzipped(std::string_view archive, std::string_view name, std::string_view extension,
                     std::uintmax_t most_bytes);

/// The files in the archive whose names end so, in upper or lower case, without the notes that macOS puts beside files.
/// Throws ZipProblem.
std::vector<std::string> names_in_zip(std::string_view archive, std::string_view extension);

/// What the first file of an archive begins with, up to `most_bytes`; of the archive's own beginning alone. Empty for
/// what is none, or is packed by another method than "deflate".
std::string first_file_begins(std::string_view archive_begins, std::size_t most_bytes);

}  // namespace vantage::internal::io
