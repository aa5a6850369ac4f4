// The ground of a scene from a raster of heights, and what is said of it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "scene/triangulated_terrain.h"
#include "vantage/progress.h"

namespace vantage::internal::terrain {

struct RasterGround {
  scene::TriangulatedTerrain surface;
  std::string vertical;  ///< what the raster's heights are measured from; "as in dem.tif" where it does not say it
};

/// The triangles over the rectangle [min, max] of the frame, metres. `moved` may change the heights before they become
/// triangles; empty: they stay. Throws as read_height_grid and triangulate do. `notes` gets what was filled and how
/// closely the triangles follow.
RasterGround ground_from_raster(const std::filesystem::path& file, const geo::LocalFrame& frame,
                                const Eigen::Vector2d& min, const Eigen::Vector2d& max, double max_error_m,
                                const std::function<void(HeightGrid& grid)>& moved, std::vector<std::string>& notes,
                                const Progress& progress);

/// What the heights of a grid are measured from; "as in dem.tif" where the file does not say it.
std::string level_of(const HeightGrid& grid);

}  // namespace vantage::internal::terrain
