// Holes in a mesh that a user hands in.
#pragma once

#include <cstddef>

#include "vantage/geometry.h"

namespace vantage::cli {

struct OpenEdges {
  std::size_t count = 0;
  Vec3 middle_of_first = Vec3::Zero();  ///< of one of them, if there is any
};

/// Edges with an odd number of triangles, where vertices at exactly the same position count as one (STL has no shared
/// vertices, other formats repeat them at seams) and triangles with two corners in one place are left out. A mesh
/// without any encloses something, even where two of its pieces touch. Cost: O(n log n).
OpenEdges find_open_edges(const Mesh& mesh);

}  // namespace vantage::cli
