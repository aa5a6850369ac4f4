// From posts to triangles.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "scene/triangulated_terrain.h"
#include "vantage/progress.h"

namespace vantage::internal::terrain {

using scene::Incline;
using scene::TriangulatedTerrain;

/// A triangulated irregular network of the part of the grid over the rectangle [min, max] of the frame, in metres,
/// which it covers exactly. Along its border the grid is bilinear. Between posts its cells have straight sides, and are
/// folded along the diagonal that is higher in the middle: what is there is not known, and the higher ground hides
/// more.
struct Triangulation {
  TriangulatedTerrain surface;
  double largest_error_m = 0;  ///< vertical, measured at all posts in the window and where its border crosses the grid
  std::size_t posts = 0;       ///< posts in the window
};

/// Posts are inserted greedily, worst first, into a Delaunay triangulation (Garland and Heckbert, "Fast polygonal
/// approximation of terrains and height fields", 1995, algorithm IV) until none differs by more than `max_error_m`
/// (>= 0; 0 keeps every post that is not in the plane of its neighbours), and none lies above its triangle. Nor does
/// the middle of a side or of a higher diagonal differ by more, in cells away from the border: whatever the frame, it
/// is the same ground. Posts within 1 cm of the border count as on it. Throws Error(input) for a rectangle without an
/// area or one that the grid does not cover; Error(cancelled). Cost: about n log n in the posts, see docs/terrain.md.
Triangulation triangulate(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& min,
                          const Eigen::Vector2d& max, double max_error_m, const Progress& progress = {});

}  // namespace vantage::internal::terrain
