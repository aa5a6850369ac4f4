// Merging coplanar neighbouring triangles into convex polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::scene {

struct ConvexPolygons {
  std::vector<std::uint32_t> first;     ///< per polygon, into `vertices`; one more than there are polygons
  std::vector<std::uint32_t> vertices;  ///< in order round each polygon: its corners
  std::vector<std::uint32_t> object;    ///< per polygon

  std::size_t count() const { return object.size(); }
};

/// Greedy, along the longest shared edge first (which is most often the diagonal of a wall). Only triangles of one
/// object are merged, whichever way they are turned. Counts open, non-manifold and misoriented edges into `statistics`.
/// `triangles` index welded `vertices`; none is degenerate, none is there twice. Cost: O(n log n).
///
/// No polygon hides less than its triangles by more than rounding: each of their corners is within `slack_m` of its
/// plane, and in that plane within twice the slack of its outline. Nor does it hide more than that: of a vertex that is
/// no corner of the polygon the outline passes outside by `slack_m` at most. That should be what rounding moves
/// vertices by that were meant to be in one plane, or on one line.
ConvexPolygons merge_coplanar(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                              const std::vector<std::uint32_t>& object_of, double slack_m, SceneStatistics& statistics);

}  // namespace vantage::internal::scene
