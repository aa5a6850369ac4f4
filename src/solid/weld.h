// Joins what a file keeps apart: STL has no shared vertices, other formats repeat them at seams.
#pragma once

#include "vantage/geometry.h"

namespace vantage::solid {

/// The mesh with one vertex for each position (exactly equal coordinates, which must not be NaN), in the order of the
/// coordinates, and without the triangles that have two corners in one place. Cost: O(n log n).
Mesh welded(const Mesh& mesh);

}  // namespace vantage::solid
