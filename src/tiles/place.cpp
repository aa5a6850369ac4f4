#include "tiles/place.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/read_limits.h"
#include "io/mesh_file.h"
#include "io/object_text.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

// What lies on the earth is not farther from the ellipsoid, in metres: satellites and the middle of the earth are.
constexpr double kFarthestHeightM = 100e3;

// Contents should lie within the volumes of their tiles, but buildings stick out of those of some exporters by 65 m:
// tiles are read that far beyond the circle.
constexpr double kBeyondTileM = 100;

geo::LonLat lon_lat(const std::array<double, 2>& latitude_longitude) {
  return {latitude_longitude[1], latitude_longitude[0]};
}

/// The circle in the units of a plane: no smaller than the one on the earth.
Reach plane_reach(const TilesetOptions& options, const std::filesystem::path& file) {
  const geo::CoordinateSystem system(options.crs, "crs of " + file.string());
  const geo::LocalFrame frame(lon_lat(*options.center_deg));
  const Eigen::Vector2d center = system.from_lonlat(frame.origin());
  double radius = 0;
  for (int i = 0; i < 16; ++i) {
    const double angle = i * std::numbers::pi / 8;
    const Eigen::Vector2d rim = (*options.radius_m + kBeyondTileM) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    radius = std::max(radius, (system.from_lonlat(frame.to_lonlat(rim)) - center).norm());
  }
  return {center, radius * 1.01};
}

/// The middle of all corners that triangles use.
Vec3 middle_of(const Collector& collected) {
  Box box;
  for (const Triangle& triangle : collected.triangles) {
    for (const std::uint32_t corner : triangle) box.extend(collected.vertices[corner]);
  }
  return (box.min + box.max) / 2;
}

bool is_on_earth(const Vec3& point) {
  const double distance = point.norm();
  return distance > geo::kEquatorM * (1 - geo::kFlattening) - kFarthestHeightM &&
         distance < geo::kEquatorM + kFarthestHeightM;
}

/// Turns the points into the frame that touches the ellipsoid.
Georeference put_on_earth(Collector& collected, const TilesetOptions& options, const std::filesystem::path& file,
                          const core::ProgressReporter& progress) {
  const Vec3 middle = middle_of(collected);
  if (!is_on_earth(middle)) {
    throw Error(ErrorCode::not_georeferenced,
                "the tileset's bounding volume is on the earth, but what it holds lies more than 100 km above or below "
                "the ellipsoid",
                file.string(), "name the coordinate system of its metres with crs, as in EPSG:28992, or crs: none");
  }
  const geo::LonLat origin = options.center_deg ? lon_lat(*options.center_deg) : geo::from_ecef(middle).place;
  const geo::TangentFrame frame(origin);
  for (Vec3& vertex : collected.vertices) {
    progress.tick();
    vertex = frame.to_local(vertex);
  }
  for (MissingPart& part : collected.missing) {
    for (Vec3& corner : part.corners) corner = frame.to_local(corner);
  }
  return {origin.latitude_deg, origin.longitude_deg, geo::kEllipsoidalHeight, geo::kEarthCentred};
}

io::RawMesh raw_mesh(Collector&& collected) {
  io::RawMesh raw;
  raw.format = io::MeshFormat::cityjson;  // z up
  raw.vertices = std::move(collected.vertices);
  raw.triangles = std::move(collected.triangles);
  raw.object_of = std::move(collected.object_of);
  raw.objects = std::move(collected.objects);
  for (MissingPart& part : collected.missing) {
    io::Missing missing{std::move(part.entry), {}};
    for (const Vec3& corner : part.corners) {
      if (!missing.entry.box) missing.entry.box.emplace();
      missing.entry.box->extend(corner);
    }
    if (part.is_held) missing.holder = io::hexahedron(std::move(part.corners));
    raw.ledger.push_back(std::move(missing));
  }
  return raw;
}

}  // namespace

World world_of(const Volume& root, const TilesetOptions& options) {
  if (options.crs == "none") return World::nowhere;
  if (!options.crs.empty()) return World::projected;
  if (std::holds_alternative<EarthRegion>(root)) return World::earth;
  const auto ball = around(root);
  if (!ball) return World::nowhere;
  const double distance = ball->center.norm();
  if (distance + ball->radius < geo::kEquatorM * (1 - geo::kFlattening) - kFarthestHeightM) return World::nowhere;
  if (distance < ball->radius) return World::earth;  // the whole earth
  return std::abs(geo::from_ecef(ball->center).height_m) < kFarthestHeightM + ball->radius ? World::earth
                                                                                           : World::nowhere;
}

Reach reach_of(World world, const Volume& root, const TilesetOptions& options, const std::filesystem::path& file) {
  if (!options.center_deg) return {};
  if (world == World::nowhere) {
    throw Error(ErrorCode::not_georeferenced, "the tileset does not say where on the earth it lies", file.string(),
                "leave out center and radius, or name the coordinate system of its metres with crs, as in EPSG:28992");
  }
  const geo::LonLat center = lon_lat(*options.center_deg);
  const geo::LocalFrame frame(center);  // checks the place
  Reach reach =
      world == World::projected ? plane_reach(options, file) : Reach(center, *options.radius_m + kBeyondTileM);
  if (reach.meets(root)) return reach;
  std::string where_it_is;
  const auto ball = around(root);
  if (ball && world == World::earth && ball->radius < geo::kEquatorM / 2) {
    const geo::LonLat middle = geo::from_ecef(ball->center).place;
    where_it_is = ": its middle is at latitude " + std::to_string(middle.latitude_deg) + ", longitude " +
                  std::to_string(middle.longitude_deg);
  }
  throw Error(ErrorCode::region_outside, "the circle lies outside of the tileset", file.string(),
              "give a center inside, the latitude first" + where_it_is);
}

Scene placed_scene(World world, Collector&& collected, const TilesetOptions& options, const std::filesystem::path& file,
                   const core::ProgressReporter& progress) {
  std::optional<Georeference> place;
  if (world == World::earth) place = put_on_earth(collected, options, file, progress);
  if (world == World::nowhere && options.crs.empty() && is_on_earth(middle_of(collected))) {
    throw Error(ErrorCode::not_georeferenced,
                "the root of the tileset has no bounding volume on the earth, but what it holds lies there",
                file.string(), "give the root tile a boundingVolume, or, if that is no mistake, crs: none");
  }
  io::RawMesh raw = raw_mesh(std::move(collected));
  SceneReadOptions read;
  if (world == World::projected) read.crs = options.crs;
  if (world == World::projected) read.origin_deg = options.center_deg;
  io::to_scene_frame(raw, read, file, progress);
  io::apply_policy(raw, options.missing, file, progress);
  Scene scene;
  scene.mesh.vertices = std::move(raw.vertices);
  scene.mesh.triangles = std::move(raw.triangles);
  scene.object_of = std::move(raw.object_of);
  scene.objects = std::move(raw.objects);
  scene.source = file;
  scene.georeference = place ? place : std::move(raw.georeference);
  scene.notes = std::move(raw.notes);
  for (io::Missing& missing : raw.ledger) scene.ledger.push_back(std::move(missing.entry));
  return scene;
}

void measure_frame(const Scene& scene, TilesetReport& report) {
  const geo::LonLat origin{scene.georeference->longitude_deg, scene.georeference->latitude_deg};
  const geo::TangentFrame frame(origin);
  const geo::LocalFrame map(origin);
  const Box box = bounding_box(scene.mesh);
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
                      (i & 4) != 0 ? box.max.z() : box.min.z());
    const geo::Geodetic there = geo::from_ecef(frame.to_earth(corner));
    report.rim_drop_m = std::max(report.rim_drop_m, there.height_m - corner.z());
    report.rim_shift_m = std::max(report.rim_shift_m, (map.to_local(there.place) - corner.head<2>()).norm());
  }
}

}  // namespace vantage::internal::tiles
