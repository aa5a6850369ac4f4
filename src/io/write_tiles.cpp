#include "io/write_tiles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/input.h"
#include "geo/ellipsoid.h"
#include "geo/on_globe.h"
#include "io/georeference_text.h"
#include "io/tile_content.h"
#include "vantage/error.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

using TilesetJson = nlohmann::ordered_json;

/// The axes of the tile: x east, y north, z up where the target is (its frame's origin).
class TileFrame {
 public:
  TileFrame(const geo::OnGlobe& globe, const Vec3& scene_origin)
      : globe_(globe),
        axes_(geo::TangentFrame(globe.to_geodetic(scene_origin).place).axes),
        origin_(globe.to_earth(scene_origin)) {}

  Vec3 to_tile(const Vec3& scene) const { return axes_ * (globe_.to_earth(scene) - origin_); }

  /// From coordinates about `middle` to ECEF: column by column, as 3D Tiles has it.
  std::array<double, 16> transform_about(const Vec3& middle) const {
    const Vec3 place = axes_.transpose() * middle + origin_;
    std::array<double, 16> numbers{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) numbers[4 * column + row] = axes_(column, row);
      numbers[12 + row] = place[row];
    }
    numbers[15] = 1;
    return numbers;
  }

 private:
  const geo::OnGlobe& globe_;
  Eigen::Matrix3d axes_;  // its rows are east, north and up
  Vec3 origin_;
};

double polygon_area_m2(const std::vector<Vec3>& corners) {
  Vec3 doubled = Vec3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    doubled += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return doubled.norm() / 2;
}

/// As it was asked for, in the scene frame: moved by its offset, not by a lift.
TileTarget scene_target(const Target& target) {
  TileTarget drawn{{"target", printable(target.name), 0}, {}};
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const TargetFrame frame = make_target_frame(target, i);
    std::vector<Vec3>& corners = drawn.parts.emplace_back();
    for (const Eigen::Vector2d& corner : frame.polygon) {
      corners.push_back(frame.to_scene({corner.x(), corner.y(), 0}));
    }
    drawn.feature.area_m2 += polygon_area_m2(corners);
  }
  return drawn;
}

/// Those that the volume knows, in the frame of the tile, about `middle`.
std::vector<TileTarget> tile_targets(const Volume& volume, const TileFrame& frame, const Vec3& middle) {
  std::vector<TileTarget> drawn;
  if (!volume.provenance) return drawn;
  const auto add = [&](const Target& target) {
    if (target.is_volume()) return;
    TileTarget& last = drawn.emplace_back(scene_target(target));
    for (std::vector<Vec3>& part : last.parts) {
      for (Vec3& corner : part) corner = frame.to_tile(corner) - middle;
    }
  };
  if (volume.provenance->views.empty()) add(volume.provenance->target);
  for (const std::vector<Target>& view : volume.provenance->views) std::for_each(view.begin(), view.end(), add);
  return drawn;
}

/// Of all that the content holds, as the file's numbers have it.
Box content_box(const StoredMesh& stored, const std::vector<TileTarget>& targets) {
  Box box;
  for (const Vec3& vertex : stored.mesh.vertices) box.extend(vertex - stored.origin);
  for (const TileTarget& target : targets) {
    for (const std::vector<Vec3>& part : target.parts) {
      for (const Vec3& corner : part) box.extend(corner.cast<float>().cast<double>());
    }
  }
  return box;
}

/// "box" of a boundingVolume. The half lengths are a nanometre-sized step too long: the middle is rounded.
std::array<double, 12> bounding_numbers(const Box& box) {
  const Vec3 middle = (box.min + box.max) / 2;
  const Vec3 half = (box.max - middle).cwiseMax(middle - box.min) * (1 + 1e-12);
  return {middle.x(), middle.y(), middle.z(), half.x(), 0, 0, 0, half.y(), 0, 0, 0, half.z()};
}

TilesetJson tileset_of(const Volume& volume, const StoredMesh& stored, const TileFrame& frame, const Box& box) {
  TilesetJson json;
  json["asset"]["version"] = "1.1";
  json["asset"]["extras"]["vantage"] = {{"version", VANTAGE_VERSION},
                                        {"georeference", georeference_json(*volume.georeference)},
                                        {"z_is_taken_as", geo::kEllipsoidalHeight},
                                        {"rounding_m", stored.rounding_m}};
  // What is missing where the tile is not drawn is as large as the tile.
  json["geometricError"] = (box.max - box.min).norm();
  json["root"] = {{"transform", frame.transform_about(stored.origin)},
                  {"boundingVolume", {{"box", bounding_numbers(box)}}},
                  {"geometricError", 0},
                  {"refine", "REPLACE"},
                  {"content", {{"uri", kTilesContent}}}};
  return json;
}

}  // namespace

void check_tiles_georeference(const std::optional<Georeference>& georeference, const std::filesystem::path& folder) {
  if (georeference) return;
  throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, and a tileset has to",
              folder.string(),
              "give a scene with a place: a map, CityJSON with a reference system, a raster, or a mesh with 'crs' or "
              "written by "
              "'vantage scene'; or write .glb");
}

StagedVolume stage_tiles(const Volume& volume, const std::filesystem::path& folder) {
  check_tiles_georeference(volume.georeference, folder);
  if (volume.mesh.empty()) {
    throw Error(ErrorCode::format_too_small, "there is no volume, and a tileset has something to show", folder.string(),
                "write another format, which can say that there is none");
  }
  const geo::OnGlobe globe(*volume.georeference);
  const TileFrame frame(globe, volume.frame.origin);
  Volume placed;  // what rounding needs
  placed.mesh.triangles = volume.mesh.triangles;
  placed.cause_of = volume.cause_of;
  placed.mesh.vertices.reserve(volume.mesh.vertices.size());
  for (const Vec3& vertex : volume.mesh.vertices) placed.mesh.vertices.push_back(frame.to_tile(vertex));
  StoredMesh stored = stored_as_local_floats(placed);
  stored.rounding_m += volume.read_rounding_m;
  const std::vector<TileTarget> targets = tile_targets(volume, frame, stored.origin);

  StagedVolume staged;
  staged.folder = std::make_shared<TilesFolder>(folder);
  AtomicFile content(staged.folder->path() / kTilesContent);
  write_tile_content(volume, stored, targets, content);
  content.commit();
  const TilesetJson tileset = tileset_of(volume, stored, frame, content_box(stored, targets));
  write_whole_file(staged.folder->path() / kTilesetFile,
                   tileset.dump(2, ' ', false, TilesetJson::error_handler_t::replace) + "\n");
  staged.report = {stored.rounding_m, stored.mesh.triangles.size(), stored.turned_facets};
  return staged;
}

}  // namespace vantage::internal::io

namespace vantage {

std::string height_note(const std::optional<Georeference>& georeference, const std::filesystem::path& output) {
  if (!georeference || !is_folder_format(output) || georeference->vertical == internal::geo::kEllipsoidalHeight) {
    return "";
  }
  const std::string level = georeference->vertical.empty() ? "an unknown level" : georeference->vertical;
  return output.string() + ": z of the scene, from " + level +
         ", is taken as the height above the WGS 84 ellipsoid; over other heights, as a globe with terrain has them, "
         "raise the tileset by what lies between";
}

}  // namespace vantage
