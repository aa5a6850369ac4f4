// Tilesets of 3D Tiles that are made here: which tiles are read, where their contents come to lie, who the objects are.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/internals.h"
#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/temporary_directory.h"
#include "support/tile_files.h"
#include "support/tileset_folder.h"
#include "tiles/content.h"
#include "tiles/instances.h"
#include "vantage/mission.h"
#include "vantage/scene_source.h"
#include "vantage/tileset.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::b3dm;
using testing::box_glb;
using testing::bytes_of;
using testing::cmpt;
using testing::expect_code;
using testing::expect_error;
using testing::i3dm;
using testing::ids_of;
using testing::tile_json;
using testing::Tileset;
using testing::tileset_json;

using Names = std::vector<std::string>;

double unit_normal_z(const Scene& scene, std::size_t triangle) {
  const Triangle& corners = scene.mesh.triangles[triangle];
  const Vec3 first = scene.mesh.vertices[corners[0]];
  const Vec3 a = scene.mesh.vertices[corners[1]] - first, b = scene.mesh.vertices[corners[2]] - first;
  return unit(Vec3(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x())).z();
}

/// Two points, at (11, 2, 3) and (14, 5, 6).
std::string two_points() {
  std::string points;
  for (const float value : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) points += testing::bytes_of(value);
  return testing::pnts({{"POINTS_LENGTH", 2}, {"RTC_CENTER", {10, 0, 0}}, {"POSITION", {{"byteOffset", 0}}}}, points);
}

TEST(Tileset, ReadsAGlbWithZUp) {
  Tileset tiles(tileset_json(tile_json(0, "a.glb")));
  tiles.add("a.glb", box_glb({{{3, 0, -5}, 7, 0}}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.triangles, 12u);
  EXPECT_EQ(read.report.contents, 1u);
  EXPECT_EQ(read.report.holes, 0u);
  const Box box = bounding_box(read.scene.mesh);
  EXPECT_EQ(box.min, Vec3(3, 4, 0));  // (x, y, z) of glTF is (x, -z, y)
  EXPECT_EQ(box.max, Vec3(4, 5, 7));
  EXPECT_FALSE(read.scene.georeference);
  EXPECT_EQ(ids_of(read), std::set<std::string>{"a.glb"});
  EXPECT_GT(enclosed_volume(read.scene.mesh), 0);
}

TEST(Tileset, ReplacesParentsAndAddsToThem) {
  for (const bool is_add : {false, true}) {
    json root = tile_json(50, "coarse.glb");
    root["refine"] = is_add ? "ADD" : "REPLACE";
    root["children"] = json::array({tile_json(5, "fine.glb"), tile_json(0, "other.glb")});
    root["children"][0]["children"] = json::array({tile_json(0, "finest.glb")});
    Tileset tiles(tileset_json(root));
    for (const char* name : {"coarse.glb", "fine.glb", "finest.glb", "other.glb"}) tiles.add(name, box_glb({{}}));
    const auto at = [&](double detail) {
      TilesetOptions options;
      options.detail_m = detail;
      return tiles.read(options);
    };
    using Ids = std::set<std::string>;
    const Ids all = {"coarse.glb", "fine.glb", "finest.glb", "other.glb"};
    EXPECT_EQ(ids_of(at(50)), is_add ? all : Ids{"coarse.glb"}) << "what is added is nothing finer";
    EXPECT_EQ(at(50).report.largest_error_m, is_add ? 0 : 50);
    EXPECT_EQ(ids_of(at(5)), is_add ? all : (Ids{"fine.glb", "other.glb"}));
    EXPECT_EQ(at(5).report.largest_error_m, is_add ? 0 : 5);
    EXPECT_EQ(ids_of(at(1)), is_add ? all : (Ids{"finest.glb", "other.glb"}));
    EXPECT_EQ(at(1).report.largest_error_m, 0);
    EXPECT_EQ(at(1).report.coarse, 0u);
  }
}

TEST(Tileset, ChildrenThatHoldNothingReplaceNothing) {
  json root = tile_json(50, "coarse.glb"), empty = tile_json(5, ""), full = tile_json(0, "fine.glb");
  empty.erase("content");
  for (const bool has_fine : {false, true}) {
    root["children"] = json::array({empty});
    if (has_fine) root["children"][0]["children"] = json::array({full});
    Tileset tiles(tileset_json(root));
    for (const char* name : {"coarse.glb", "fine.glb"}) tiles.add(name, box_glb({{}}));
    EXPECT_EQ(ids_of(tiles.read()), std::set<std::string>{has_fine ? "fine.glb" : "coarse.glb"});
  }
  // Nor do those whose contents have no surfaces, whatever is in the ledger of them.
  root["children"] = json::array({tile_json(5, "points.pnts")});
  root["children"][0]["children"] = json::array({tile_json(0, "finer.pnts")});
  Tileset tiles(tileset_json(root));
  tiles.add("coarse.glb", box_glb({{}}));
  for (const char* name : {"points.pnts", "finer.pnts"}) tiles.add(name, two_points());
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.largest_error_m, 50);
  EXPECT_EQ(read.report.coarse, 1u);
  ASSERT_EQ(read.scene.ledger.size(), 1u);
  EXPECT_EQ(read.scene.ledger[0].object.source_id, "finer.pnts");
  EXPECT_EQ(read.scene.objects.at(0).source_id, "coarse.glb");
}

TEST(Tileset, AddsAPlaneAsGround) {
  Tileset tiles(tileset_json(tile_json(0, "a.glb")));
  tiles.add("a.glb", box_glb({{{3, 0, -5}, 7, 0}}));
  TilesetOptions options;
  options.ground_m = -0.5;
  const Scene scene = tiles.read(options).scene;
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[1], (SceneObject{"ground", "", ObjectKind::ground}));
  EXPECT_EQ(scene.mesh.triangles.size(), 14u);
  EXPECT_EQ(bounding_box(scene.mesh).min, Vec3(3, 4, -0.5));
  EXPECT_GT(unit_normal_z(scene, 13), 0.99);
}

TEST(Tileset, SaysWhatIsCoarserThanAsked) {
  Tileset tiles(tileset_json(tile_json(30, "a.glb")));
  tiles.add("a.glb", box_glb({{}}));
  const TilesetReport report = tiles.read().report;
  EXPECT_EQ(report.largest_error_m, 30);
  EXPECT_EQ(report.coarse, 1u);
}

TEST(Tileset, LiesOnTheEarthAsItsGeoreferenceSays) {
  json root = tile_json(0, "a.b3dm");
  root["transform"] = testing::transform_at(35.67, 139.76);
  Tileset tiles(tileset_json(root, 10, "1.0"));
  tiles.add("a.b3dm", b3dm(box_glb({{{30, 12, -40}, 25, 0}}), {{"BATCH_LENGTH", 0}, {"RTC_CENTER", {100, 200, 3}}}));
  TilesetOptions options;
  options.center_deg = {35.67, 139.76};
  options.radius_m = 400;
  const TilesetScene read = tiles.read(options);
  ASSERT_TRUE(read.scene.georeference);
  EXPECT_EQ(read.scene.georeference->vertical, "ellipsoidal height");
  const Box box = bounding_box(read.scene.mesh);
  EXPECT_LT((box.min - Vec3(130, 239, 15)).norm(), 1e-6);
  EXPECT_LT((box.max - Vec3(131, 240, 40)).norm(), 1e-6);
  // d^2 / 2 R.
  EXPECT_NEAR(read.report.rim_drop_m, (131. * 131 + 240. * 240) / 2 / 6.37e6, 1e-4);
  EXPECT_LT(read.report.rim_shift_m, 5e-3);

  options.center_deg = {35.68, 139.76};
  expect_error([&] { tiles.read(options); }, ErrorCode::region_outside, "tileset.json");
}

TEST(Tileset, LeavesOutTilesAndObjectsBeyondTheRadius) {
  json root = tile_json(10, "", 5000);
  root["transform"] = testing::transform_at(52, 4.4);
  root["refine"] = "ADD";
  json near = tile_json(0, "near.glb", 60), far = tile_json(0, "far.glb", 60);
  far["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 500, 0, 0, 1};
  root["children"] = json::array({near, far});
  Tileset tiles(tileset_json(root));
  json two = {{"nodes", {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}, {"translation", {250, 0, 0}}}}}};
  two["scenes"] = {{{"nodes", {0, 1}}}};
  tiles.add("near.glb", box_glb({{}}));
  tiles.add("far.glb", "no glb at all");
  TilesetOptions options;
  options.center_deg = {52, 4.4};
  options.radius_m = 100;
  const TilesetReport report = tiles.read(options).report;  // far.glb is not read
  EXPECT_EQ(report.contents, 1u);
  EXPECT_EQ(report.holes, 0u);
  options.radius_m = 450;
  EXPECT_EQ(tiles.read(options).report.holes, 1u);
}

// Contents of some exporters do.
TEST(Tileset, ReadsWhatSticksOutOfItsTile) {
  json root = tile_json(10, "", 5000);
  root["transform"] = testing::transform_at(52, 4.4);
  root["children"] = json::array({tile_json(0, "a.glb", 60)});
  root["children"][0]["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 170, 0, 0, 1};
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{{-120, 0, 0}, 1, 0}}));  // 50 m from the middle; the tile begins at 110 m
  TilesetOptions options;
  options.center_deg = {52, 4.4};
  options.radius_m = 80;
  EXPECT_EQ(tiles.read(options).report.triangles, 12u);
}

TEST(Tileset, IsOnTheEarthOrSaysSo) {
  TilesetOptions options;
  options.center_deg = {52, 4.4};
  options.radius_m = 80;
  const auto read_with = [](const json& volume, const TilesetOptions& how) {
    json root = tile_json(0, "a.glb");
    root["transform"] = testing::transform_at(52, 4.4);
    root["boundingVolume"] = volume;
    Tileset tiles(tileset_json(root));
    tiles.add("a.glb", box_glb({{}}));
    return tiles.read(how).report.triangles;
  };
  const json s2 = {{"extensions", {{"3DTILES_bounding_volume_S2", {{"token", "47c5"}}}}}};
  const json below_the_pole = {{"region", {0, -1.75, 1, -1.66, 0, 100}}};
  const json around_all = {{"sphere", {0, 0, 0, 1e7}}};
  EXPECT_EQ(read_with(s2, options), 12u);
  EXPECT_EQ(read_with(below_the_pole, options), 12u);
  EXPECT_EQ(read_with(around_all, options), 12u);
  expect_error([&] { read_with(json::object(), {}); }, ErrorCode::not_georeferenced, "tileset.json");
  json local = tile_json(0, "a.glb");
  local["boundingVolume"] = around_all;
  Tileset lazy(tileset_json(local));
  lazy.add("a.glb", box_glb({{}}));
  expect_error([&] { lazy.read(); }, ErrorCode::not_georeferenced, "tileset.json");
  json moon = tileset_json(tile_json(0, "a.glb"));
  moon["extensions"]["3DTILES_ellipsoid"]["radii"] = {1737400, 1737400, 1737400};
  Tileset of_moon(moon);
  expect_error([&] { of_moon.read(); }, ErrorCode::mesh_unsupported, "tileset.json");
}

TEST(Tileset, AMeshMayBeNamedAsATileset) {
  json root = tile_json(50, "a.json");
  Tileset alone(tileset_json(root));
  alone.add("a.json", box_glb({{}}));
  EXPECT_EQ(ids_of(alone.read()), std::set<std::string>{"a.json"});
  root["children"] = json::array({tile_json(0, "fine.glb")});
  Tileset tiles(tileset_json(root));
  tiles.add("a.json", box_glb({{}}));
  tiles.add("fine.glb", box_glb({{}}));
  const TilesetScene fine = tiles.read();
  EXPECT_EQ(ids_of(fine), std::set<std::string>{"fine.glb"});
  EXPECT_EQ(fine.report.holes, 1u) << "it might have been a tileset";
}

TEST(Tileset, ObjectsAreFeaturesOfBatchTables) {
  json root = tile_json(0);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.b3dm"), tile_json(0, "b.b3dm")});
  Tileset tiles(tileset_json(root));
  const json batch = {{"gml_id", {"bldg_1", "bldg_2"}},
                      {"bldg:address", {"Main Street 1", "Main Street 2"}},
                      {"feature_type", {"bldg:Building", "bldg:Building"}}};
  tiles.add("a.b3dm", b3dm(box_glb({{{0, 0, 0}, 5, 0}, {{4, 0, 0}, 6, 1}, {{8, 0, 0}, 7, 0}}, "_BATCHID"),
                           {{"BATCH_LENGTH", 2}}, batch));
  // The same building in another tile, and numbers that are unique in their tile alone, in the binary part.
  const json numbers = {{"id", {{"byteOffset", 0}, {"componentType", "UNSIGNED_SHORT"}, {"type", "SCALAR"}}}};
  tiles.add("b.b3dm", b3dm(box_glb({{{0, 0, 9}, 5, 0}, {{4, 0, 9}, 6, 1}}, "_BATCHID"), {{"BATCH_LENGTH", 2}}, numbers,
                           bytes_of(std::uint16_t{41}) + bytes_of(std::uint16_t{17}) + std::string(4, '\0')));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(ids_of(read), (std::set<std::string>{"bldg_1", "bldg_2", "b.b3dm#41", "b.b3dm#17"}));
  EXPECT_EQ(read.scene.objects[0], (SceneObject{"Main Street 1", "bldg_1", ObjectKind::building}));
  EXPECT_EQ(std::count(read.scene.object_of.begin(), read.scene.object_of.end(), 0u), 24);
}

TEST(Tileset, ObjectsAreFeaturesOfStructuralMetadata) {
  Tileset tiles(tileset_json(tile_json(0, "a.glb")));
  const std::string texts = "NL.1NL.22";
  std::string offsets;
  for (const std::uint32_t offset : {0u, 4u, 9u}) offsets += bytes_of(offset);
  json extra;
  extra["more"] = {texts, offsets};
  extra["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"classes", {{"b", {{"properties", {{"identificatie", {{"type", "STRING"}}}}}}}}}}},
      {"propertyTables",
       {{{"class", "b"}, {"count", 2}, {"properties", {{"identificatie", {{"values", 3}, {"stringOffsets", 4}}}}}}}}};
  tiles.add("a.glb", box_glb({{{0, 0, 0}, 5, 1}, {{4, 0, 0}, 6, 0}}, "_FEATURE_ID_0", extra));
  EXPECT_EQ(ids_of(tiles.read()), (std::set<std::string>{"NL.1", "NL.22"}));
}

TEST(Tileset, GarbledPropertiesCostNoGeometry) {
  std::string offsets;
  for (const std::uint32_t offset : {0u, 4u, 900u}) offsets += bytes_of(offset);
  const auto read_with = [&](const json& table) {
    Tileset tiles(tileset_json(tile_json(0, "a.glb")));
    json extra;
    extra["more"] = {"NL.1NL.22", offsets};
    extra["extensions"]["EXT_structural_metadata"] = {
        {"schema", {{"classes", {{"b", {{"properties", {{"identificatie", {{"type", "STRING"}}}}}}}}}}},
        {"propertyTables", json::array({table})}};
    tiles.add("a.glb", box_glb({{{0, 0, 0}, 5, 1}, {{4, 0, 0}, 6, 0}}, "_FEATURE_ID_0", extra));
    const TilesetScene read = tiles.read();
    EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
    EXPECT_EQ(read.report.triangles, 24u);
    EXPECT_GT(read.report.unreadable_properties, 0u);
    return ids_of(read);
  };
  json table = {
      {"class", "b"}, {"count", 2}, {"properties", {{"identificatie", {{"values", 3}, {"stringOffsets", 4}}}}}};
  EXPECT_EQ(read_with(table), (std::set<std::string>{"NL.1", "a.glb#1"}));
  table["properties"]["identificatie"]["stringOffsets"] = 77;  // no such buffer view
  EXPECT_EQ(read_with(table), (std::set<std::string>{"a.glb#0", "a.glb#1"}));
  table["count"] = "two";
  EXPECT_EQ(read_with(table), (std::set<std::string>{"a.glb#0", "a.glb#1"}));
}

TEST(Tileset, FeaturesByTextureAreNotToldApart) {
  Tileset tiles(tileset_json(tile_json(0, "a.glb")));
  const auto read_with = [&](const json& sets) {
    tiles.add("a.glb", box_glb({{{0, 0, 0}, 5, 1}, {{4, 0, 0}, 6, 0}}, "_FEATURE_ID_0", json{{"featureIds", sets}}));
    TilesetScene read = tiles.read();
    EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
    EXPECT_EQ(read.report.triangles, 24u);
    return read;
  };
  const json by_texture = {{"featureCount", 2}, {"texture", {{"index", 0}, {"channels", {0}}}}};
  const json by_attribute = {{"featureCount", 2}, {"attribute", 0}};
  const TilesetScene one = read_with(json::array({by_texture}));
  ASSERT_EQ(one.scene.objects.size(), 1u);
  EXPECT_EQ(one.scene.objects[0], (SceneObject{"house", "a.glb", ObjectKind::other}));
  EXPECT_EQ(one.report.features_by_texture, 1u);
  testing::expect_wording(notes_of(one.report));
  const TilesetScene both = read_with(json::array({by_texture, by_attribute}));
  EXPECT_EQ(ids_of(both), (std::set<std::string>{"a.glb#0", "a.glb#1"}));
  EXPECT_EQ(both.report.features_by_texture, 1u);
  EXPECT_EQ(read_with(json::array({by_attribute})).report.features_by_texture, 0u);
  const json garbled = {{"featureCount", 2}, {"texture", 7}};
  EXPECT_EQ(read_with(json::array({garbled})).report.features_by_texture, 1u);
}

TEST(Tileset, ReadsInstancesAndComposites) {
  json root = tile_json(0, "all.cmpt");
  Tileset tiles(tileset_json(root, 1, "1.0"));
  std::string positions, rest;
  for (const float value : {10.f, 20.f, 30.f, -10.f, -20.f, -30.f}) positions += bytes_of(value);
  for (const float value : {2.f, 3.f}) rest += bytes_of(value);
  const json features = {{"INSTANCES_LENGTH", 2}, {"POSITION", {{"byteOffset", 0}}}, {"SCALE", {{"byteOffset", 24}}}};
  const std::string trees = i3dm(box_glb({{}}), features, positions + rest, {{"name", {"oak", "elm"}}});
  const std::string points =
      std::string("pnts\1\0\0\0\x34\0\0\0\x18\0\0\0", 16) + std::string(12, '\0') + R"({"POINTS_LENGTH": 0}    )";
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), cmpt({trees}), points}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.triangles, 36u);
  EXPECT_EQ(read.report.holes, 0u);
  const Box box = bounding_box(read.scene.mesh);
  EXPECT_LT((box.max - Vec3(12, 20, 32)).norm(), 1e-5);
  EXPECT_LT((box.min - Vec3(-10, -23, -30)).norm(), 1e-5);
  EXPECT_EQ(ids_of(read), (std::set<std::string>{"all.cmpt", "all.cmpt#0", "all.cmpt#1"}));
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), cmpt({trees}), points + points.substr(0, 9)}));
  EXPECT_EQ(tiles.read().report.holes, 1u) << "more follows the announced parts";
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), cmpt({trees}), points + std::string(8, '\0')}));
  EXPECT_EQ(tiles.read().report.holes, 0u);
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), cmpt({trees}), points.substr(0, 9)}));
  EXPECT_EQ(tiles.read().report.holes, 1u);
}

TEST(Tileset, TablesWithoutLengthsAreHoles) {
  json root = tile_json(50);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "b")});
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  const auto holes_of = [&](const std::string& bytes) {
    tiles.add("b", bytes);
    return tiles.read().report.holes;
  };
  const std::string numbers(24, '\0'), box = box_glb({{}});
  json features = {{"INSTANCES_LENGTH", 1}, {"POSITION", {{"byteOffset", 0}}}};
  EXPECT_EQ(holes_of(i3dm(box, features, numbers)), 0u);
  features["NORMAL_UP"] = {{"byteOffset", 12}};
  EXPECT_EQ(holes_of(i3dm(box, features, numbers)), 1u);
  features.erase("NORMAL_UP");
  features["NORMAL_RIGHT"] = {{"byteOffset", 12}};
  EXPECT_EQ(holes_of(i3dm(box, features, numbers)), 1u);
  EXPECT_EQ(holes_of(i3dm(box, {{"POSITION", {{"byteOffset", 0}}}}, numbers)), 1u);
  EXPECT_EQ(holes_of(b3dm(box, json::object())), 0u);  // no table at all
  EXPECT_EQ(holes_of(b3dm(box, {{"RTC_CENTER", {0, 0, 0}}})), 1u);
}

/// Files in memory, which counts how often each was read.
class CountingSource : public internal::tiles::TileSource {
 public:
  std::string root() const override { return "tileset.json"; }
  std::string resolve(const std::string& /*base*/, const std::string& uri) const override { return uri; }
  std::string read(const std::string& address, const internal::core::ProgressReporter& /*progress*/) override {
    ++reads[address];
    return files.at(address);
  }
  std::string shown(const std::string& address) const override { return address; }

  std::map<std::string, std::string> files;
  std::map<std::string, int> reads;
};

TEST(Tileset, ReadsTheModelOfInstancesOnceAndOnlyIfThereAreAny) {
  CountingSource source;
  source.files["tree.glb"] = box_glb({{}});
  const internal::core::ProgressReporter progress;
  const internal::core::ReadLimits limits;
  internal::tiles::Collector collector;
  internal::tiles::ContentReader reader(source, collector, progress, limits);
  const internal::tiles::Placement placement{Eigen::Affine3d::Identity()};
  const auto trees = [](int count, const std::string& model) {
    return i3dm(model, {{"INSTANCES_LENGTH", count}, {"POSITION", {{"byteOffset", 0}}}}, std::string(24, '\0'), {},
                false);
  };
  EXPECT_FALSE(reader.read("a.cmpt", cmpt({trees(0, "gone.glb")}), placement));
  EXPECT_TRUE(reader.read("a.cmpt", cmpt({trees(2, "tree.glb"), trees(1, "tree.glb")}), placement));
  EXPECT_EQ(collector.triangles.size(), 36u);
  EXPECT_EQ(source.reads, (std::map<std::string, int>{{"tree.glb", 1}}));
}

TEST(Tileset, BoundsTheTrianglesOfInstances) {
  CountingSource source;
  const internal::core::ProgressReporter progress;
  internal::core::ReadLimits limits;
  limits.repeated_triangles = 0;
  internal::tiles::Collector collector;
  internal::tiles::ContentReader reader(source, collector, progress, limits);
  const std::string model = box_glb({{}});
  // The least that is said of an instance is two bytes for each of three numbers.
  const std::string many = i3dm(model,
                                {{"INSTANCES_LENGTH", 1000},
                                 {"POSITION_QUANTIZED", {{"byteOffset", 0}}},
                                 {"QUANTIZED_VOLUME_OFFSET", {0, 0, 0}},
                                 {"QUANTIZED_VOLUME_SCALE", {1, 1, 1}}},
                                std::string(6000, '\0'));
  const internal::tiles::Placement placement{Eigen::Affine3d::Identity()};
  expect_code([&] { reader.read("a.i3dm", many, placement); }, ErrorCode::mesh_too_large, "a.i3dm");
  EXPECT_TRUE(collector.triangles.empty());
}

TEST(Tileset, InstancesThatStandOnTheEarthKeepTheScaleOfTheirTile) {
  const json numbers = testing::transform_at(50, 8);
  Eigen::Affine3d on_earth;
  for (Eigen::Index i = 0; i < 16; ++i) on_earth.matrix()(i % 4, i / 4) = numbers[static_cast<std::size_t>(i)];
  const Eigen::Affine3d turned = on_earth * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::Scaling(2.5);
  const std::string text =
      json{{"INSTANCES_LENGTH", 1}, {"POSITION", {{"byteOffset", 0}}}, {"EAST_NORTH_UP", true}}.dump();
  const std::string place(12, '\0');
  const internal::tiles::Table features(text, place, {}, {});
  const auto instances = internal::tiles::instances_of(features, turned);
  ASSERT_EQ(instances.size(), 1u);
  const Eigen::Matrix3d placed = (turned * instances[0].transform).linear();
  EXPECT_LT((placed - 2.5 * on_earth.linear()).norm(), 1e-9) << placed;
}

TEST(Tileset, CountsHolesAndGoesOn) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = {tile_json(0, "gone.glb"), tile_json(0, "cut.b3dm"), tile_json(0, "../outside.glb"),
                      tile_json(0, "gone/tileset.json"), tile_json(0, "a.glb")};
  Tileset tiles(tileset_json(root));
  tiles.add("cut.b3dm", b3dm(box_glb({{}})).substr(0, 200));
  tiles.add("a.glb", box_glb({{}}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.holes, 4u);
  EXPECT_NE(read.report.first_hole.find("gone.glb"), std::string::npos);
  EXPECT_EQ(ids_of(read), std::set<std::string>{"a.glb"});
  std::filesystem::remove(tiles.path() / "a.glb");
  expect_error([&] { tiles.read(); }, ErrorCode::mesh_empty, "tileset.json");
}

TEST(Tileset, KeepsACoarserTileWhereAFinerOneIsMissing) {
  json root = tile_json(50, "coarse.glb");
  root["refine"] = "REPLACE";
  root["children"] = json::array({tile_json(5, "fine.glb"), tile_json(0, "other.glb")});
  root["children"][0]["children"] = json::array({tile_json(0, "finest.glb"), tile_json(0, "more/tileset.json")});
  Tileset tiles(tileset_json(root));
  for (const char* name : {"coarse.glb", "fine.glb", "finest.glb", "other.glb", "more/c.glb"}) {
    tiles.add(name, box_glb({{}}));
  }
  tiles.add("more/tileset.json", tileset_json(tile_json(0, "c.glb")).dump());
  using Ids = std::set<std::string>;
  const auto expect_read = [&](const Ids& ids, std::size_t holes, std::size_t kept, double error_m) {
    const TilesetScene read = tiles.read();
    EXPECT_EQ(ids_of(read), ids);
    EXPECT_EQ(read.report.holes, holes);
    EXPECT_EQ(read.report.coarser_kept, kept);
    EXPECT_EQ(read.report.largest_error_m, error_m);
    EXPECT_EQ(read.report.coarse, 0u);
  };
  expect_read({"finest.glb", "other.glb", "more/c.glb"}, 0, 0, 0);
  std::filesystem::remove(tiles.path() / "more/c.glb");
  expect_read({"fine.glb", "finest.glb", "other.glb"}, 1, 1, 5);
  std::filesystem::remove(tiles.path() / "more/tileset.json");
  expect_read({"fine.glb", "finest.glb", "other.glb"}, 1, 1, 5);
  std::filesystem::remove(tiles.path() / "finest.glb");
  expect_read({"fine.glb", "other.glb"}, 2, 1, 5);  // once for both
  std::filesystem::remove(tiles.path() / "fine.glb");
  expect_read({"coarse.glb", "other.glb"}, 2, 1, 50);
  std::filesystem::remove(tiles.path() / "coarse.glb");
  expect_read({"other.glb"}, 2, 0, 0);
}

TEST(Tileset, QueriesMayHoldAddresses) {
  Tileset tiles(tileset_json(tile_json(0, "a.glb?from=http://example.org/a#x")));
  tiles.add("a.glb", box_glb({{}}));
  EXPECT_EQ(ids_of(tiles.read()), std::set<std::string>{"a.glb"});
}

TEST(Tileset, FollowsExternalTilesetsButNotInCircles) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(5, "b/tileset.json"), tile_json(0, "a.glb")});
  Tileset tiles(tileset_json(root));
  json inner = tile_json(3, "x.glb");
  inner["children"] = json::array({tile_json(1, "../tileset.json")});
  tiles.add("b/tileset.json", tileset_json(inner, 4).dump());
  tiles.add("a.glb", box_glb({{}}));
  tiles.add("b/x.glb", box_glb({{}}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(ids_of(read), (std::set<std::string>{"a.glb", "b/x.glb"}));
  EXPECT_EQ(read.report.holes, 1u);
  EXPECT_NE(read.report.first_hole.find("contains itself"), std::string::npos) << read.report.first_hole;
}

TEST(Tileset, NamesWhatIsWrong) {
  const auto refuse = [](const json& tileset, ErrorCode code, const TilesetOptions& options = {}) {
    Tileset tiles(tileset);
    tiles.add("a.glb", box_glb({{}}));
    expect_error([&] { tiles.read(options); }, code, "tileset.json");
  };
  refuse({}, ErrorCode::mesh_format_unknown);
  refuse(tileset_json(7), ErrorCode::mesh_syntax);
  refuse(tileset_json(tile_json(0, "a.glb"), 1, "2.0"), ErrorCode::mesh_unsupported);
  json needs = tileset_json(tile_json(0, "a.glb"));
  needs["extensionsRequired"] = {"ACME_other_tiles"};
  refuse(needs, ErrorCode::mesh_unsupported);
  json garbled = tile_json(0, "a.glb");
  garbled["transform"] = {1, 2};
  refuse(tileset_json(garbled), ErrorCode::mesh_syntax);
  refuse(tileset_json(tile_json(0)), ErrorCode::mesh_empty);
  TilesetOptions options;
  options.radius_m = 5;
  refuse(tileset_json(tile_json(0, "a.glb")), ErrorCode::missing_key, options);
  options.center_deg = {48, 11};
  refuse(tileset_json(tile_json(0, "a.glb")), ErrorCode::not_georeferenced, options);
  options.radius_m = -5;
  refuse(tileset_json(tile_json(0, "a.glb")), ErrorCode::value_out_of_range, options);
  options = {};
  options.detail_m = -1;
  refuse(tileset_json(tile_json(0, "a.glb")), ErrorCode::value_out_of_range, options);
}

TEST(Tileset, IsAKindOfScene) {
  EXPECT_EQ(source_kind("a/Tileset.JSON"), SceneSource::Kind::tileset);
  EXPECT_EQ(source_kind("a/town.json"), SceneSource::Kind::mesh);
  const testing::TemporaryDirectory folder;
  testing::write_bytes(folder / "map.json", R"({"version": 0.6, "generator": "Overpass API", "elements": []})");
  EXPECT_EQ(source_kind(folder / "map.json"), SceneSource::Kind::map);
  testing::write_bytes(folder / "city.json", R"({"type": "CityJSON", "version": "2.0", "metadata": {"elements": 3}})");
  EXPECT_EQ(source_kind(folder / "city.json"), SceneSource::Kind::mesh);
  Tileset tiles(tileset_json(tile_json(0, "a.glb")));
  tiles.add("a.glb", box_glb({{}}));
  SceneSource source;
  source.kind = source_kind(tiles.file());
  source.file = tiles.file();
  const LoadedScene loaded = load_scene(source);
  ASSERT_TRUE(loaded.tileset);
  EXPECT_EQ(loaded.tileset->triangles, 12u);
  EXPECT_FALSE(notes_of(loaded).empty());
}

TEST(Tileset, MissionsWarnOfMissingTiles) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "b.glb")});
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  const auto has_warning = [&] {
    const MissionFile file = read_mission_text(
        "scene: {tiles: tileset.json}\ntarget: {vertices: [[5, 0, 2], [6, 0, 2], [6, 1, 2]]}\nsensor: {max_range: 9}\n",
        tiles.path() / "mission.yaml");
    const std::vector<Warning> warnings = mission_warnings(resolve_mission(file));
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const Warning& one) { return one.code == WarningCode::scene_incomplete; });
  };
  EXPECT_TRUE(has_warning());
  tiles.add("b.glb", box_glb({{{3, 0, 3}}}));
  EXPECT_FALSE(has_warning());
}

TEST(Tileset, ManyChildrenAreReadInTime) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  json children = json::array();
  for (int i = 0; i < 100'000; ++i) children.push_back({{"geometricError", 0}});
  children.push_back(tile_json(0, "a.glb"));
  root["children"] = std::move(children);
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  EXPECT_EQ(tiles.read().report.tiles, 100'002u);
}

/// The entries, by id.
std::map<std::string, LedgerEntry> ledger_of(const TilesetScene& tiles) {
  std::map<std::string, LedgerEntry> entries;
  for (const LedgerEntry& entry : tiles.scene.ledger) entries[entry.object.source_id] = entry;
  return entries;
}

// What a tile holds that is missing still stands there.
TEST(Tileset, HoldsThePlaceOfTilesThatAreMissing) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "gone.glb", 20)});
  root["children"][1]["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 60, 0, 0, 1};
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  const TilesetScene read = tiles.read();
  const LedgerEntry entry = ledger_of(read)["gone.glb"];
  ASSERT_EQ(entry.stand_in, 1u);
  EXPECT_EQ(read.scene.objects[1].kind, ObjectKind::stand_in);
  EXPECT_EQ(entry.box->min, Vec3(40, -20, -20));
  EXPECT_EQ(entry.box->max, Vec3(80, 20, 20));
  EXPECT_EQ(bounding_box(read.scene.mesh).max, Vec3(80, 20, 20));
  EXPECT_TRUE(entry.may_be_larger);
  TilesetOptions options;
  options.missing = MissingPolicy::warn;
  EXPECT_EQ(tiles.read(options).scene.objects.size(), 1u);
  EXPECT_EQ(tiles.read(options).scene.ledger.size(), 1u);
  options.missing = MissingPolicy::refuse;
  expect_error([&] { tiles.read(options); }, ErrorCode::scene_incomplete, "tileset.json");
}

// Results and reports have the ids and the reasons of the ledger.
TEST(Tileset, TheLedgerHasNoKeysOfServers) {
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb")});
  const std::vector<std::string> uris = {"http://me:SECRET@a.example/x.b3dm?key=SECRET",
                                         "ftp://me:SECRET@a.example/x",
                                         "//me:SECRET@a.example/x.b3dm",
                                         "data:text/plain;base64,SECRET",
                                         "gone.b3dm?key=SECRET",
                                         "gone.glb;key=SECRET"};
  for (const std::string& uri : uris) root["children"].push_back(tile_json(0, uri));
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  const TilesetScene read = tiles.read();
  ASSERT_EQ(read.scene.ledger.size(), uris.size());
  for (const LedgerEntry& entry : read.scene.ledger) {
    EXPECT_EQ((entry.object.source_id + entry.reason).find("SECRET"), std::string::npos)
        << entry.object.source_id << ": " << entry.reason;
    EXPECT_FALSE(entry.object.source_id.empty());
  }
  EXPECT_EQ(read.report.first_hole.find("SECRET"), std::string::npos) << read.report.first_hole;
  EXPECT_TRUE(ledger_of(read).contains("ftp://a.example/x"));
}

TEST(Tileset, ACoarserTileHoldsThePlaceOfAFinerOne) {
  json root = tile_json(50, "coarse.glb");
  root["refine"] = "REPLACE";
  root["children"] = json::array({tile_json(0, "fine.glb"), tile_json(0, "other.glb")});
  Tileset tiles(tileset_json(root));
  for (const char* name : {"coarse.glb", "other.glb"}) tiles.add(name, box_glb({{}}));
  const TilesetScene read = tiles.read();
  const LedgerEntry entry = ledger_of(read)["fine.glb"];
  ASSERT_TRUE(entry.stand_in);
  EXPECT_EQ(read.scene.objects[*entry.stand_in].source_id, "coarse.glb");
  EXPECT_EQ(read.scene.objects.size(), 2u);
}

// What is missing in files that are read is another thing.
TEST(Tileset, ACoarserTileHoldsThePlaceOfFilesAlone) {
  json root = tile_json(50, "coarse.cmpt");
  root["refine"] = "REPLACE";
  json fine = tile_json(0);
  fine["contents"] = {{{"uri", "cloud.pnts"}}, {{"uri", "gone.glb"}}};
  root["children"] = json::array({fine});
  Tileset tiles(tileset_json(root));
  tiles.add("coarse.cmpt", cmpt({b3dm(box_glb({{}})), two_points()}));
  tiles.add("cloud.pnts", two_points());
  const TilesetScene read = tiles.read();
  std::map<std::string, LedgerEntry> ledger = ledger_of(read);
  ASSERT_EQ(ledger.size(), 3u);
  for (const char* id : {"cloud.pnts", "coarse.cmpt"}) {
    ASSERT_TRUE(ledger[id].stand_in) << id;
    EXPECT_EQ(read.scene.objects[*ledger[id].stand_in].kind, ObjectKind::stand_in) << id;
    EXPECT_EQ(ledger[id].instead, "its box") << id;
  }
  ASSERT_TRUE(ledger["gone.glb"].stand_in);
  EXPECT_EQ(read.scene.objects[*ledger["gone.glb"].stand_in], (SceneObject{"house", "coarse.cmpt", ObjectKind::other}));
}

/// The same on the earth, within 100 m of its place.
TilesetScene read_on_earth(Tileset& tiles, json root) {
  root["transform"] = testing::transform_at(52, 4.4);
  tiles.add("tileset.json", tileset_json(std::move(root)).dump());
  TilesetOptions options;
  options.center_deg = {52, 4.4};
  options.radius_m = 100;
  return tiles.read(options);
}

// A tile of which the finer ones lie beyond the circle would only hold what is not there.
TEST(Tileset, WhatIsReplacedBeyondTheCircleStaysOut) {
  json root = tile_json(50, "coarse.glb", 5000);
  root["refine"] = "REPLACE";
  json beyond = tile_json(0, "fine.glb", 60), empty = tile_json(0, "", 60);
  beyond["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1000, 0, 0, 1};
  root["children"] = json::array({beyond, empty, tile_json(0, "other.glb", 60)});
  Tileset tiles(tileset_json(root));
  for (const char* name : {"coarse.glb", "fine.glb", "other.glb"}) tiles.add(name, box_glb({{}}));
  EXPECT_EQ(ids_of(read_on_earth(tiles, root)), std::set<std::string>{"other.glb"});
  root["children"].erase(2);
  expect_code([&] { read_on_earth(tiles, root); }, ErrorCode::region_empty, "");
  root["children"].erase(0);
  EXPECT_EQ(ids_of(read_on_earth(tiles, root)), std::set<std::string>{"coarse.glb"});
}

TEST(Tileset, TheLedgerKeepsWhatReachesIntoTheCircle) {
  json root = tile_json(10, "", 5000);
  root["refine"] = "ADD";
  json across = tile_json(0, "across.glb", 60), beyond = tile_json(0, "beyond.glb", 60);
  const double half = std::sqrt(0.5);  // an eighth of a turn: a corner of its upright box is within, and nothing of it
  across["transform"] = {half, half, 0, 0, -half, half, 0, 0, 0, 0, 1, 0, 150, 150, 0, 1};
  beyond["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 180, 0, 0, 1};
  root["children"] = json::array({tile_json(0, "a.glb", 60), across, beyond});
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  const TilesetScene read = read_on_earth(tiles, root);
  EXPECT_EQ(read.report.holes, 2u);
  ASSERT_EQ(read.scene.ledger.size(), 1u);
  EXPECT_EQ(read.scene.ledger[0].object.source_id, "across.glb");
  ASSERT_EQ(read.scene.ledger[0].stand_in, 1u);
  EXPECT_EQ(read.scene.objects[1].kind, ObjectKind::stand_in);
}

TEST(Tileset, OfACoarserTileAnObjectWithinTheCircleHoldsThePlace) {
  json root = tile_json(50, "coarse.glb", 5000);
  root["refine"] = "REPLACE";
  root["children"] = json::array({tile_json(0, "fine.glb", 60)});
  Tileset tiles(tileset_json(root));
  const auto coarse_with = [&](double near_m) {
    const json nodes = {{{"children", {1, 2}}},
                        {{"mesh", 0}, {"name", "far"}, {"translation", {250, 0, 0}}},
                        {{"mesh", 0}, {"name", "near"}, {"translation", {near_m, 0, 0}}}};
    tiles.add("coarse.glb", box_glb({{}}, "", {{"nodes", nodes}}));
  };
  coarse_with(20);
  const TilesetScene read = read_on_earth(tiles, root);
  ASSERT_EQ(read.scene.ledger.size(), 1u);
  ASSERT_EQ(read.scene.ledger[0].stand_in, 0u);
  EXPECT_EQ(read.scene.objects[0].name, "near");
  // Nothing of it is there.
  root["children"].push_back(tile_json(0, "other.glb", 60));
  tiles.add("other.glb", box_glb({{}}));
  coarse_with(250);
  const TilesetScene without = read_on_earth(tiles, root);
  ASSERT_EQ(without.scene.ledger.size(), 1u);
  EXPECT_FALSE(without.scene.ledger[0].stand_in);
  EXPECT_TRUE(without.scene.ledger[0].instead.empty());
}

// The numbers of objects in a file that vantage wrote are its own.
TEST(Tileset, TheLedgersOfTilesNameObjectsOfTheScene) {
  Scene two;
  two.mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 9), Vec3(1, 0, 9), Vec3(0, 1, 9)};
  two.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  two.object_of = {0, 1};
  two.objects = named({"first", "second"});
  LedgerEntry entry{{"", "way/7"}, "building", "no height"};
  entry.box = Box{Vec3(0, 0, 0), Vec3(1, 2, 9)};
  entry.stand_in = 1;
  entry.instead = "a roof";
  two.ledger = {entry};
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "b.glb")});
  root["children"][1]["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 30, 0, 0, 1};
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  write_scene(two, tiles.path() / "b.glb");
  const TilesetScene read = tiles.read();
  ASSERT_EQ(read.scene.ledger.size(), 1u);
  const LedgerEntry& told = read.scene.ledger[0];
  ASSERT_TRUE(told.stand_in);
  EXPECT_EQ(read.scene.objects.at(*told.stand_in).name, "second");
  EXPECT_EQ(told.instead, "a roof");
  ASSERT_TRUE(told.box);
  EXPECT_LT((told.box->min - Vec3(30, 0, 0)).norm(), 1e-6);
  EXPECT_LT((told.box->max - Vec3(31, 2, 9)).norm(), 1e-6);
}

// A region is a place on the earth: in a tileset that is nowhere it says nothing.
TEST(Tileset, RegionsHoldNoPlaceOffTheEarth) {
  json root = tile_json(0, "all.cmpt");
  root["boundingVolume"] = {{"region", {0.1, 0.9, 0.1001, 0.9001, 0, 100}}};
  Tileset tiles(tileset_json(root));
  const json packed = {{"POINTS_LENGTH", 2}, {"extensions", {{"3DTILES_draco_point_compression", json::object()}}}};
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), testing::pnts(packed, "")}));
  TilesetOptions options;
  options.crs = "none";
  const TilesetScene read = tiles.read(options);
  ASSERT_EQ(read.scene.ledger.size(), 1u);
  EXPECT_FALSE(read.scene.ledger[0].box);
  EXPECT_FALSE(read.scene.ledger[0].stand_in);
}

TEST(Tileset, HoldsThePlaceOfCloudsOfPoints) {
  Tileset tiles(tileset_json(tile_json(0, "all.cmpt", 1000)));
  tiles.add("all.cmpt", cmpt({b3dm(box_glb({{}})), two_points()}));
  const TilesetScene read = tiles.read();
  const LedgerEntry entry = ledger_of(read)["all.cmpt"];
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  ASSERT_TRUE(entry.box);
  EXPECT_EQ(entry.box->min, Vec3(11, 2, 3));
  EXPECT_EQ(entry.box->max, Vec3(14, 5, 6));
  EXPECT_TRUE(entry.stand_in);
}

}  // namespace
}  // namespace vantage
