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

  /// Whether no point of any triangle, about the centre, keeps less than the limits, which the floor lies farther out
  /// than. `is_asked` of each triangle: not of those in the target's plane. Cost: a
  /// few planes for most vertices and triangles, all of a body's for those that no single plane tells from it.
  bool holds(const Mesh& mesh, const std::function<bool(std::size_t)>& is_asked) const;

 private:
  bool is_beyond_kept(const Vec3& point) const;
  bool is_apart(std::uint32_t body, const std::array<Vec3, 3>& corners) const;

  const Floor& floor_;
  std::vector<double> reach_;  ///< of each body that is taken away: how far from the centre it is, where in front
};

}  // namespace vantage::internal::exact
