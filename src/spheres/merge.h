// Few large facets in place of many small ones, where a sphere mesh is flat or follows the range.
//
// A plane is affine in (u, v, inverse depth) over a face of the cube map, so a wall that fills a thousand texels needs
// no thousand facets. Rectangles of cells are halved until the inverse depths of all their vertices are affine to
// within the tolerance, or all are at the range and the rectangle is small; cells that are left join into strips one
// cell wide. Vertices that a finer neighbour uses on the border are kept on both sides, so that no gap opens.
// docs/spheres.md has the bound.
#pragma once

#include <cstdint>
#include <vector>

#include "spheres/star_mesh.h"

namespace vantage::internal::spheres {

/// The vertices of one face as a grid of cells x cells quadrilaterals.
struct FaceGrid {
  int cells = 0;
  double step = 0;                    ///< side of a cell on the cube of half side 1
  std::vector<std::uint32_t> vertex;  ///< (cells + 1)^2 of them, row by row: the star's vertices
};

struct MergeRules {
  double tolerance = 0;        ///< how far a facet may lie from those it replaces, as a part of its distance; < 0.1
  bool is_inward = false;      ///< facets only move towards the viewpoint: the vertices of what was joined are drawn in
  bool keeps_borders = false;  ///< every vertex on a face's border is used by facets beyond it
};

/// Appends the facets of the six faces to `star`. Cost: O(n^2 log n) in the
/// cells along a face's side; the faces in parallel.
void add_merged_facets(StarMesh& star, const std::vector<FaceGrid>& faces, const MergeRules& rules);

/// Drops the vertices that no facet uses.
void drop_unused_vertices(StarMesh& star);

}  // namespace vantage::internal::spheres
