// Joins what a file keeps apart: STL has no shared vertices, other formats repeat them at seams.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// The mesh with one vertex for each position (exactly equal coordinates, which must not be NaN), in the order of the
/// coordinates, and without the triangles that have two corners in one place. Cost: O(n log n).
Mesh welded(const Mesh& mesh);

/// For every vertex the first one at exactly the same position, and with `owners`, one for each vertex, of those with
/// the same owner. 0 and -0 are one. Cost: linear, on all threads.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3>& vertices,
                                             const std::vector<std::uint32_t>& owners = {});

/// The other way round: where facets round a vertex make several fans that only touch there, each fan gets a vertex of
/// its own. At an edge with more than two triangles those that enclose the solid between them stay together. The mesh
/// must be closed. Vertices that are new come last. Cost: linear, but for sorting the edges at each vertex.
void split_where_pieces_touch(Mesh& mesh);

}  // namespace vantage::internal::core
