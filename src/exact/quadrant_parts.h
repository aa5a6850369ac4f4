// A polygon as the octahedral map cuts it.
#pragma once

#include <algorithm>

#include "core/facet_polygon.h"
#include "exact/octahedral_map.h"

namespace vantage::internal::exact {

/// Calls visit(quadrant, part) with what of a polygon is in each quadrant, where that is something. `part` and
/// `scratch` are for reuse.
template <typename Visit>
void for_each_quadrant(const core::FacetPolygon& polygon, core::FacetPolygon& part, core::FacetPolygon& scratch,
                       const Visit& visit) {
  const auto lies_on = [&](Eigen::Index axis, double sign) {
    return std::all_of(polygon.corners.begin(), polygon.corners.end(),
                       [&](const Vec3& corner) { return sign * corner[axis] > 0; });
  };
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    const double x = quadrant & 1 ? -1 : 1, y = quadrant & 2 ? -1 : 1;
    if (lies_on(0, x) && lies_on(1, y)) return visit(quadrant, polygon);
  }
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    part = polygon;
    core::clip_facet(part, {quadrant & 1 ? -1.0 : 1.0, 0, 0}, 0, 0, core::FacetPolygon::kFar, scratch);
    if (part.empty()) continue;
    core::clip_facet(part, {0, quadrant & 2 ? -1.0 : 1.0, 0}, 0, 0, core::FacetPolygon::kFar, scratch);
    if (!part.empty()) visit(quadrant, part);
  }
}

}  // namespace vantage::internal::exact
