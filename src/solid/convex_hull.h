// The convex hull of points, exactly.
#pragma once

#include <span>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// The boundary of the convex hull of points: closed, outward oriented, two triangles to an edge. First, coordinates
/// nearer to 0 than 1e-40 become 0, since products of them would underflow. Of the points after that: the vertices are
/// some of them, bit for bit, in their order; no point lies outside of any facet, and no facet is without area, both
/// exactly, whatever lies nearly in one plane or on one line. Empty where all points lie in a plane. The coordinates
/// must be finite, and below 1e60. Cost: O(n log n) expected.
Mesh convex_hull(std::span<const Vec3> points);

}  // namespace vantage::internal::solid
