// What a mesh file may ask for before reading stops. A file's size bounds most of what a reader allocates; these bound
// the rest, where a small file can describe something huge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vantage::internal::core {

struct ReadLimits {
  /// Those of a tile of 3D Tiles: it is a part of a city, made by a stranger, and a tileset has thousands of them.
  static ReadLimits of_tiles() {
    ReadLimits limits;
    limits.decompressed_bytes = std::uint64_t{512} << 20;
    limits.json_bytes = std::uint64_t{1} << 30;  // of all tilesets together that contain each other
    return limits;
  }

  /// Decompressed bytes of one file. A whole city of 100 million triangles is about 4 GB as OBJ.
  std::uint64_t decompressed_bytes = std::uint64_t{4} << 30;

  /// gzip can make a thousand bytes of one. Meshes of real places become 3 to 10 times as large. Of a file of n bytes
  /// at most 64 MiB + 32 n are decompressed. So the memory that reading takes has a bound in proportion to n, beside
  /// that for the 64 MiB.
  std::uint64_t most_decompressed(std::uint64_t compressed) const {
    return std::min(decompressed_bytes, (std::uint64_t{64} << 20) + 32 * compressed);
  }

  /// Triangles that a glTF file may have beyond what its buffers have room for, and a CityJSON file beyond what its own
  /// size has: nodes may repeat one mesh without end, and so may instances of a template. Ten million take up to 0.9
  /// GB.
  std::size_t repeated_triangles = 10'000'000;

  /// Values in the JSON part of a glTF file, or in a CityJSON file. A city of 100,000 buildings has about 2 million as
  /// glTF, and about 20 million as CityJSON.
  std::size_t json_values = 20'000'000;

  /// Memory that the parsed JSON may take, as far as it can be told. Numbers take 32 bytes, empty objects 200.
  std::uint64_t json_bytes = std::uint64_t{5} << 28;

  /// Metres in one unit of the mesh: to tell which of its polygons are flat.
  double unit_m = 1;

  /// Whether quadrilaterals that are not flat become the triangles of both their diagonals: as blockers, and not as
  /// what is allowed or claimed.
  bool both_diagonals = true;

  /// Corners of one polygon: the time to triangulate it may grow with the square.
  std::size_t corners = 16'384;
};

/// Farthest coordinate in the scene frame, in metres. The Earth fits 150 times over and a double still resolves 0.1 um;
/// what lies beyond is a wrong scale or garbage, and its square or cube would overflow further on.
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace vantage::internal::core
