// The connected pieces of a closed mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/labelled_mesh.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

struct Piece {
  std::size_t vertices = 0, facets = 0;
  long euler = 0;        ///< V - E + F: 2 for a topological sphere, 2 less for each handle
  double volume_m3 = 0;  ///< negative for a cavity
  double area_m2 = 0;
};

struct Pieces {
  std::vector<Piece> pieces;            ///< in the order of their first triangles
  std::vector<std::uint32_t> piece_of;  ///< per triangle
};

/// Triangles that share a vertex are of one piece. The mesh must be closed with two triangles to an edge, as to_mesh
/// and the engines make it. Linear time.
VANTAGE_INTERNAL_API Pieces find_pieces(const Mesh& mesh);

/// Removes pieces that are thinner than `thickness_m` (volume over area), what booleans do not resolve, and those that
/// are inside out and in no other one. Cavities stay: to fill one would add space. Vertices that nothing uses any more
/// go too. Cost: linear for each piece that is inside out.
VANTAGE_INTERNAL_API void drop_slivers(LabelledMesh& labelled, double thickness_m);

/// Numbers the vertices anew, in their order, without those that no triangle uses.
void drop_unused_vertices(Mesh& mesh);

}  // namespace vantage::internal::core
