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
/// its own. At an edge with more than two triangles those stay together that have the same owners at its ends; of the
/// others, and without owners, those that enclose the solid between them. `owners`: a number for each corner of each
/// triangle, say its vertex before welding; or none. The mesh must be closed. Vertices that are new come last. An edge
/// may be left with more than two triangles, where a fan runs along it twice (see split_shared_edges). Cost: linear,
/// but for sorting the edges at each vertex.
void split_where_pieces_touch(Mesh& mesh, const std::vector<Triangle>& owners = {});

/// Pairs of triangles on the same three vertices, by index, that face each other, one after the other; no triangle
/// twice. Of a closed mesh both may go: that changes neither whether it is closed, nor what it encloses. Cost: O(n log
/// n).
std::vector<std::uint32_t> facing_facets(const std::vector<Triangle>& triangles);

struct SplitEdges {
  std::vector<std::uint32_t> part_of;  ///< for each triangle that is new the one that it is a part of
  bool is_done = true;                 ///< two triangles meet at every edge
};
/// Where an edge of a closed mesh has more than two triangles each pair of them but one gets a vertex of its own in the
/// middle of the edge, to rounding: then two triangles meet at every edge by index, in opposite directions. Vertices
/// and triangles that are new come last. No point of the surface moves by more than a rounding of its coordinates. Not
/// done is what triangles that face each other on the same vertices hinder: take out facing_facets() first. What is not
/// done is closed all the same. Cost: linear.
SplitEdges split_shared_edges(Mesh& mesh);

}  // namespace vantage::internal::core
