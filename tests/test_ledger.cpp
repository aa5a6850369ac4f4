// What a map says stands there and that cannot be built as it stands: what stands in for it, and who is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/ledger.h"
#include "common/ledger.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/navigation.h"
#include "vantage/result.h"
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

TEST_F(LedgerTest, AnOuterRingInsideAnotherOneIsNoCourtyard) {
  MapText map;
  const long outer = map.box(-30, -30, 30, 30, {}), other = map.box(-10, -10, 10, 10, {});
  map.relation({{"way", outer, "outer"}, {"way", other, "outer"}}, kBlock);
  const Scene scene = build(map);
  expect_block(scene, "relation/1");
  EXPECT_TRUE(covers(scene, "relation/1", 0, 1));
  testing::expect_wording(entry_of(scene, "relation/1").reason);
}

/// Rings of one relation that share nodes where they share positions, and the footprint that is built.
struct RingsCase {
  const char* name;
  std::vector<std::pair<std::string, MapText::Positions>> rings;  ///< role, and corners
  double area_m2;
  bool told;
};

MapText::Positions square(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

TEST_F(LedgerTest, NothingOfRingsThatMeetIsLost) {
  const MapText::Positions block = {{0, 0}, {5, 0}, {15, 0}, {20, 0}, {20, 10}, {20, 20}, {10, 20}, {0, 20}};
  const MapText::Positions wing = {{10, 20}, {10, 10}, {20, 10}, {30, 10}, {30, 30}, {10, 30}};
  const MapText::Positions away = square(40, 0, 50, 10);
  const RingsCase cases[] = {
      {"twice", {{"outer", block}, {"outer", block}, {"outer", away}}, 500, true},
      {"an outer and an inner one", {{"outer", block}, {"inner", block}, {"outer", away}}, 500, true},
      {"one in another along a side", {{"outer", block}, {"outer", square(5, 0, 15, 10)}}, 400, true},
      {"two that cross in corners", {{"outer", block}, {"outer", wing}}, 700, true},
      {"a hole that crosses in corners", {{"outer", block}, {"inner", wing}}, 400, true},
      {"a hole along a side", {{"outer", block}, {"inner", square(5, 0, 15, 10)}}, 400, true},
      {"a terrace", {{"outer", square(0, 0, 10, 10)}, {"outer", square(10, 0, 20, 10)}}, 200, false},
      {"a hole that touches in a corner", {{"outer", block}, {"inner", {{5, 0}, {10, 5}, {5, 10}}}}, 375, false},
      {"two that touch in a corner", {{"outer", block}, {"outer", square(20, 20, 30, 30)}}, 500, false},
      {"a speck", {{"outer", block}, {"outer", square(40, 0, 40.05, 0.05)}}, 400, true},
      {"holes that cross, one of them the outline",
       {{"outer", block}, {"inner", square(4, 5, 10, 10)}, {"inner", square(8, 7, 30, 9)}},
       400,
       true},
  };
  std::vector<std::string> reasons;
  for (const RingsCase& one : cases) {
    SCOPED_TRACE(one.name);
    MapText map;
    std::map<std::pair<double, double>, long> nodes;
    std::vector<MapText::Member> members;
    for (const auto& [role, corners] : one.rings) {
      std::vector<long> refs;
      for (const auto& at : corners) {
        const auto [known, is_new] = nodes.try_emplace(at, 0);
        if (is_new) known->second = map.node(at.first, at.second);
        refs.push_back(known->second);
      }
      refs.push_back(refs.front());
      members.push_back({"way", map.way(refs, {}), role});
    }
    map.relation(members, kBlock);
    map.box(200, -5, 210, 5, {{"building", "yes"}, {"height", "5"}});
    const Scene scene = build(map);
    double area = 0;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
      if (scene.objects[scene.object_of[i]].source_id != "relation/1") continue;
      const Triangle& t = scene.mesh.triangles[i];
      const Vec3 &a = scene.mesh.vertices[t[0]], &b = scene.mesh.vertices[t[1]], &c = scene.mesh.vertices[t[2]];
      area += std::max(0.0, (b - a).cross(c - a).z() / 2);
    }
    EXPECT_NEAR(area, one.area_m2, 0.5);
    EXPECT_EQ(!scene.ledger.empty(), one.told);
    for (const LedgerEntry& entry : scene.ledger) reasons.push_back(entry.reason + ": " + entry.instead);
  }
  testing::expect_wording(reasons);
}

TEST_F(LedgerTest, AKnownNodeBetweenMissingOnesIsHeld) {
  MapText map;
  const long house = map.box(0, 0, 10, 10, {});
  const long torn = map.way({98, map.node(50, 0), 99}, {});
  map.relation({{"way", house, "outer"}, {"way", torn, "outer"}}, kBlock);
  map.box(200, -5, 210, 5, {{"building", "yes"}});
  const Scene scene = build(map);
  EXPECT_TRUE(covers(scene, "relation/1", 5, 4));
  EXPECT_TRUE(covers(scene, "relation/1", 50, 1));
}

TEST_F(LedgerTest, AGuessedPartOpensNoHoleInItsBuilding) {
  MapText map;
  map.box(-30, -30, 30, 30, {{"building", "yes"}, {"height", "40"}});
  const long a = map.node(-20, -20), b = map.node(20, -20), c = map.node(20, 20);
  map.way({a, b, c, 99, a}, {{"building:part", "yes"}, {"height", "3"}});
  CityOptions warn;
  warn.missing = MissingPolicy::warn;
  for (const CityOptions& options : {CityOptions(), warn}) {
    const Scene scene = build(map, options);
    expect_block(scene, "way/1");
    EXPECT_TRUE(covers(scene, "way/1", 0, 1));
  }
}

TEST_F(LedgerTest, ABuildingRelationTellsOfMembersThatAreNotThere) {
  MapText map;
  const long part = map.box(-5, -5, 5, 5, {{"building:part", "yes"}, {"height", "40"}});
  map.relation({{"way", 99, "outline"}, {"way", part, "part"}}, {{"type", "building"}, {"building", "yes"}});
  const Scene scene = build(map);
  const LedgerEntry& entry = entry_of(scene, "relation/1");
  EXPECT_FALSE(entry.stand_in);
  ASSERT_TRUE(entry.box);
  EXPECT_NEAR(entry.box->max.x(), 5, 0.05);
  testing::expect_wording(entry.reason);
}

TEST_F(LedgerTest, OfAnOutlineWithOneCornerASquareStandsIn) {
  MapText map;
  const long only = map.node(0, 0);
  const long first = map.way({only, 98}, {}), second = map.way({99, only}, {});
  map.relation({{"way", first, "outer"}, {"way", second, "outer"}}, kBlock);
  map.box(200, -5, 210, 5, {{"building", "yes"}});
  const Scene scene = build(map);
  const Box box = box_of(scene, "relation/1");
  ASSERT_FALSE(box.empty());
  EXPECT_NEAR(box.max.x() - box.min.x(), 20, 0.05);
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

TEST_F(LedgerTest, ABuildingRelationWithUntaggedMembersIsBuilt) {
  for (const std::string role : {"", "outer", "part"}) {
    MapText map;
    const long member = map.box(-30, -30, 30, 30, {}), part = map.box(-5, -5, 5, 5, {{"building:part", "yes"}});
    std::vector<MapText::Member> members = {{"way", member, role}};
    if (role != "part") members.push_back({"way", part, "part"});
    map.relation(members, {{"type", "building"}, {"building", "yes"}, {"height", "40"}});
    const Scene scene = build(map);
    expect_block(scene, "relation/1");
    EXPECT_TRUE(scene.ledger.empty()) << role;
  }
}

TEST_F(LedgerTest, ABuildingRelationIsABuildingByItsType) {
  MapText map;
  map.relation({{"way", map.box(-30, -30, 30, 30, {}), "outline"}}, {{"type", "building"}, {"height", "40"}});
  const Scene scene = build(map);
  expect_block(scene, "relation/1");
  EXPECT_TRUE(scene.ledger.empty());
}

TEST_F(LedgerTest, BuildingsThatAreNoLongerUsedStand) {
  MapText map;
  const std::vector<std::string> standing = {"abandoned:building", "disused:building", "ruins:building",
                                             "construction:building", "abandoned:building:part"};
  map.box(0, -90, 60, -70, {{"building", "no"}, {"abandoned:building", "yes"}, {"name", "Old"}});
  for (std::size_t i = 0; i < standing.size(); ++i) {
    const double east = 100.0 * static_cast<double>(i);
    map.area({{east, 0}, {east + 60, 0}, {east + 60, 60}, {east, 60}}, {{standing[i], "yes"}, {"height", "40"}});
  }
  map.area({{0, 90}, {60, 90}, {60, 150}, {0, 150}}, {{"razed:building", "yes"}, {"building:levels", "9"}});
  const Scene scene = build(map);
  for (std::size_t i = 0; i < standing.size(); ++i) expect_block(scene, "way/" + std::to_string(i + 2));
  EXPECT_FALSE(box_of(scene, "way/1").empty()) << "as a building it is none";
  EXPECT_TRUE(scene.ledger.empty());
}

// The lower of two must not take the place of the higher.
TEST_F(LedgerTest, OfTwoThingsInOneObjectTheHigherIsBuilt) {
  const OccluderDefaults usual;
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "service"}, {"man_made", "chimney"}});
  map.box(50, 0, 70, 20, {{"building", "yes"}, {"height", "5"}, {"height:hub", "80"}, {"rotor:diameter", "60"}});
  map.box(100, 0, 120, 20, {{"building", "yes"}, {"height", "5"}, {"man_made", "silo"}});
  map.way({map.node(150, 0), map.node(170, 0)}, {{"barrier", "hedge"}, {"natural", "tree_row"}});
  const Scene scene = build(map);
  EXPECT_NEAR(box_of(scene, "way/1").max.z(), usual.towers.at("chimney").height_m, 1e-6);
  EXPECT_NEAR(box_of(scene, "way/2").max.z(), 110, 1e-6);
  EXPECT_NEAR(box_of(scene, "way/3").max.z(), 5, 1e-6) << "its height is known";
  EXPECT_NEAR(box_of(scene, "way/4").max.z(), usual.tree_m, 1e-6);
  MapText turbine;
  turbine.box(0, 0, 20, 20, {{"building", "yes"}, {"man_made", "tower"}, {"height:hub", "80"}});
  EXPECT_GT(box_of(build(turbine), "way/1").max.z(), 80) << "a tower is lower than its hub";
}

TEST_F(LedgerTest, AMultipolygonHasItsWallWhateverItBounds) {
  MapText map;
  const long outer = map.box(-30, -30, 30, 30, {}), inner = map.box(-9, -9, 9, 9, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}},
               {{"type", "multipolygon"}, {"landuse", "industrial"}, {"barrier", "wall"}, {"height", "4"}});
  map.relation({{"way", map.box(-60, -60, 60, 60, {}), "outer"}}, {{"type", "multipolygon"}, {"natural", "tree_row"}});
  write_bytes(folder_ / "city.osm", map.text());
  CityOptions options;
  options.occluders.others = false;  // the stand-in of the first
  const Scene scene = build_city(folder_ / "city.osm", options).scene;
  EXPECT_NEAR(box_of(scene, "relation/1").max.z(), 4, 1e-6);
  EXPECT_TRUE(covers(scene, "relation/1", 29.95, 10)) << "along its outer ring";
  EXPECT_TRUE(covers(scene, "relation/1", 9.05, 5)) << "along its inner ring";
  EXPECT_FALSE(covers(scene, "relation/1", 20, 0));
  EXPECT_NEAR(box_of(scene, "relation/2").max.z(), OccluderDefaults().tree_m, 1e-6);
}

// Its ring need not be whole for that.
TEST_F(LedgerTest, AWallOfARingThatIsNotWholeIsBuilt) {
  for (const bool is_open : {true, false}) {
    for (const auto& [key, value] : {std::pair("barrier", "wall"), std::pair("natural", "tree_row")}) {
      MapText map;
      const long a = map.node(-30, -30), b = map.node(30, -30), c = map.node(30, 30);
      const long ring = is_open ? map.way({a, b, c}, {}) : map.way({a, b, c, 99, a}, {});
      map.relation({{"way", ring, "outer"}}, {{"type", "multipolygon"}, {"leisure", "park"}, {key, value}});
      map.box(200, -5, 210, 5, {{"building", "yes"}});
      const Scene scene = build(map);
      const Box box = box_of(scene, "relation/1");
      ASSERT_FALSE(box.empty()) << value;
      EXPECT_GT(box.max.x() - box.min.x(), 59) << value;
      EXPECT_NE(entry_of(scene, "relation/1").reason, "");
    }
  }
}

TEST_F(LedgerTest, WhatMayBeAnywhereIsToldInEveryRegion) {
  MapText map;
  map.box(-5, -5, 5, 5, {{"building", "yes"}, {"height", "40"}});
  const long far = map.box(5000, 0, 5010, 10, {});
  map.way({9001, 9002, 9003}, {{"building", "yes"}, {"height", "30"}});
  const long nested = map.relation({{"way", far, "outer"}}, {{"type", "multipolygon"}});
  map.relation({{"relation", nested, "outer"}}, {{"type", "multipolygon"}, {"building", "yes"}, {"height", "30"}});
  map.relation({{"node", map.node(5000, 0), ""}}, {{"type", "site"}, {"building", "yes"}, {"height", "30"}});
  const long near = map.relation({{"way", map.box(20, 0, 80, 60, {}), "outer"}}, {{"type", "multipolygon"}});
  map.relation({{"relation", near, "outer"}}, {{"type", "multipolygon"}, {"building", "yes"}, {"height", "40"}});
  write_bytes(folder_ / "city.osm", map.text());
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};  // as MapText
  options.region.radius_m = 200;
  const Scene scene = build_city(folder_ / "city.osm", options).scene;
  EXPECT_EQ(entry_of(scene, "way/3").object.source_id, "way/3");
  EXPECT_EQ(entry_of(scene, "relation/3").object.source_id, "relation/3") << "of a node";
  EXPECT_TRUE(box_of(scene, "relation/2").empty()) << "far away";
  expect_block(scene, "relation/5");
  EXPECT_EQ(scene.ledger.size(), 2U);
}

TEST_F(LedgerTest, ABuildingRelationTellsOfAllThatIsWrong) {
  MapText map;
  const long a = map.node(-30, -30), b = map.node(30, -30), c = map.node(30, 30);
  const long open = map.way({a, b, c}, {});
  map.relation({{"way", open, "outline"}, {"way", 99, "part"}},
               {{"type", "building"}, {"building", "yes"}, {"height", "40"}});
  map.relation({{"way", 99, "part"}}, {{"type", "building"}});
  write_bytes(folder_ / "city.osm", map.text());
  const Scene scene = build_city(folder_ / "city.osm").scene;
  const std::string& reason = entry_of(scene, "relation/1").reason;
  testing::expect_wording(reason);
  EXPECT_FALSE(entry_of(scene, "relation/2").stand_in) << "nothing of it is known";
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

TEST_F(LedgerTest, HighThingsOfWhichNothingTellsTheHeightAreTold) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "9"}});
  map.node(100, 0, {{"power", "tower"}});
  map.node(120, 0, {{"man_made", "crane"}, {"height", "unknown"}});
  map.box(40, 0, 60, 30, {{"natural", "wood"}, {"name", "Grove"}});
  const long inner = map.box(45, 105, 50, 110, {});
  const long outer = map.box(40, 100, 60, 120, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}}, {{"type", "multipolygon"}, {"landuse", "forest"}});
  map.box(200, 0, 220, 20, {{"building", "yes"}, {"leisure", "stadium"}});
  map.node(140, 0, {{"man_made", "crane"}, {"status", "planned"}});
  map.node(160, 0, {{"tourism", "artwork"}});
  map.node(180, 0, {{"power", "pole"}});
  map.box(3000, 0, 3020, 20, {{"natural", "wood"}});
  const Scene scene = build(map);
  ASSERT_EQ(scene.ledger.size(), 4u);
  const LedgerEntry& wood = entry_of(scene, "way/2");
  EXPECT_FALSE(wood.stand_in);
  EXPECT_EQ(wood.without, "woods");
  ASSERT_TRUE(wood.box);
  EXPECT_NEAR(wood.box->max.y(), 30, 0.05);
  testing::expect_wording(ledger_text(wood));
  for (const char* const id : {"node/5", "node/6", "relation/1"}) EXPECT_TRUE(entry_of(scene, id).box) << id;
  EXPECT_EQ(entry_of(scene, "node/5").without, "masts");
  CityOptions options;
  for (const char* kind : {"woods", "masts", "cranes"}) leave_out(options.occluders, kind, "here");
  EXPECT_TRUE(build(map, options).ledger.empty());
}

TEST_F(LedgerTest, AWoodWithoutAHeightMovesNoFrame) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  const auto place = [&] {
    write_bytes(folder_ / "city.osm", map.text());
    return build_city(folder_ / "city.osm").scene.georeference.value();
  };
  const Georeference alone = place();
  map.box(500, 500, 900, 900, {{"natural", "wood"}});
  EXPECT_EQ(place().latitude_deg, alone.latitude_deg);
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
                                                {{"man_made", "flagpole"}, {"tourism", "attraction"}},
                                                {{"natural", "water"}, {"landuse", "reservoir"}},
                                                {{"man_made", "obelisk"}, {"layer", "-1"}},
                                                {{"historic", "monument"}, {"level", "-2"}},
                                                {{"demolished:man_made", "crane"}},
                                                {{"demolished:building", "yes"}, {"nycdoitt:bin", "1"}},
                                                {{"man_made", "crane"}, {"proposed", "yes"}}};
  for (MapText::TagList tags : things) {
    tags.emplace_back("height", "9");
    map.node(100, 100, tags);
  }
  const Scene scene = build(map);
  EXPECT_TRUE(scene.ledger.empty()) << scene.ledger.front().what;
}

TEST_F(LedgerTest, WhatSaysAnythingThatStandsIsABlocker) {
  const std::vector<MapText::TagList> things = {{{"waterway", "dam"}},
                                                {{"highway", "elevator"}},
                                                {{"amenity", "hospital"}, {"emergency", "yes"}},
                                                {{"historic", "city_gate"}, {"barrier", "gate"}},
                                                {{"man_made", "obelisk"}, {"tourism", "information"}},
                                                {{"man_made", "water_works"}, {"natural", "water"}},
                                                {{"amenity", "clock"}, {"support", "tower"}},
                                                {{"power", "tower"}, {"highway", "street_lamp"}},
                                                {{"landuse", "forest"}, {"layer", "-1"}},
                                                {{"historic", "monument"}, {"destroyed", "1945"}},
                                                {{"attraction", "drop_tower"}, {"removed:barrier", "fence"}},
                                                {{"aeroway", "tower"}, {"demolished:building", "yes"}},
                                                {{"shop", "mall"}, {"razed:building", "yes"}},
                                                {{"office", "company"}, {"demolished:building", "yes"}},
                                                {{"telecom", "data_center"}, {"razed:building", "yes"}},
                                                {{"name", "Old Mill"}, {"disused:waterway", "watermill"}},
                                                {{"tourism", "artwork"}, {"indoor", "false"}}};
  MapText map;
  for (std::size_t i = 0; i < things.size(); ++i) {
    MapText::TagList tags = things[i];
    tags.emplace_back("height", "25");
    const double east = 50.0 * static_cast<double>(i);
    map.area({{east, 0}, {east + 20, 0}, {east + 20, 20}, {east, 20}}, tags);
  }
  const Scene scene = build(map);
  EXPECT_EQ(scene.ledger.size(), things.size()) << "each once";
  for (std::size_t i = 0; i < things.size(); ++i) {
    EXPECT_NEAR(box_of(scene, "way/" + std::to_string(i + 1)).max.z(), 25, 1e-6) << things[i][0].second;
  }
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
  const MapText::TagList tower = {{"power", "tower"}, {"height", "45"}};
  const long a = map.node(50, -50, tower), b = map.node(50, 50, {{"power", "tower"}, {"height", "~40 m"}});
  map.way({a, b}, {{"power", "line"}});
  map.line({{-50, -50}, {-50, 50}}, {{"power", "minor_line"}, {"location", "underground"}});
  const Scene scene = build(map);
  ASSERT_EQ(scene.overhead.size(), 1U);
  EXPECT_EQ(scene.overhead[0].object.source_id, "way/2");
  testing::expect_wording(scene.overhead[0].object.name);
  const Box box = bounding_box(scene.overhead[0].mesh);
  EXPECT_NEAR(box.max.z(), 45, 1e-6);
  EXPECT_NEAR(box.min.x(), box.max.x(), 0.02);
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), scene.mesh.triangles.size()) << "two more, without the ground's two";
  CityOptions options;
  options.occluders.lines = false;
  EXPECT_TRUE(build(map, options).overhead.empty());
  map.way({a, map.node(150, 50, {{"power", "tower"}})}, {{"power", "line"}, {"name", "east"}});
  const Scene more = build(map);
  ASSERT_EQ(more.overhead.size(), 2U);
  EXPECT_EQ(more.overhead[1].object.name, "east");
  EXPECT_NEAR(bounding_box(more.overhead[1].mesh).max.z(), 60, 1e-6) << "one of its supports does not say its height";
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

TEST_F(LedgerTest, StandInsAreAsLargeAsTheTagsSay) {
  MapText map;
  map.node(0, 0, {{"generator:source", "wind"}, {"height:hub", "160"}, {"rotor:diameter", "236"}});
  map.node(500, 0, {{"generator:source", "wind"}, {"height:hub", "100"}});
  map.node(1000, 0, {{"man_made", "crane"}, {"height", "1600"}});
  map.line({{1200, 0}, {1220, 0}, {1220, 20}, {1200, 20}}, {{"man_made", "storage_tank"}});
  map.area({{1300, 0}, {1320, 0}, {1320, 20}, {1300, 20}}, {{"aerialway", "station"}, {"height", "15"}});
  const Scene scene = build(map);
  const Box turbine = box_of(scene, "node/1"), other = box_of(scene, "node/2"), crane = box_of(scene, "node/3");
  EXPECT_NEAR(turbine.max.z(), 278, 1e-6);
  EXPECT_GE(turbine.max.x() - turbine.min.x(), 236);
  EXPECT_NEAR(other.max.z(), 100 / 0.6, 1e-6) << "a rotor that is not said";
  EXPECT_NEAR(crane.max.z(), 1500, 1e-6);
  EXPECT_TRUE(entry_of(scene, "node/3").may_be_larger);
  EXPECT_TRUE(covers(scene, "way/1", 1210, 11)) << "a tank whose outline is open";
  EXPECT_TRUE(covers(scene, "way/2", 1310, 11)) << "closed, and no wall";
}

TEST_F(LedgerTest, ClosedLinesAreNotFilledAndAreasAreBuiltOnce) {
  const std::vector<MapText::TagList> lines = {{{"barrier", "jersey_barrier"}},
                                               {{"man_made", "dyke"}},
                                               {{"man_made", "pipeline"}},
                                               {{"roller_coaster", "track"}}};
  MapText map;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    MapText::TagList tags = lines[i];
    tags.emplace_back("height", "5");
    const double east = 50.0 * static_cast<double>(i);
    map.box(east, 0, east + 20, 20, tags);
  }
  const long bridge = map.box(0, 100, 20, 120, {{"man_made", "bridge"}, {"highway", "footway"}});
  const long wood = map.box(50, 100, 70, 120, {{"landuse", "forest"}, {"barrier", "guard_rail"}, {"height", "12"}});
  map.line({{100, 100}, {115, 100}, {130, 100}}, {{"man_made", "aqueduct"}, {"height", "50"}, {"width", "6"}});
  const Scene scene = build(map);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string id = "way/" + std::to_string(i + 1);
    EXPECT_FALSE(covers(scene, id, 50.0 * static_cast<double>(i) + 10, 11)) << lines[i].back().second;
    EXPECT_NEAR(box_of(scene, id).max.z(), 5, 1e-6) << lines[i].back().second;
  }
  for (const long id : {bridge, wood}) {
    EXPECT_EQ(std::count_if(scene.objects.begin(), scene.objects.end(),
                            [&](const auto& one) { return one.source_id == "way/" + std::to_string(id); }),
              1);
  }
  const Box aqueduct = box_of(scene, "way/7");
  EXPECT_NEAR(aqueduct.max.y() - aqueduct.min.y(), 6, 0.05);
}

TEST_F(LedgerTest, ReasonsAreRightAndComeOnce) {
  MapText map;
  map.line({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {{"man_made", "storage_tank"}});
  map.box(100, 0, 100.0074, 20, {{"building", "yes"}, {"height", "9"}});
  map.node(200, 0, {{"generator:source", "wind"}, {"height:hub", "80"}, {"rotor:diameter", "500"}});
  map.box(300, 0, 320, 20, {{"building", "yes"}, {"height", "9"}});
  CityOptions warn;
  warn.missing = MissingPolicy::warn;
  for (const CityOptions& options : {CityOptions(), warn}) {
    const Scene scene = build(map, options);
    testing::expect_wording({entry_of(scene, "way/1").reason, entry_of(scene, "way/2").reason});
    EXPECT_EQ(entry_of(scene, "way/1").without, "towers");
    EXPECT_EQ(entry_of(scene, "way/2").without, "") << "no kind of occluder has buildings";
    EXPECT_EQ(entry_of(scene, "node/9").reason.rfind("rotor:diameter"), 0u);
  }
}

TEST_F(LedgerTest, WhatWasThereOrIsPlannedDoesNotTakeAwayWhatStands) {
  MapText map;
  map.node(0, 0, {{"power", "tower"}, {"height", "60"}, {"planned:voltage", "380000"}});
  map.node(20, 0, {{"man_made", "crane"}, {"height", "80"}, {"demolished:building", "yes"}});
  map.area({{40, 0}, {60, 0}, {60, 20}, {40, 20}},
           {{"landuse", "forest"}, {"boundary", "protected_area"}, {"height", "25"}});
  map.node(80, 0, {{"demolished:man_made", "crane"}, {"height", "80"}});
  map.node(90, 0, {{"man_made", "crane"}, {"height", "80"}, {"status", "planned"}});
  const Scene scene = build(map);
  EXPECT_FALSE(box_of(scene, "node/1").empty());
  EXPECT_FALSE(box_of(scene, "node/2").empty());
  EXPECT_FALSE(box_of(scene, "way/1").empty());
  EXPECT_EQ(scene.ledger.size(), 3U);
}

TEST_F(LedgerTest, RoofsThatHaveNoModelAreHeldByABox) {
  MapText map;
  map.box(0, 0, 20, 10, {{"building", "yes"}, {"height", "12"}, {"roof:height", "4"}, {"roof:shape", "cross_gabled"}});
  map.box(40, 0, 60, 10, {{"building", "yes"}, {"building:levels", "3"}, {"roof:shape", "sawtooth"}});
  map.box(80, 0, 100, 10,
          {{"building", "yes"}, {"building:levels", "3"}, {"roof:shape", "gabled"}, {"roof:height", "~5"}});
  const Scene scene = build(map);
  const auto volume_of = [&](const std::string& id) {
    Mesh mesh{scene.mesh.vertices, {}};
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
      if (scene.objects[scene.object_of[i]].source_id == id) mesh.triangles.push_back(scene.mesh.triangles[i]);
    }
    return enclosed_volume(mesh);
  };
  EXPECT_NEAR(volume_of("way/1"), 20 * 10 * 12, 5);
  const double top_m = box_of(scene, "way/2").max.z();
  EXPECT_GT(top_m, 10) << "three storeys, and a roof of the usual pitch";
  EXPECT_NEAR(volume_of("way/2"), 20 * 10 * top_m, 5);
  EXPECT_NEAR(box_of(scene, "way/3").max.z(), 14, 1e-6);
  for (const char* id : {"way/1", "way/2", "way/3"}) testing::expect_wording(entry_of(scene, id).instead);
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

TEST_F(LedgerTest, WhatClearanceIsKeptFromLiesWithinReach) {
  MapText map = block_with_courtyard(-10, 10);
  map.node(46, 150, {{"power", "tower"}, {"height", "45"}});
  EXPECT_EQ(count(mission_warnings(mission(map, town_mission(""))), WarningCode::scene_incomplete), 0u);
  const Mission kept = mission(map, town_mission("") + "navigation: {clearance: 100}\n");
  EXPECT_EQ(count(mission_warnings(kept), WarningCode::scene_incomplete), 1u);
}

TEST_F(LedgerTest, WhatMayBeLargerCountsFromFartherAway) {
  const auto warned = [&](double east, const MapText::TagList& tags) {
    MapText map = block_with_courtyard(-10, 10);
    map.node(east, 0, tags);
    return mission_warnings(mission(map, town_mission("")));
  };
  const MapText::TagList building = {{"building", "yes"}, {"height", "9"}}, crane = {{"man_made", "crane"}};
  // The range of 60 m is from the target's corner at 46 m east; columns of buildings have a radius of 10 m.
  const std::vector<Warning> near = warned(130, building);
  ASSERT_EQ(count(near, WarningCode::scene_incomplete), 1u);
  for (const Warning& warning : near) {
    if (warning.code == WarningCode::scene_incomplete) testing::expect_wording(warning.text);
  }
  EXPECT_EQ(count(warned(140, building), WarningCode::scene_incomplete), 0u);
  EXPECT_EQ(count(warned(125, crane), WarningCode::scene_incomplete), 1u) << "nothing tells its height";
}

TEST_F(LedgerTest, TheCheckByRaysTellsWhatTheSceneLacks) {
  const Mission near = mission(block_with_courtyard(10, 30.05), town_mission(""));
  const Mesh box = testing::make_box_mesh({42, -1, 5}, {44, 1, 7});
  EXPECT_FALSE(verify_volume(near, box, {.points = 100}).scene_incomplete.empty());
  const Mission sound = mission(block_with_courtyard(-10, 10), town_mission(""));
  EXPECT_TRUE(verify_volume(sound, box, {.points = 100}).scene_incomplete.empty());
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
  const PreparedScene scene(wooded.scene());
  const Error error = testing::expect_code([&] { prepare_target(wooded, scene); }, ErrorCode::target_inside_solid);
  testing::expect_wording(error.what());
  const Mission bare = mission(map, town_mission(", without: [woods]"));
  EXPECT_NO_THROW(prepare_target(bare, PreparedScene(bare.scene())));
}

TEST(LedgerText, IsShortAndNamesWhatHasNoName) {
  testing::expect_wording(ledger_text({}));
  const std::string umlauts = [] {
    std::string text = "x";
    for (int i = 0; i < 1000; ++i) text += "\xC3\xA4";
    return text;
  }();
  const std::string text = ledger_text({{umlauts}, umlauts, umlauts});
  EXPECT_LT(text.size(), 700u);
  EXPECT_NO_THROW(nlohmann::json(text).dump()) << "no character is cut";
}

// ---- a flight with many legs

Box drawn_box(testing::Random& random, double wide) {
  Box box;
  box.extend(random.point(-100, 100));
  box.extend(box.min + random.point(0, wide));
  return box;
}

TEST(LedgerNear, AgreesWithAllBoxesOneAfterAnother) {
  testing::Random random(12);
  Scene scene;
  for (int i = 0; i < 300; ++i) scene.ledger.push_back({{"thing"}, "", "", drawn_box(random, 20)});
  for (const std::size_t boxes : {0U, 1U, 16U, 17U, 700U}) {
    SCOPED_TRACE(boxes);
    app::Reach reach{{}, 25};
    Vec3 at = Vec3::Zero();
    for (std::size_t i = 0; i < boxes; ++i) {
      const Vec3 from = std::exchange(at, at + random.point(-10, 10));
      reach.boxes.push_back({from.cwiseMin(at), from.cwiseMax(at)});
    }
    const auto is_near = [&](const LedgerEntry& entry) {
      return std::any_of(reach.boxes.begin(), reach.boxes.end(), [&](const Box& box) {
        const Vec3 apart = (entry.box->min - box.max).cwiseMax(box.min - entry.box->max);
        return apart.cwiseMax(0.0).norm() <= reach.within_m + app::kUnsureM;  // nothing holds them
      });
    };
    const auto near = std::count_if(scene.ledger.begin(), scene.ledger.end(), is_near);
    const auto warning = app::incomplete_warning(scene, {reach}, reach.boxes, "the flight");
    ASSERT_EQ(warning.has_value(), near > 0);
    EXPECT_EQ(warning ? std::stol(warning->text) : 0, near);
    EXPECT_TRUE(boxes < 700 || near > 0);
  }
}

TEST(LedgerNear, AGuessReachesFartherThanWhatIsHeld) {
  Scene scene;
  scene.ledger.reserve(3);
  LedgerEntry& entry = scene.ledger.emplace_back();
  entry.box = Box{{10, 0, 0}, {20, 10, 9}};
  const Box path{{-5, 0, 5}, {-5, 10, 5}};
  const auto warning = [&] { return app::incomplete_warning(scene, {{{path}, 2}}, {path}, "the flight"); };
  EXPECT_TRUE(warning()) << "nothing holds it";
  entry.stand_in = 0;
  EXPECT_FALSE(warning());
  entry.may_be_larger = true;
  ASSERT_TRUE(warning());
  scene.ledger.push_back(entry);
  scene.ledger.push_back({{"mast"}, "power=tower", "nothing tells how high it is", entry.box});
  testing::expect_wording(warning()->text);
}

TEST(LedgerNear, AsksForEachEntryWhetherToGoOn) {
  const core::ProgressReporter::AskAlways always;
  Scene scene;
  scene.ledger.assign(50, {{"thing"}, "", "", Box{Vec3::Zero(), Vec3::Ones()}});
  std::size_t asked = 0;
  const Progress stop = [&](std::string_view, double) { return ++asked < 20; };
  testing::expect_code([&] { app::incomplete_warning(scene, {}, {}, "the flight", core::ProgressReporter(stop)); },
                       ErrorCode::cancelled);
  EXPECT_EQ(asked, 20U);
}

}  // namespace
}  // namespace vantage
