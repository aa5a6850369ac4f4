// How much of a target is seen from each voxel of a box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vantage/export.h"
#include "vantage/fraction.h"
#include "vantage/geometry.h"

namespace vantage {

/// A box of cubes with edges along the axes of the scene frame. Arrays of one value for each voxel run along x first,
/// then y, then z: [(k * count[1] + j) * count[0] + i].
struct VoxelGrid {
  Vec3 low = Vec3::Zero();                       ///< lowest corner of the first voxel, metres
  double step_m = 1;                             ///< edge of a voxel
  std::array<std::size_t, 3> count = {1, 1, 1};  ///< voxels along x, y and z

  std::size_t size() const { return count[0] * count[1] * count[2]; }
  /// Of the centre of voxel `index` along `axis`, 0 to 2.
  double centre(int axis, std::size_t index) const { return low[axis] + step_m * (static_cast<double>(index) + 0.5); }
  Vec3 centre(std::size_t i, std::size_t j, std::size_t k) const { return {centre(0, i), centre(1, j), centre(2, k)}; }
};

/// Throws Error(input) for a grid without voxels, with more than 2^31 of them, with an edge that is not positive and
/// finite, or with a corner that is not finite or farther than 1e9 m from the origin.
VANTAGE_API void check_grid(const VoxelGrid& grid);

/// What holds for every point of a voxel.
enum class KnownShare : std::uint8_t {
  unknown,
  none,   ///< nothing of the target is seen: it is hidden, or the voxel is behind it
  whole,  ///< nothing hides any of it
};

struct FieldOptions {
  FractionMeasure measure = FractionMeasure::area;
  /// The share is 0 where a point of the target is farther from the voxel's centre than this, metres.
  double max_range_m = std::numeric_limits<double>::infinity();
};

struct FractionField {
  VoxelGrid grid;
  std::vector<double> shares;  ///< 0 to 1, for the centre of each voxel
  std::size_t evaluated = 0;   ///< voxels whose share was found by looking from their centre
};

}  // namespace vantage
