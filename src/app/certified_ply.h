// What tools/check_certificate.py can read.
#pragma once

#include <filesystem>

namespace vantage::internal::app {

/// Throws Error(input) unless the file is a binary, little-endian PLY of vertices and then triangles, with nothing else
/// in it, types as vantage writes them, and a header that all programs read alike (vantage/prove.h, certificate_text).
void check_certified_ply(const std::filesystem::path& file);

}  // namespace vantage::internal::app
