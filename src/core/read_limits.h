// What a mesh file may ask for before reading stops. A file's size bounds most of what a reader allocates; these bound
// the rest, where a small file can describe something huge.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::internal::core {

struct ReadLimits {
  /// Decompressed bytes of one file. A whole city of 100 million triangles is about 4 GB as OBJ.
  std::uint64_t decompressed_bytes = std::uint64_t{4} << 30;

  /// Triangles that a glTF file may have beyond what its buffers have room for, and a CityJSON file beyond what its own
  /// size has: nodes may repeat one mesh without end, and so may instances of a template. Ten million take up to 0.9
  /// GB.
  std::size_t repeated_triangles = 10'000'000;

  /// Values in the JSON part of a glTF file, or in a CityJSON file. Each takes up to 100 bytes while it is parsed; a
  /// city of 100,000 buildings has about 2 million as glTF, and about 20 million as CityJSON.
  std::size_t json_values = 20'000'000;

  /// Corners of one polygon: the time to triangulate it may grow with the square.
  std::size_t corners = 16'384;
};

/// Farthest coordinate in the scene frame, in metres. The Earth fits 150 times over and a double still resolves 0.1 um;
/// what lies beyond is a wrong scale or garbage, and its square or cube would overflow further on.
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace vantage::internal::core
