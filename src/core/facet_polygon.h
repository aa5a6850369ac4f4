// Convex polygons on a blocker's plane, cut by half-spaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/plane.h"

namespace vantage::internal::core {

/// Corners in order; edge i runs from corner i to the next one and knows what made it.
struct FacetPolygon {
  static constexpr std::uint32_t kFar = ~0u;          // beyond every range
  static constexpr std::uint32_t kHorizon = ~0u - 1;  // the target's plane

  std::vector<Vec3> corners;
  std::vector<std::uint32_t> makers;  ///< index of the plane that cut the edge, or one of the above

  bool empty() const { return corners.size() < 3; }
  void clear() {
    corners.clear();
    makers.clear();
  }
};

/// A square on the plane g . x = 1 that holds everything of it within `range` of the origin.
void make_facet_square(const Plane& plane, double range, FacetPolygon& polygon);

/// Keeps what has normal . x >= height, up to `margin`; the new edge is made by `maker`. `scratch` is for reuse.
/// Returns whether anything was cut off.
bool clip_facet(FacetPolygon& polygon, const Vec3& normal, double height, double margin, std::uint32_t maker,
                FacetPolygon& scratch);

}  // namespace vantage::internal::core
