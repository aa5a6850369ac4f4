// The ground of a tileset from a raster of heights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geo/ellipsoid.h"
#include "support/internals.h"
#include "support/raster_writer.h"
#include "support/tile_files.h"
#include "support/tileset_folder.h"
#include "support/wording.h"
#include "vantage/ground.h"
#include "vantage/mission.h"
#include "vantage/scene_source.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::box_glb;
using testing::expect_code;
using testing::make_raster;
using testing::tile_json;
using testing::Tileset;
using testing::tileset_json;

constexpr double kLatitude = 45.15, kLongitude = 9.06, kSeaLevel = 45.0;

/// A box of 1 m on the ellipsoid, and what is `height` above the sea around it: 6 km, posts each 100 m.
class Hill : public Tileset {
 public:
  explicit Hill(double slope = 0) : Tileset(at_place()) {
    add("a.glb", box_glb({{}}));
    auto raster = make_raster(60, 60, [&](int column, int) { return 200 + slope * column; });
    raster.transform = {501700, 100, 0, 5002700, 0, -100};
    terrain_ = testing::write_raster(path(), "dem", raster);
  }

  static json at_place() {
    json root = tile_json(0, "a.glb");
    root["transform"] = testing::transform_at(kLatitude, kLongitude);
    return tileset_json(root);
  }

  Scene with(const TerrainOptions& options) const {
    Scene scene = read().scene;
    add_terrain(scene, terrain_, options);
    return scene;
  }
  const std::filesystem::path& terrain() const { return terrain_; }

 private:
  std::filesystem::path terrain_;
};

TerrainOptions far_around() {
  TerrainOptions options;
  options.reach_m = 2000;
  options.max_error_m = 0.001;
  options.sea_level_z_m = kSeaLevel;
  return options;
}

/// Heights above the ellipsoid of the vertices of the ground, and where they are on the map.
std::vector<internal::geo::Geodetic> ground_vertices(const Scene& scene) {
  const internal::geo::TangentFrame frame({scene.georeference->longitude_deg, scene.georeference->latitude_deg});
  std::vector<internal::geo::Geodetic> found;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (scene.objects[scene.object_of[i]].kind != ObjectKind::ground) continue;
    for (const std::uint32_t corner : scene.mesh.triangles[i]) {
      found.push_back(internal::geo::from_ecef(frame.to_earth(scene.mesh.vertices[corner])));
    }
  }
  return found;
}

TEST(TilesetGround, FollowsTheEllipsoidAtTheHeightOfTheRaster) {
  const Scene scene = Hill().with(far_around());
  const auto ground = ground_vertices(scene);
  ASSERT_GT(ground.size(), 6u);  // a plain of 4 km is bent by 0.3 m
  for (const auto& vertex : ground) EXPECT_NEAR(vertex.height_m, 200 + kSeaLevel, 0.002);
  const GroundLevels levels(ground_of(scene).value());
  EXPECT_NEAR(levels.at(0, 0).value().highest_m, 245, 0.01);
  const double drop = 1900.0 * 1900 / (2 * internal::geo::kEquatorM);
  EXPECT_NEAR(levels.at(1900, 0).value().highest_m, 245 - drop, 0.01);
  EXPECT_EQ(scene.georeference->vertical, internal::geo::kEllipsoidalHeight);
}

TEST(TilesetGround, IsWhereTheRasterHasItsHeights) {
  const Hill hill(20);  // 20 m a post, which are 100 m apart
  const internal::geo::CoordinateSystem utm("EPSG:32632", "test");
  for (const auto& vertex : ground_vertices(hill.with(far_around()))) {
    const double column = (utm.from_lonlat(vertex.place).x() - 501700 - 50) / 100;
    EXPECT_NEAR(vertex.height_m, 200 + 20 * column + kSeaLevel, 0.01);
  }
}

TEST(TilesetGround, NeedsTheLevelThatItsHeightsAreAbove) {
  const Hill hill;
  TerrainOptions options = far_around();
  options.sea_level_z_m.reset();
  expect_code([&] { hill.with(options); }, ErrorCode::height_unknown, "dem.tif");
  options.reach_m = 20'000;
  options.sea_level_z_m = kSeaLevel;
  expect_code([&] { hill.with(options); }, ErrorCode::region_outside, "dem.tif");
  options.reach_m = -1;
  expect_code([&] { hill.with(options); }, ErrorCode::value_out_of_range, "dem.tif");
  Scene nowhere = hill.read().scene;
  nowhere.georeference.reset();
  expect_code([&] { add_terrain(nowhere, hill.terrain()); }, ErrorCode::not_georeferenced, "dem.tif");
  EXPECT_EQ(nowhere.objects.size(), 1u);
}

TEST(TilesetGround, TakesHeightsAboveTheEllipsoidAsTheyAre) {
  const Hill hill;
  auto raster = make_raster(40, 40, [](int, int) { return 7; });
  raster.srs = "EPSG:4979";
  raster.transform = {kLongitude - 0.02, 0.001, 0, kLatitude + 0.02, 0, -0.001};
  const auto file = testing::write_raster(hill.path(), "ellipsoid", raster);
  Scene scene = hill.read().scene;
  add_terrain(scene, file);
  for (const auto& vertex : ground_vertices(scene)) EXPECT_NEAR(vertex.height_m, 7, 0.001);
}

TEST(TilesetGround, IsThatOfMissions) {
  const Hill hill;
  const auto read = [&](const std::string& scene) {
    return read_mission_text("scene: {tiles: tileset.json, " + scene +
                                 "}\n"
                                 "target: {vertices: [[5, 0, 260], [6, 0, 260], [6, 1, 260]]}\n"
                                 "sensor: {max_range: 30}\nnavigation: {altitude: {agl: [5, 40]}}\n",
                             hill.path() / "mission.yaml");
  };
  const MissionFile file = read("terrain: dem.tif, error: 0.1, sea_level: 45");
  const std::vector<std::filesystem::path> files = input_files(file);
  EXPECT_TRUE(std::any_of(files.begin(), files.end(), [](const auto& one) { return one.filename() == "dem.tif"; }));
  const Mission mission = resolve_mission(file);
  const auto& surface = mission.navigation.above_ground.value().ground.surface;
  ASSERT_TRUE(surface);
  for (const Vec3& vertex : surface->vertices) EXPECT_NEAR(vertex.z(), 245, 0.1);
  const MissionFile again = read_mission_text(mission_text(file, hill.path()), hill.path() / "again.yaml");
  EXPECT_EQ(again.scene.terrain, file.scene.terrain);
  EXPECT_EQ(again.scene.terrain_options.max_error_m, 0.1);
  EXPECT_EQ(again.scene.terrain_options.sea_level_z_m, 45);
  expect_code([&] { read("ground: 3, terrain: dem.tif"); }, ErrorCode::conflicting_keys, "mission.yaml");
  expect_code([&] { read("terrain: none.tif"); }, ErrorCode::file_not_found, "mission.yaml");
  expect_code([&] { resolve_mission(read("terrain: dem.tif")); }, ErrorCode::height_unknown, "dem.tif");
}

}  // namespace
}  // namespace vantage
