// What tools/check_certificate.py can read.
#pragma once

#include <filesystem>

namespace vantage::internal::app {

/// Throws Error(input) unless the file is a binary, little-endian PLY of vertices and then triangles, with nothing else
/// in it and types as vantage writes them.
void check_certified_ply(const std::filesystem::path& file);

}  // namespace vantage::internal::app
