#include "maps/city/ground.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "maps/terrain/raster_ground.h"
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
                         const Vec2& max, double max_error_m, const terrain::HeightReading& reading,
                         std::vector<std::string>& notes, const Progress& progress) {
  terrain::RasterGround raster =
      terrain::ground_from_raster(file, frame, min, max, max_error_m, reading, {}, notes, progress);
  Ground ground;
  ground.surface_ = std::move(raster.surface);
  ground.vertical_ = std::move(raster.vertical);
  ground.beneath_ = std::move(raster.beneath);
  ground.voids_ = std::move(raster.ledger);
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

void Ground::add_to(Scene& scene, MissingPolicy missing) const {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  terrain::append_object(scene, mesh(), {"ground", "", ObjectKind::ground});
  terrain::add_voids(scene, object, missing, voids_, beneath_);
}

}  // namespace vantage::internal::city
