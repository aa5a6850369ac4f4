// Triangles of rings in the plane: constrained Delaunay with CDT.
#pragma once

#include <vector>

#include "maps/city/grid_rings.h"
#include "vantage/geometry.h"

namespace vantage::internal::city {

/// Counter-clockwise triangles of the space inside an odd number of rings; corners counted over all rings in turn. The
/// rings may touch in corners, not cross. Corners in one place count as one: the first. Throws Error(internal) when the
/// rings cross after all. Cost: O(n log n).
std::vector<Triangle> triangulate(const std::vector<GridRing>& rings);

}  // namespace vantage::internal::city
