// Files into a zip archive.
#pragma once

#include <string>
#include <vector>

namespace vantage::internal::io {

struct ZippedFile {
  std::string name;  ///< with folders before it, separated by '/'; UTF-8
  std::string bytes;
};

/// An archive of files, deflated, in the order given. The same files make the same bytes: their time is that of 1980.
/// Throws std::length_error beyond 4 GB or 65535 files.
std::string zipped(const std::vector<ZippedFile>& files);

}  // namespace vantage::internal::io
