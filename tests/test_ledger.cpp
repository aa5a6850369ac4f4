// What a map says stands there and that cannot be built as it stands: what stands in for it, and who is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/navigation.h"
#include "vantage/scene_source.h"

namespace vantage {
namespace {

using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

class LedgerTest : public ::testing::Test {
 protected:
  Scene build(const MapText& map, CityOptions options = {}) {
    options.region = {{{48.1374, 11.5755}}, 2000, {}};  // the origin of MapText
    write_bytes(folder_ / "city.osm", map.text());
    return build_city(folder_ / "city.osm", options).scene;
  }

  Mission mission(const MapText& map, const std::string& text) {
    write_bytes(folder_ / "city.osm", map.text());
    enable_maps();
    write_bytes(folder_ / "mission.yaml", text);
    return resolve_mission(read_mission(folder_ / "mission.yaml"));
  }

  TemporaryDirectory folder_;
};

const LedgerEntry& entry_of(const Scene& scene, const std::string& id) {
  const auto found = std::find_if(scene.ledger.begin(), scene.ledger.end(),
                                  [&](const LedgerEntry& entry) { return entry.object.source_id == id; });
  if (found == scene.ledger.end()) throw std::runtime_error("the ledger has no " + id);
  return *found;
}

/// The box round an object of the scene.
Box box_of(const Scene& scene, const std::string& id) {
  Box box;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (scene.objects[scene.object_of[i]].source_id != id) continue;
    for (const std::uint32_t vertex : scene.mesh.triangles[i]) box.extend(scene.mesh.vertices[vertex]);
  }
  return box;
}

/// 40 m high on a square of 60 m; positions are good to a centimetre.
void expect_block(const Scene& scene, const std::string& id) {
  const Box box = box_of(scene, id);
  ASSERT_FALSE(box.empty()) << id << " is not built";
  EXPECT_NEAR(box.max.x() - box.min.x(), 60, 0.05) << id;
  EXPECT_NEAR(box.max.y() - box.min.y(), 60, 0.05) << id;
  EXPECT_NEAR(box.max.z(), 40, 1e-6) << id;
}

/// A roof over a point: how many facets of the object that face up hold it in plan.
bool covers(const Scene& scene, const std::string& id, double x, double y) {
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (scene.objects[scene.object_of[i]].source_id != id) continue;
    const Triangle& t = scene.mesh.triangles[i];
    const Vec3 &a = scene.mesh.vertices[t[0]], &b = scene.mesh.vertices[t[1]], &c = scene.mesh.vertices[t[2]];
    const auto turn = [&](const Vec3& p, const Vec3& q) {
      return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
    };
    if (turn(a, b) > 0 && turn(b, c) > 0 && turn(c, a) > 0) return true;
  }
  return false;
}

const MapText::TagList kBlock = {{"type", "multipolygon"}, {"building", "yes"}, {"height", "40"}};

/// A block whose courtyard is drawn from `west` to `east`.
MapText block_with_courtyard(double west, double east) {
  MapText map;
  const long outer = map.box(-30, -30, 30, 30, {});
  const long inner = map.box(west, -10, east, 10, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}}, kBlock);
  map.box(200, -5, 210, 5, {{"building", "yes"}, {"height", "5"}});
  return map;
}

TEST_F(LedgerTest, ACourtyardThatIsAtFaultIsFilled) {
  for (const auto& [west, east] : {std::pair{10.0, 30.05}, {10.0, 40.0}, {10.0, 30.0}}) {
    const Scene scene = build(block_with_courtyard(west, east));
    expect_block(scene, "relation/1");
    EXPECT_TRUE(covers(scene, "relation/1", 15, 1)) << east;
    EXPECT_TRUE(entry_of(scene, "relation/1").stand_in) << east;
  }
  const Scene sound = build(block_with_courtyard(-10, 10));
  EXPECT_FALSE(covers(sound, "relation/1", 0, 1)) << "a courtyard that is right stays open";
  EXPECT_TRUE(sound.ledger.empty());
}

TEST_F(LedgerTest, AnotherCourtyardStaysOpenBesideOneThatIsAtFault) {
  MapText map;
  const long outer = map.box(-30, -30, 30, 30, {});
  const long torn = map.box(10, -10, 30.05, 10, {}), right = map.box(-20, -10, -10, 10, {});
  map.relation({{"way", outer, "outer"}, {"way", torn, "inner"}, {"way", right, "inner"}}, kBlock);
  const Scene scene = build(map);
  expect_block(scene, "relation/1");
  EXPECT_TRUE(covers(scene, "relation/1", 20, 1));
  EXPECT_FALSE(covers(scene, "relation/1", -15, 1));
}

TEST_F(LedgerTest, RingsAreClosedWhateverTheRelationIs) {
  for (const std::string type : {"multipolygon", "boundary", ""}) {
    MapText map;
    const long outer = map.box(-30, -30, 30, 30, {});
    MapText::TagList tags = {{"building", "yes"}, {"height", "40"}};
    if (!type.empty()) tags.emplace_back("type", type);
    map.relation({{"way", outer, "outer"}}, tags);
    expect_block(build(map), "relation/1");
  }
  MapText open;
  const long a = open.node(-30, -30), b = open.node(30, -30), c = open.node(30, 30), d = open.node(-30, 30);
  const long south = open.way({a, b}, {}), east = open.way({b, c}, {}), north = open.way({c, d}, {});
  open.relation({{"way", south, "outer"}, {"way", east, "outer"}, {"way", north, "outer"}}, kBlock);
  const Scene scene = build(open);
  expect_block(scene, "relation/1");
  EXPECT_TRUE(entry_of(scene, "relation/1").may_be_larger);
}

TEST_F(LedgerTest, ABuildingRelationWithoutATaggedOutlineIsBuilt) {
  MapText map;
  const long outline = map.box(-30, -30, 30, 30, {});
  map.relation({{"way", outline, "outline"}}, {{"type", "building"}, {"building", "yes"}, {"height", "40"}});
  const Scene scene = build(map);
  expect_block(scene, "relation/1");
  EXPECT_TRUE(scene.ledger.empty());
}

TEST_F(LedgerTest, ARelationOfAnotherTypeIsOnlyTold) {
  MapText map;
  const long outline = map.box(-30, -30, 30, 30, {});
  map.relation({{"way", outline, "outer"}}, {{"type", "site"}, {"building", "yes"}, {"height", "40"}});
  map.box(200, -5, 210, 5, {{"building", "yes"}});
  const Scene scene = build(map);
  EXPECT_TRUE(box_of(scene, "relation/1").empty());
  const LedgerEntry& entry = entry_of(scene, "relation/1");
  EXPECT_FALSE(entry.stand_in);
  ASSERT_TRUE(entry.box);
  EXPECT_NEAR(entry.box->max.x(), 30, 0.05);
  EXPECT_EQ(entry.height_m, 40);
}

TEST_F(LedgerTest, WhatSwappedCornersWouldHoldIsHeld) {
  MapText map;
  map.area({{-30, -30}, {30, 30}, {30, -30}, {-30, 30}}, {{"building", "yes"}, {"height", "40"}});
  const Scene scene = build(map);
  expect_block(scene, "way/1");
  for (const double x : {-20.0, 20.0}) EXPECT_TRUE(covers(scene, "way/1", x, 1) && covers(scene, "way/1", 1, x));
  EXPECT_TRUE(entry_of(scene, "way/1").stand_in);
}

TEST_F(LedgerTest, MembersThatAreMissingMayHaveReachedFarther) {
  MapText map;
  const long a = map.node(-30, -30), b = map.node(30, -30), c = map.node(30, 30);
  const long there = map.way({a, b, c}, {});
  map.relation({{"way", there, "outer"}, {"way", 99, "outer"}}, kBlock);
  const Scene scene = build(map);
  expect_block(scene, "relation/1");
  const LedgerEntry& entry = entry_of(scene, "relation/1");
  EXPECT_TRUE(entry.may_be_larger);
  EXPECT_EQ(scene.objects.at(*entry.stand_in).kind, ObjectKind::stand_in);
  testing::expect_wording(entry.reason);
  testing::expect_wording(entry.instead);
}

// ---- things with a height and without a model

TEST_F(LedgerTest, ThingsWithAHeightStandIn) {
  struct Thing {
    MapText::TagList tags;
    std::string without;
  };
  const std::vector<Thing> things = {{{{"power", "tower"}}, "masts"},
                                     {{{"aerialway", "pylon"}}, "masts"},
                                     {{{"power", "generator"}, {"generator:source", "wind"}}, "turbines"},
                                     {{{"man_made", "crane"}}, "cranes"},
                                     {{{"man_made", "obelisk"}}, "monuments"},
                                     {{{"historic", "monument"}}, "monuments"},
                                     {{{"advertising", "billboard"}}, "others"}};
  MapText map;
  for (std::size_t i = 0; i < things.size(); ++i) {
    MapText::TagList tags = things[i].tags;
    tags.emplace_back("height", "45");
    map.node(200.0 * static_cast<double>(i), 0, tags);
  }
  const long wood = map.box(0, 100, 60, 160, {{"natural", "wood"}, {"height", "25"}});
  const long stadium = map.box(100, 100, 160, 160, {{"leisure", "stadium"}, {"height", "30"}});
  const Scene scene = build(map);
  for (std::size_t i = 0; i < things.size(); ++i) {
    const std::string id = "node/" + std::to_string(i + 1);
    EXPECT_NEAR(box_of(scene, id).max.z(), 45, 1e-6) << id;
    EXPECT_EQ(entry_of(scene, id).without, things[i].without) << id;
    EXPECT_TRUE(entry_of(scene, id).may_be_larger) << "nobody knows how wide it is";
  }
  EXPECT_EQ(entry_of(scene, "way/" + std::to_string(wood)).without, "woods");
  EXPECT_FALSE(entry_of(scene, "way/" + std::to_string(stadium)).may_be_larger) << "its outline is known";
  CityOptions options;
  for (const char* kind : {"woods", "stadiums", "masts", "cranes", "turbines", "monuments"}) {
    leave_out(options.occluders, kind, "here");
  }
  EXPECT_EQ(build(map, options).ledger.size(), 1u) << "the billboard";
}

TEST_F(LedgerTest, WhatIsNotInTheOpenOrOnlyFurnitureIsNot) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  const std::vector<MapText::TagList> things = {{{"man_made", "flagpole"}},
                                                {{"amenity", "bench"}},
                                                {{"highway", "street_lamp"}},
                                                {{"barrier", "bollard"}},
                                                {{"natural", "peak"}},
                                                {{"man_made", "crane"}, {"indoor", "yes"}},
                                                {{"man_made", "tank"}, {"location", "underground"}},
                                                {{"man_made", "obelisk"}, {"layer", "-1"}},
                                                {{"historic", "monument"}, {"level", "-2"}},
                                                {{"demolished:man_made", "crane"}},
                                                {{"man_made", "crane"}, {"proposed", "yes"}}};
  for (MapText::TagList tags : things) {
    tags.emplace_back("height", "9");
    map.node(100, 100, tags);
  }
  const Scene scene = build(map);
  EXPECT_TRUE(scene.ledger.empty()) << scene.ledger.front().what;
}

TEST_F(LedgerTest, HeightsThatAreNoPlainNumbersCountByTheirLargest) {
  struct Height {
    const char *key, *value;
    double metres;
  };
  const std::vector<Height> heights = {{"height", "13-22", 22},
                                       {"height", "22m - 25m", 25},
                                       {"height", "~22", 22},
                                       {"height", "22 m (approx)", 22},
                                       {"height", "22/13", 22},
                                       {"height", "10 storeys", 30},
                                       {"height", "1.5e1", 15},
                                       {"height", "ca. 72 ft", 72 * 0.3048},
                                       {"building:levels", "2-3", 9},
                                       {"building:levels", "G+5", 18},
                                       {"height", "\xEF\xBC\x91\xEF\xBC\x92", 12}};
  MapText map;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double east = 50.0 * static_cast<double>(i);
    map.box(east, 0, east + 20, 20, {{"building", "yes"}, {heights[i].key, heights[i].value}});
  }
  map.box(0, 100, 20, 120, {{"building", "yes"}, {"height", "twenty"}});
  const Scene scene = build(map);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::string id = "way/" + std::to_string(i + 1);
    EXPECT_NEAR(box_of(scene, id).max.z(), heights[i].metres, 1e-6) << heights[i].value;
    EXPECT_FALSE(entry_of(scene, id).may_be_larger) << heights[i].value;
  }
  EXPECT_TRUE(entry_of(scene, "way/12").may_be_larger) << "nothing tells it";
}

TEST_F(LedgerTest, OfTwoBottomsTheLowerCounts) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building:part", "yes"}, {"height", "20"}, {"min_height", "5;5.5"}});
  EXPECT_NEAR(box_of(build(map), "way/1").min.z(), 5, 1e-6);
}

TEST_F(LedgerTest, ClearanceIsKeptFromLinesOverhead) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  const long a = map.node(50, -50, {{"power", "tower"}, {"height", "45"}}), b = map.node(50, 50, {{"power", "tower"}});
  map.way({a, b}, {{"power", "line"}});
  map.line({{-50, -50}, {-50, 50}}, {{"power", "minor_line"}, {"location", "underground"}});
  const Scene scene = build(map);
  const Box box = bounding_box(scene.overhead);
  EXPECT_NEAR(box.max.z(), 45, 1e-6);
  EXPECT_NEAR(box.min.x(), box.max.x(), 0.02);
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), scene.mesh.triangles.size()) << "two more, without the ground's two";
  CityOptions options;
  options.occluders.lines = false;
  EXPECT_TRUE(build(map, options).overhead.empty());
}

// ---- who is told

std::string town_mission(const std::string& more) {
  return "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300" + more +
         "}\ntarget: {vertices: [[40, -3, 0], [46, -3, 0], [46, 3, 0], [40, 3, 0]]}\nsensor: {max_range: 60}\n";
}

std::size_t count(const std::vector<Warning>& warnings, WarningCode code) {
  return static_cast<std::size_t>(
      std::count_if(warnings.begin(), warnings.end(), [&](const Warning& one) { return one.code == code; }));
}

TEST_F(LedgerTest, MissionsWarnOfWhatLiesWithinReachAlone) {
  const Mission near = mission(block_with_courtyard(10, 30.05), town_mission(""));
  const std::vector<Warning> warnings = mission_warnings(near);
  ASSERT_EQ(count(warnings, WarningCode::scene_incomplete), 1u);
  for (const Warning& warning : warnings) {
    if (warning.code == WarningCode::scene_incomplete) testing::expect_wording(warning.text);
  }
  MapText far = block_with_courtyard(-10, 10);
  far.area({{-130, -30}, {-110, 30}, {-110, -30}, {-130, 30}}, {{"building", "yes"}});
  EXPECT_EQ(count(mission_warnings(mission(far, town_mission(""))), WarningCode::scene_incomplete), 0u);
}

TEST_F(LedgerTest, StandInsCanBeWarnedOfOnlyOrRefused) {
  MapText map = block_with_courtyard(-10, 10);
  map.node(60, 0, {{"man_made", "crane"}, {"height", "40"}});
  const Mission blocked = mission(map, town_mission(""));
  EXPECT_FALSE(box_of(blocked.scene(), "node/13").empty());
  const Mission warned = mission(map, town_mission(", missing: warn"));
  EXPECT_TRUE(box_of(warned.scene(), "node/13").empty());
  EXPECT_EQ(count(mission_warnings(warned), WarningCode::scene_incomplete), 1u);
  EXPECT_FALSE(entry_of(warned.scene(), "node/13").stand_in);
  testing::expect_error([&] { mission(map, town_mission(", missing: refuse")); }, ErrorCode::scene_incomplete);
}

TEST_F(LedgerTest, AStandInIsNoTarget) {
  MapText map = block_with_courtyard(-10, 10);
  const long crane = map.node(60, 0, {{"man_made", "crane"}, {"height", "40"}});
  testing::expect_error(
      [&] {
        mission(map, "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\ntarget: {osm: node/" +
                         std::to_string(crane) + ", part: roof}\nsensor: {max_range: 60}\n");
      },
      ErrorCode::face_missing);
}

TEST_F(LedgerTest, ATargetInAStandInIsToldWhatLeavesItOut) {
  MapText map = block_with_courtyard(-10, 10);
  map.box(35, -20, 80, 20, {{"natural", "wood"}, {"height", "25"}});
  const Mission wooded = mission(map, town_mission(""));
  const std::vector<Warning> warnings = mission_warnings(wooded);
  ASSERT_EQ(count(warnings, WarningCode::target_inside), 1u);
  for (const Warning& warning : warnings) {
    if (warning.code == WarningCode::target_inside) testing::expect_wording(warning.text);
  }
}

}  // namespace
}  // namespace vantage
