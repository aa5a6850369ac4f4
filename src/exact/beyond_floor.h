// Whether what a mesh claims lies beyond the floor: docs/theory.md, "Limits in the chart".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "exact/floor.h"

namespace vantage::internal::exact {

/// For finished facets, whatever made them: a facet may have its corners beyond the floor and its middle before it,
/// where what is taken away has an edge, or is round.
class BeyondFloor {
 public:
  /// The floor must outlive it.
  explicit BeyondFloor(const Floor& floor);

  /// Whether all points of all triangles keep the limits; the floor lies a little farther out than these. The mesh is
  /// about the centre. Only triangles that `is_asked` says yes to are looked at: those in the target's plane begin
  /// before the floor. Cost: a few planes for most vertices and triangles, all of a body's planes for the others.
  bool holds(const Mesh& mesh, const std::function<bool(std::size_t)>& is_asked) const;

 private:
  bool is_beyond_kept(const Vec3& point) const;
  bool is_apart(std::uint32_t body, const std::array<Vec3, 3>& corners) const;
  bool is_apart_from_star(std::uint32_t body, const std::array<Vec3, 3>& corners, double nearest) const;

  const Floor& floor_;
  std::vector<double> reach_;  ///< of each body that is taken away: how far from the centre it is, where in front
};

}  // namespace vantage::internal::exact
