// A depth cube map as a closed, genus-0 surface that is star-shaped about its viewpoint and ends at the range.
//
// Inverse depths are axial: 1 over the distance along a face's `forward` (render/depth.h). A direction d whose longest
// component is 1 lies on the cube of half side 1, and the point t d has axial depth t on its face; on an edge or a
// corner of the cube on each of the faces that meet there.
#pragma once

#include <array>
#include <span>

#include "spheres/star_mesh.h"

namespace vantage::internal::spheres {

struct CubeMap {
  int face_size = 0;                      ///< n, texels along a side
  std::span<const float> inverse_depths;  ///< 6 n n of them, as a DepthSink gets them
};

/// Joins the texels' centres, as the paper does: 6 n^2 vertices, the faces' grids stitched along the 12 edges and at
/// the 8 corners of the cube, 12 n^2 - 4 triangles; with `merge` > 0 fewer (merge.h). Over-claims where depth jumps.
/// `cube` sampled at centres.
StarMesh join_centers(const CubeMap& cube, double range_m, double merge = 0);

/// Joins the texels' corners: 6 n^2 + 2 vertices, 12 n^2 triangles; with `merge` > 0 fewer (merge.h). `cube` has the
/// nearest depth over each texel (Sampling::nearest); then no point of the solid is hidden from the viewpoint or beyond
/// the range, but for numerics::kFloor. docs/spheres.md has the proof; in short:
///   - nothing hides the points in a texel's directions whose axial depth is at most the texel's;
///   - a corner's depth is the least of the texels that meet there (4; 3 at a corner of the cube), so all four corners
///     of a texel are at most as deep as it, and with them both triangles, which cover just the texel's directions;
///   - corners are cut to the range, and chords of a ball lie in it.
/// `front`: a unit vector; texels all of whose directions are at a right angle to it or more count as empty. Right
/// where the solid is cut to the half-space before `front` afterwards.
StarMesh bound_corners(const CubeMap& cube, double range_m, const Vec3* front = nullptr, double merge = 0);

/// Longitude and latitude grid about the scene's z axis: `grid[0]` meridians, `grid[1]` bands from pole to pole:
/// grid[0] (grid[1] - 1) + 2 vertices. At least 3 and 2. `join_lonlat` takes the depth of the texel that a vertex'
/// direction falls into.
StarMesh join_lonlat(const CubeMap& cube, const std::array<int, 2>& grid, double range_m);

/// The same grid as an inner bound: a facet ends before the nearest depth of every texel that its directions touch.
/// These are not those of its cell: the edge of a facet between two points of a parallel is an arc of a great circle,
/// which bulges towards the pole, so texels are also counted to the cell below. `front` as above.
StarMesh bound_lonlat(const CubeMap& cube, const std::array<int, 2>& grid, double range_m, const Vec3* front = nullptr);

}  // namespace vantage::internal::spheres
