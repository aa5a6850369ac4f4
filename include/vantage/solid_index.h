// A closed mesh that is asked many times: which points lie in it, how deep, and whether others come near.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// Immutable and cheap to copy (a shared handle); any number of threads may ask one. The solid is what the mesh winds
/// round at least once, and its surface.
class VANTAGE_API SolidIndex {
 public:
  /// Copies the mesh. An empty one holds nothing. Throws Error(input) for a mesh that is not closed, has an index out
  /// of range or a coordinate that is not finite. Cost: O(n log n) in the triangles.
  explicit SolidIndex(const Mesh& mesh);

  /// The distance of each point (scene frame, metres) from the surface: positive inside, negative outside, 0 on it;
  /// minus infinity for an empty mesh. Rounding: some 1e-15 of the mesh's size and distance. Uses the threads of the
  /// caller's arena (TBB). Throws Error(input) for a point that is not finite. Cost: O(log n) each for ordinary meshes.
  std::vector<double> depths_m(std::span<const Vec3> points) const;

  /// 1 for each point (scene frame, metres) in the solid, else 0. Points on the surface are in it. Decided exactly, by
  /// the coordinates as they are: nothing is rounded. Uses the threads of the caller's arena (TBB). Throws Error(input)
  /// for a point that is not finite, and for a mesh whose triangles turn different ways. Cost: O(n log n) in the
  /// triangles with the first call, then O(log n) for each point, and the triangles straight above it.
  std::vector<std::uint8_t> contains(std::span<const Vec3> points) const;

  /// Whether the solids, both closed sets, have a common point or come as near as `within_m`, which must be at least 0;
  /// 1e-12 of the sizes and distances is added to it for what is rounded. So "no" is certain. Cost: a search for each
  /// triangle of the one in the box of the other, until a near pair is found.
  bool comes_near(const SolidIndex& other, double within_m) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace vantage
