// Closed meshes seen from above: the ground that lies under a volume.
#pragma once

#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/slice.h"

namespace vantage {

/// All places of the plan that have a point of a closed, outward-oriented mesh above or below them: its projection
/// along z. The polygons are disjoint but for points, the largest first; places between pieces of the mesh are holes.
///
/// Outlines are rounded to a grid of 2^-28 of half the longer side of the mesh's box (1.1 um for a volume of 600 m):
/// corners move by up to that, and where outlines cross, a little of theirs is cut off or filled in, of that width.
///
/// Throws Error(input) for a mesh that is not closed or not oriented, or has an index or a coordinate that is out of
/// range; vertices in one place count as one. Cost: O(n log n) in the triangles, and what the outlines cross each
/// other.
VANTAGE_API std::vector<PlanPolygon> footprint_of_mesh(const Mesh& mesh);

}  // namespace vantage
