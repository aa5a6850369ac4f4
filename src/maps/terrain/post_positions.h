#pragma once

#include <Eigen/Core>
#include <vector>

#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"

namespace vantage::internal::terrain {

/// Where the posts of a grid lie in a frame, row by row, in metres. Each is right to 0.1 mm: of a large grid only some
/// are transformed, and the others interpolated by a polynomial that is checked at others still; where it fails the
/// check (datum shifts from grids have kinks), all are transformed. Throws as CoordinateSystem::to_lonlat.
std::vector<Eigen::Vector2d> post_positions(const HeightGrid& grid, const geo::LocalFrame& frame);

}  // namespace vantage::internal::terrain
