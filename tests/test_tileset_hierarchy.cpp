// Hierarchies of batch tables (3DTILES_batch_table_hierarchy): features are named by their classes and parents.
// https://github.com/CesiumGS/3d-tiles/tree/main/extensions/3DTILES_batch_table_hierarchy
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/mesh_reading.h"
#include "support/tile_files.h"
#include "support/tileset_folder.h"
#include "support/wording.h"
#include "vantage/tileset.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::bytes_of;
using testing::expect_wording;
using testing::Tileset;

constexpr const char* kHierarchy = "3DTILES_batch_table_hierarchy";
using Identity = std::vector<std::string>;  // source id, name

json class_of(const std::string& name, std::size_t length, const json& instances) {
  return {{"name", name}, {"length", length}, {"instances", instances}};
}

/// The sample of the extension's section "Batch table JSON schema updates": walls, buildings, owners.
json block_of_houses() {
  return {{"classes",
           {class_of("Wall", 6, {{"color", {"white", "red", "yellow", "gray", "brown", "black"}}}),
            class_of(
                "Building", 3,
                {{"name", {"unit29", "unit20", "unit93"}}, {"address", {"100 Main St", "102 Main St", "104 Main St"}}}),
            class_of("Owner", 3, {{"type", {"city", "resident", "commercial"}}, {"id", {1120, 1250, 6445}}})}},
          {"instancesLength", 12},
          {"classIds", {0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2}},
          {"parentCounts", {1, 3, 2, 1, 1, 1, 1, 1, 1, 0, 0, 0}},
          {"parentIds", {6, 6, 10, 11, 7, 11, 7, 8, 8, 10, 10, 9}}};
}

/// A tile of one box for each feature.
TilesetScene read_features(const json& hierarchy, int features, json batch = json::object(),
                           const std::string& binary = "") {
  batch["extensions"][kHierarchy] = hierarchy;
  Tileset tiles(testing::tileset_json(testing::tile_json(0, "a.b3dm"), 100, "1.0"));
  std::vector<testing::TileBox> boxes;
  for (int i = 0; i < features; ++i) boxes.push_back({{2.0 * i, 0, 0}, 5, i});
  tiles.add("a.b3dm", testing::b3dm(testing::box_glb(boxes, "_BATCHID"), {{"BATCH_LENGTH", features}}, batch, binary));
  TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  EXPECT_EQ(read.report.triangles, 12u * static_cast<unsigned>(features));
  return read;
}

/// Of each feature.
std::vector<Identity> identities(const TilesetScene& read) {
  std::vector<Identity> result;
  for (std::size_t i = 0; i < read.scene.object_of.size(); i += 12) {
    const SceneObject& object = read.scene.objects[read.scene.object_of[i]];
    result.push_back({object.source_id, object.name});
  }
  return result;
}

std::vector<Identity> names_of(const json& hierarchy, int features, const json& batch = json::object()) {
  const TilesetScene read = read_features(hierarchy, features, batch);
  EXPECT_EQ(read.report.unreadable_properties, 0u) << read.report.first_unreadable;
  return identities(read);
}

TEST(TilesetHierarchy, WallsWithoutNamesAreTheirBuildings) {
  const TilesetScene read = read_features(block_of_houses(), 6);
  EXPECT_EQ(read.report.unreadable_properties, 0u) << read.report.first_unreadable;
  const Identity first{"a.b3dm#6", "unit29"}, second{"a.b3dm#7", "unit20"}, third{"a.b3dm#8", "unit93"};
  EXPECT_EQ(identities(read), (std::vector<Identity>{first, first, second, second, third, third}));
  ASSERT_EQ(read.scene.objects.size(), 3u);
  EXPECT_EQ(read.scene.objects[0].kind, ObjectKind::building);  // the name of the class
}

TEST(TilesetHierarchy, FeaturesWithoutParentsAreInstancesOfTheirClass) {
  json lot = {{"classes",
               {class_of("Lamp", 3, {{"lampColor", {"yellow", "white", "white"}}}),
                class_of("Car", 3, {{"id", {1, 2, 3}}, {"name", {"truck", "bus", "sedan"}}}),
                class_of("Tree", 2, {{"id", {1, 2}}})}},
              {"instancesLength", 8},
              {"classIds", {0, 0, 0, 1, 1, 1, 2, 2}}};
  const TilesetScene read = read_features(lot, 8);
  EXPECT_EQ(identities(read), (std::vector<Identity>{{"a.b3dm#0", ""},
                                                     {"a.b3dm#1", ""},
                                                     {"a.b3dm#2", ""},
                                                     {"a.b3dm#Car/1", "truck"},
                                                     {"a.b3dm#Car/2", "bus"},
                                                     {"a.b3dm#Car/3", "sedan"},
                                                     {"a.b3dm#Tree/1", ""},
                                                     {"a.b3dm#Tree/2", ""}}));
  EXPECT_EQ(read.scene.objects.back().kind, ObjectKind::tree);
  lot["parentIds"] = {0, 1, 2, 3, 4, 5, 6, 7};  // each its own: none
  EXPECT_EQ(names_of(lot, 8), identities(read));
}

TEST(TilesetHierarchy, InheritsWhatAnInstanceLacks) {
  // Walls 0 and 1 of a building with an id in a block with another; wall 2 of a building that only has a number.
  json town = {{"classes",
                {class_of("Wall", 3, {{"name", {"", "gable", ""}}}),
                 class_of("House", 2, {{"gml_id", {"bldg_1", nullptr}}, {"id", {nullptr, 5}}}),
                 class_of("Block", 1, {{"gml_id", {"block_9"}}, {"bldg:address", {"Main Street"}}})}},
               {"instancesLength", 6},
               {"classIds", {0, 0, 0, 1, 1, 2}},
               {"parentIds", {3, 3, 4, 5, 5, 5}}};
  EXPECT_EQ(names_of(town, 3),
            (std::vector<Identity>{{"bldg_1", "Main Street"}, {"bldg_1", "gable"}, {"a.b3dm#House/5", "Main Street"}}));
  // What the batch table says of a feature itself goes before.
  EXPECT_EQ(names_of(town, 3, {{"gml_id", {"w", "", nullptr}}, {"name", {"south", "", nullptr}}}),
            (std::vector<Identity>{{"w", "south"}, {"bldg_1", "gable"}, {"a.b3dm#House/5", "Main Street"}}));
}

TEST(TilesetHierarchy, WhatStandsOnTheGroundIsNotGround) {
  json site = {{"classes", {class_of("Shed", 1, json::object()), class_of("Terrain", 1, {{"name", {"hill"}}})}},
               {"instancesLength", 2},
               {"classIds", {0, 1}},
               {"parentIds", {1, 1}}};
  const TilesetScene read = read_features(site, 2);
  ASSERT_EQ(read.scene.objects.size(), 2u);
  EXPECT_EQ(read.scene.objects[0], (SceneObject{"", "a.b3dm#0", ObjectKind::other}));
  EXPECT_EQ(read.scene.objects[1], (SceneObject{"hill", "a.b3dm#1", ObjectKind::ground}));
}

TEST(TilesetHierarchy, IsAlsoBinary) {
  std::string binary;
  for (const std::uint8_t id : {0, 0, 1, 1}) binary += bytes_of(id);
  for (const std::uint16_t parent : {2, 3, 2, 3}) binary += bytes_of(parent);
  binary += std::string(4, '\0');
  for (const std::uint32_t number : {70000u, 70001u}) binary += bytes_of(number);
  const json numbers = {{"byteOffset", 16}, {"componentType", "UNSIGNED_INT"}, {"type", "SCALAR"}};
  json town = {{"classes", {class_of("Wall", 2, json::object()), class_of("House", 2, {{"id", numbers}})}},
               {"instancesLength", 4},
               {"classIds", {{"byteOffset", 0}, {"componentType", "UNSIGNED_BYTE"}}},
               {"parentIds", {{"byteOffset", 4}}}};
  const TilesetScene read = read_features(town, 2, json::object(), binary);
  EXPECT_EQ(read.report.unreadable_properties, 0u) << read.report.first_unreadable;
  EXPECT_EQ(identities(read), (std::vector<Identity>{{"a.b3dm#House/70000", ""}, {"a.b3dm#House/70001", ""}}));

  town["classes"][1]["instances"]["id"]["byteOffset"] = 20;  // its last value lies beyond
  const TilesetScene cut = read_features(town, 2, json::object(), binary);
  EXPECT_EQ(identities(cut), (std::vector<Identity>{{"a.b3dm#0", ""}, {"a.b3dm#1", ""}}));
  EXPECT_EQ(cut.report.unreadable_properties, 1u);
  expect_wording(cut.report.first_unreadable);
}

TEST(TilesetHierarchy, GarbledOnesCostNamesAndNoGeometry) {
  const auto refuse_all = [](const json& garbled) {
    const TilesetScene read = read_features(garbled, 2);
    EXPECT_EQ(identities(read), (std::vector<Identity>{{"a.b3dm#0", ""}, {"a.b3dm#1", ""}}));
    EXPECT_EQ(read.report.unreadable_properties, 1u) << read.report.first_unreadable;
    expect_wording(read.report.first_unreadable);
  };
  const auto refuse = [&](const json::json_pointer& at, const json& value) {
    json garbled = block_of_houses();
    garbled[at] = value;
    refuse_all(garbled);
  };
  using Place = json::json_pointer;
  refuse(Place("/classIds/3"), 3);
  refuse(Place("/classIds/3"), -1);
  refuse(Place("/classIds/3"), 1);  // and now the class has four
  refuse(Place("/classIds/12"), 1);
  refuse(Place("/classIds"), {{"byteOffset", 0}});
  refuse(Place("/classIds"), {{"byteOffset", 0}, {"componentType", "FLOAT"}});
  refuse(Place("/parentIds/11"), 12);
  refuse(Place("/parentIds/11"), 0.5);
  refuse(Place("/parentCounts/0"), 4'000'000'000U);
  refuse(Place("/parentCounts/0"), 2);
  refuse(Place("/instancesLength"), 5'000'000'000U);
  refuse(Place("/instancesLength"), 11);
  refuse(Place("/classes/1/length"), 1e9);
  refuse(Place("/classes/1/length"), 1'000'000'000U);
  refuse(Place("/classes/1/instances"), 7);
  refuse(Place("/classes/1"), 7);
  refuse(Place("/classes"), "Wall");
  refuse(Place(""), 7);
  json circle = block_of_houses();  // building 6 is in 7, that in 8, and that in 6
  for (const std::size_t i : {9u, 10u, 11u}) circle["parentIds"][i] = i == 11u ? 6u : i - 2;
  refuse_all(circle);
}

/// A batch table that is no JSON, or JSON of another kind. Half of a surrogate pair is one that JSON allows.
TEST(TilesetHierarchy, GarbledBatchTablesCostNamesAndNoGeometry) {
  const std::string glb = testing::box_glb({{{0, 0, 0}, 5, 0}, {{2, 0, 0}, 5, 1}}, "_BATCHID");
  const json batch = {{"name", {"first.", "second"}}};
  const std::vector<std::string> tiles = {
      testing::b3dm(glb, {{"BATCH_LENGTH", 2}}, batch),
      testing::i3dm(glb, {{"INSTANCES_LENGTH", 1}, {"POSITION", {{"byteOffset", 0}}}}, std::string(12, '\0'), batch)};
  for (const std::string& tile : tiles) {
    const std::string text = batch.dump();
    for (const char* const garbled :
         {R"({"name":["\ud800","second"]})", R"(["name",["first.","second"]])", R"({"name":["first.","second")"}) {
      std::string bytes = tile, other = garbled;
      ASSERT_LE(other.size(), text.size());
      other.resize(text.size(), ' ');
      bytes.replace(bytes.find(text), text.size(), other);
      Tileset folder(testing::tileset_json(testing::tile_json(0, "a.tile"), 100, "1.0"));
      folder.add("a.tile", bytes);
      const TilesetScene read = folder.read();
      EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
      EXPECT_EQ(read.report.triangles, 24u);
      EXPECT_EQ(read.report.unreadable_properties, 1u);
    }
  }
}

TEST(TilesetHierarchy, GarbledPropertiesCostTheirNames) {
  json short_names = block_of_houses();
  short_names["classes"][1]["instances"]["name"] = {"unit29"};
  short_names["classes"][1]["instances"]["address"][2] = std::string(1001, 'x');
  const TilesetScene read = read_features(short_names, 2);
  EXPECT_EQ(read.report.unreadable_properties, 2u);
  expect_wording(read.report.first_unreadable);
  EXPECT_EQ(identities(read), (std::vector<Identity>{{"a.b3dm#Owner/1250", ""}, {"a.b3dm#Owner/1250", ""}}));

  json too_few = block_of_houses();
  const TilesetScene more = read_features(too_few, 13);
  EXPECT_EQ(more.report.unreadable_properties, 1u);
  EXPECT_EQ(identities(more).back(), (Identity{"a.b3dm#12", ""}));
  expect_wording(more.report.first_unreadable);
}

// Each instance has the two before it as parents: there are more paths up than could be counted.
TEST(TilesetHierarchy, ManyPathsAreWalkedInTime) {
  constexpr unsigned kCount = 50'000;
  json chain = {{"classes", {class_of("Part", kCount, {{"name", json::array()}})}}, {"instancesLength", kCount}};
  for (unsigned i = 0; i < kCount; ++i) {
    chain["classes"][0]["instances"]["name"].push_back(i + 1 == kCount ? "root" : "");
    chain["classIds"].push_back(0);
    chain["parentCounts"].push_back(2);
    chain["parentIds"].push_back(std::min(i + 1, kCount - 1));
    chain["parentIds"].push_back(std::min(i + 2, kCount - 1));
  }
  const Identity root{"a.b3dm#" + std::to_string(kCount - 1), "root"};
  EXPECT_EQ(names_of(chain, 2), (std::vector<Identity>{root, root}));
  chain["parentIds"][2 * (kCount - 1)] = 0;
  const TilesetScene circle = read_features(chain, 2);
  EXPECT_EQ(circle.report.unreadable_properties, 1u);
  expect_wording(circle.report.first_unreadable);
}

// A long name that many features inherit is not copied without end.
TEST(TilesetHierarchy, BoundsTheTextThatIsInherited) {
  constexpr int kFeatures = 80'000;
  json many = {{"classes",
                {class_of("Part", kFeatures, {{"id", json::array()}}),
                 class_of("Whole", 1, {{"name", {std::string(1000, 'x')}}})}},
               {"instancesLength", kFeatures + 1}};
  for (int i = 0; i <= kFeatures; ++i) {
    if (i < kFeatures) many["classes"][0]["instances"]["id"].push_back(i);
    many["classIds"].push_back(i < kFeatures ? 0 : 1);
    many["parentIds"].push_back(kFeatures);
  }
  const TilesetScene read = read_features(many, kFeatures);
  EXPECT_EQ(identities(read).front(), (Identity{"a.b3dm#Part/0", std::string(1000, 'x')}));
  EXPECT_EQ(identities(read).back(), (Identity{"a.b3dm#" + std::to_string(kFeatures - 1), ""}));
  EXPECT_GT(read.report.unreadable_properties, 0u);
  expect_wording(read.report.first_unreadable);
}

TEST(TilesetHierarchy, NamesInstances) {
  json batch;
  batch["extensions"][kHierarchy] = {
      {"classes", {class_of("Tree", 2, json::object()), class_of("Park", 1, {{"name", {"Green Park"}}})}},
      {"instancesLength", 3},
      {"classIds", {0, 0, 1}},
      {"parentIds", {2, 1, 2}}};
  Tileset tiles(testing::tileset_json(testing::tile_json(0, "a.i3dm"), 100, "1.0"));
  tiles.add("a.i3dm",
            testing::i3dm(testing::box_glb({{}}), {{"INSTANCES_LENGTH", 2}, {"POSITION", {{"byteOffset", 0}}}},
                          std::string(24, '\0'), batch));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(identities(read), (std::vector<Identity>{{"a.i3dm#2", "Green Park"}, {"a.i3dm#1", ""}}));
}

}  // namespace
}  // namespace vantage
