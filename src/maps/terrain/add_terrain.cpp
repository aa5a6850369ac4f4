// add_terrain: a raster of heights as the ground of a scene that has none, such as a tileset of buildings.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "geo/ellipsoid.h"
#include "geo/local_frame.h"
#include "maps/terrain/post_positions.h"
#include "maps/terrain/raster_ground.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage {
namespace internal::terrain {
namespace {

namespace fs = std::filesystem;

void check(const Scene& scene, const fs::path& raster, const TerrainOptions& options) {
  if (!scene.georeference) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, so no raster fits it",
                raster.string(),
                "leave out the terrain, or name the coordinate reference system of the scene's metres");
  }
  if (scene.mesh.empty()) throw Error(ErrorCode::nothing_given, "the scene has no triangles", raster.string(), "");
  const auto is_length = [](double value) { return value >= 0 && value <= geo::kFarthestM; };
  if (!is_length(options.max_error_m) || !is_length(options.margin_m) || !is_length(options.reach_m) ||
      std::abs(options.sea_level_z_m.value_or(0)) > geo::kFarthestM) {
    throw Error(ErrorCode::value_out_of_range, "the options of the terrain are not lengths up to 100 km",
                raster.string(), "give metres");
  }
}

/// What is added to the raster's heights, so that they are measured as those of the scene.
double rise_of(const std::string& level, const Scene& scene, const TerrainOptions& options, const fs::path& raster,
               std::vector<std::string>& notes) {
  const std::string& vertical = scene.georeference->vertical;
  const std::string name = raster.filename().string();
  const bool is_ellipsoidal = level.find("ellipsoid") != std::string::npos;
  if (is_ellipsoidal && vertical == geo::kEllipsoidalHeight) return 0;
  const auto sea_level = options.sea_level_z_m ? options.sea_level_z_m : geo::sea_level_z_m(vertical);
  if (is_ellipsoidal || !sea_level) {
    throw Error(ErrorCode::height_unknown,
                "the heights of " + name + " are measured from another level (" + level + ") than the scene's (" +
                    (vertical.empty() ? "unknown" : vertical) + ")",
                raster.string(),
                is_ellipsoidal
                    ? "give a raster with heights above the sea level, or one for the scene's level"
                    : "give the z of the mean sea level in the scene as sea_level: in a tileset on the earth how "
                      "high the geoid lies above the ellipsoid there (its undulation)");
  }
  notes.push_back(core::format("the heights of {} ({}) are {} to be above the mean sea level, which is at z = {:.6g} m",
                               name, level, geo::sea_level_z_m(level) ? "known" : "taken", *sea_level));
  return *sea_level;
}

/// Of a frame that touches the ellipsoid, where the ground falls away from it.
class Bend {
 public:
  explicit Bend(const geo::LocalFrame& frame) : frame_(frame), tangent_(frame.origin()) {}

  /// z of a point of the map that is `height_m` above the ellipsoid.
  double z(const Eigen::Vector2d& place, double height_m) const {
    return tangent_.to_local(geo::to_ecef({frame_.to_lonlat(place), height_m})).z();
  }
  /// The point on the vertical of that place of the map which has this z.
  Vec3 at(const Vec3& on_map) const {
    const geo::LonLat place = frame_.to_lonlat(on_map.head<2>());
    const Vec3 foot = tangent_.to_local(geo::to_ecef({place, 0}));
    const Vec3 up = tangent_.to_local(geo::to_ecef({place, 1})) - foot;
    Vec3 point = foot + up * ((on_map.z() - foot.z()) / up.z());
    point.z() = on_map.z();
    return point;
  }

 private:
  const geo::LocalFrame& frame_;
  geo::TangentFrame tangent_;
};

/// The middle one of the heights of the objects' lowest vertices above the ground.
std::string words_on_feet(const Scene& scene, const Mesh& ground) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> lowest(std::max<std::size_t>(scene.objects.size(), 1), kNone);
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    std::uint32_t& best = lowest[scene.object_of[i]];
    for (const std::uint32_t corner : scene.mesh.triangles[i]) {
      if (best == kNone || scene.mesh.vertices[corner].z() < scene.mesh.vertices[best].z()) best = corner;
    }
  }
  const scene::TriangulatedTerrain surface(ground);
  std::vector<double> heights;
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    const ObjectKind kind = i < scene.objects.size() ? scene.objects[i].kind : ObjectKind::other;
    if (lowest[i] == kNone || kind == ObjectKind::ground || kind == ObjectKind::surface) continue;
    const Vec3& foot = scene.mesh.vertices[lowest[i]];
    if (const auto level = surface.height(foot.head<2>())) heights.push_back(foot.z() - *level);
  }
  if (heights.empty()) return {};
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return core::format(
      "the lowest points of {} objects lie {:.2f} m above this ground in the median: far from 0 the level "
      "or the sea_level is not right",
      heights.size(), *middle);
}

}  // namespace
}  // namespace internal::terrain

void add_terrain(Scene& scene, const std::filesystem::path& raster, const TerrainOptions& options,
                 const Progress& callback) {
  using namespace internal;
  terrain::check(scene, raster, options);
  const geo::LocalFrame frame({scene.georeference->longitude_deg, scene.georeference->latitude_deg});
  const bool is_tangent = scene.georeference->source_crs == geo::kEarthCentred;
  const terrain::Bend bend(frame);
  const core::ProgressReporter progress(callback, raster.string());
  const Box box = bounding_box(scene.mesh);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(options.margin_m),
                        reach = Eigen::Vector2d::Constant(options.reach_m);
  const Eigen::Vector2d min = (box.min.head<2>() - margin).cwiseMin(-reach),
                        max = (box.max.head<2>() + margin).cwiseMax(reach);

  std::vector<std::string> notes;
  const auto moved = [&](terrain::HeightGrid& grid) {
    const double rise = terrain::rise_of(terrain::level_of(grid), scene, options, raster, notes);
    const std::vector<Eigen::Vector2d> places =
        is_tangent ? terrain::post_positions(grid, frame) : std::vector<Eigen::Vector2d>();
    for (std::vector<float>* const heights : {&grid.heights_m, &grid.lowest_m}) {
      for (std::size_t i = 0; i < heights->size(); ++i) {
        progress.tick();
        const double height = (*heights)[i] + rise;
        (*heights)[i] = static_cast<float>(is_tangent ? bend.z(places[i], height) : height);
      }
    }
  };
  terrain::RasterGround ground = terrain::ground_from_raster(
      raster, frame, min, max, options.max_error_m, {"", options.heights, options.missing}, moved, notes, callback);
  Mesh mesh = ground.surface.mesh();
  for (Mesh* const sheet : {&mesh, &ground.beneath}) {
    if (!is_tangent) break;
    for (Vec3& vertex : sheet->vertices) vertex = bend.at(vertex);
  }
  const auto own = std::count_if(scene.objects.begin(), scene.objects.end(),
                                 [](const SceneObject& object) { return object.kind == ObjectKind::ground; });
  if (own > 0) {
    notes.push_back(
        core::format("the scene has ground of its own, {} objects: heights above the ground are measured "
                     "from both",
                     own));
  }
  if (std::string feet = terrain::words_on_feet(scene, mesh); !feet.empty()) notes.push_back(std::move(feet));
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  terrain::append_object(scene, mesh, {"ground", "", ObjectKind::ground});
  terrain::add_voids(scene, object, options.missing, std::move(ground.ledger), ground.beneath);
  scene.notes.insert(scene.notes.end(), notes.begin(), notes.end());
}

}  // namespace vantage
