#include "maps/city/ground.h"

#include <algorithm>
#include <limits>

#include "core/format.h"
#include "maps/terrain/height_grid.h"
#include "maps/terrain/triangulate.h"
#include "vantage/error.h"

namespace vantage::internal::city {
Ground Ground::plane(const Vec2& min, const Vec2& max) {
  Ground ground;
  ground.plane_.vertices = {{min.x(), min.y(), 0}, {max.x(), min.y(), 0}, {max.x(), max.y(), 0}, {min.x(), max.y(), 0}};
  ground.plane_.triangles = {{0, 1, 2}, {0, 2, 3}};
  ground.vertical_ = kFlatGround;
  return ground;
}

Ground Ground::from_file(const std::filesystem::path& file, const geo::LocalFrame& frame, const Vec2& min,
                         const Vec2& max, double max_error_m, std::vector<std::string>& notes,
                         const Progress& progress) {
  const terrain::HeightGrid grid = terrain::read_height_grid(file, terrain::Window{frame.origin(), min, max}, progress);
  terrain::Triangulation triangulation = terrain::triangulate(grid, frame, min, max, max_error_m, progress);
  const std::string name = file.filename().string();
  if (grid.voids > 0) {
    notes.push_back(std::to_string(grid.voids) + " posts of " + name +
                    " had no height and were filled from their neighbours");
  }
  notes.push_back(core::format("the ground is {} triangles for {} posts of {}, off by at most {:.2f} m",
                               triangulation.surface.mesh().triangles.size(), triangulation.posts, name,
                               triangulation.largest_error_m));
  Ground ground;
  ground.surface_ = std::move(triangulation.surface);
  ground.vertical_ = grid.vertical.empty() ? "as in " + name : grid.vertical;
  return ground;
}

scene::TriangulatedTerrain::Range Ground::range(const std::vector<Footprint>& footprints) const {
  if (!surface_) return {0, 0};
  const double infinity = std::numeric_limits<double>::infinity();
  scene::TriangulatedTerrain::Range all{infinity, -infinity};
  for (const Footprint& footprint : footprints) {
    const auto range = surface_->range(footprint.outer);
    if (!range) {
      throw Error(ErrorCode::internal_defect, "the ground does not reach under an outline", "", "please report this");
    }
    all = {std::min(all.lowest, range->lowest), std::max(all.highest, range->highest)};
  }
  return all;
}

double Ground::height(const Vec2& at) const {
  if (!surface_) return 0;
  const auto height = surface_->height(at);
  if (!height)
    throw Error(ErrorCode::internal_defect, "the ground does not reach under a point", "", "please report this");
  return *height;
}

const Mesh& Ground::mesh() const { return surface_ ? surface_->mesh() : plane_; }

const std::string& Ground::vertical() const { return vertical_; }

}  // namespace vantage::internal::city
