#include "maps/terrain/raster_ground.h"

#include <utility>

#include "core/format.h"
#include "maps/terrain/triangulate.h"

namespace vantage::internal::terrain {

std::string level_of(const HeightGrid& grid) {
  return grid.vertical.empty() ? "as in " + grid.file.filename().string() : grid.vertical;
}

RasterGround ground_from_raster(const std::filesystem::path& file, const geo::LocalFrame& frame,
                                const Eigen::Vector2d& min, const Eigen::Vector2d& max, double max_error_m,
                                const std::function<void(HeightGrid& grid)>& moved, std::vector<std::string>& notes,
                                const Progress& progress) {
  HeightGrid grid = read_height_grid(file, Window{frame.origin(), min, max}, progress);
  if (moved) moved(grid);
  Triangulation triangulation = triangulate(grid, frame, min, max, max_error_m, progress);
  const std::string name = file.filename().string();
  if (grid.voids > 0) {
    notes.push_back(std::to_string(grid.voids) + " posts of " + name +
                    " had no height and were filled from their neighbours");
  }
  notes.push_back(core::format("the ground is {} triangles for {} posts of {}, off by at most {:.2f} m",
                               triangulation.surface.mesh().triangles.size(), triangulation.posts, name,
                               triangulation.largest_error_m));
  return {std::move(triangulation.surface), level_of(grid)};
}

}  // namespace vantage::internal::terrain
