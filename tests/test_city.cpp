// From a map to a scene: which objects are built, where, how high, and what the report says of the rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/solid_check.h"
#include "geo/local_frame.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/osm_maps.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

// A map holds positions to 1e-7 degrees: 11 mm.
class CityTest : public ::testing::Test {
 protected:
  City build(const MapText& map, const CityOptions& options = {}) {
    write_bytes(folder_ / "city.osm", map.text());
    return build_city(folder_ / "city.osm", options);
  }

  /// A raster of a plane that rises to the north, 500 m high at the origin of maps; posts 0.0005 degrees apart.
  std::filesystem::path slope(double rise) {
    std::string grid =
        "ncols 41\nnrows 41\nxllcenter 11.5655\nyllcenter 48.1274\ncellsize 0.0005\nNODATA_value -9999\n";
    for (int row = 0; row < 41; ++row) {
      const double north = (20 - row) * 0.0005 * 111200;
      for (int column = 0; column < 41; ++column) grid += std::to_string(500 + north * rise) + " ";
      grid += "\n";
    }
    write_bytes(folder_ / "dem.asc", grid);
    write_bytes(
        folder_ / "dem.prj",
        "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
        "UNIT[\"degree\",0.0174532925199433]]");
    return folder_ / "dem.asc";
  }

  void expect_refused(const MapText& map, const CityOptions& options, ErrorCode code) {
    testing::expect_error([&] { build(map, options); }, code);
  }

  TemporaryDirectory folder_;
};

const CityRecord& record_of(const City& city, const std::string& object) {
  const auto& records = city.report.records;
  const auto found =
      std::find_if(records.begin(), records.end(), [&](const CityRecord& r) { return r.object.source_id == object; });
  if (found == records.end()) throw std::runtime_error("no record of " + object);
  return *found;
}

/// Why an object is not built as the map has it; empty where it is.
std::string reason_of(const City& city, const std::string& object) {
  for (const CityPassedOver& one : city.report.passed_over) {
    if (one.object.source_id == object) return one.reason;
  }
  for (const LedgerEntry& entry : city.scene.ledger) {
    if (entry.object.source_id == object) return entry.reason;
  }
  return "";
}

/// The triangles of the object whose name begins so.
Mesh object_mesh(const Scene& scene, const std::string& name) {
  Mesh mesh;
  mesh.vertices = scene.mesh.vertices;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (display_name(scene.objects[scene.object_of[i]]).starts_with(name))
      mesh.triangles.push_back(scene.mesh.triangles[i]);
  }
  return mesh;
}

double object_volume(const Scene& scene, const std::string& name) {
  const Mesh mesh = object_mesh(scene, name);
  return mesh.empty() ? 0 : enclosed_volume(core::checked_solid(mesh, name));
}

TEST_F(CityTest, BuildsABlockWhereItStands) {
  MapText map;
  map.box(10, 20, 30, 50, {{"building", "yes"}, {"height", "12"}, {"name", "Block"}});
  map.box(-20, -30, -10, -20, {{"building", "yes"}, {"height", "5"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 200;
  const City city = build(map, options);
  ASSERT_EQ(city.scene.objects.size(), 3U);
  EXPECT_EQ(city.scene.objects[0], (SceneObject{"Block", "way/1", ObjectKind::building}));
  EXPECT_EQ(city.scene.objects[1], (SceneObject{"", "way/2", ObjectKind::building}));
  EXPECT_EQ(city.scene.objects[2], (SceneObject{"ground", "", ObjectKind::ground}));
  const Box bounds = bounding_box(object_mesh(city.scene, "way/1"));
  EXPECT_NEAR((bounds.min - Vec3(10, 20, 0)).norm(), 0, 0.012);
  EXPECT_NEAR((bounds.max - Vec3(30, 50, 12)).norm(), 0, 0.012);
  EXPECT_NEAR(object_volume(city.scene, "way/1"), 20 * 30 * 12, 1);
  EXPECT_EQ(reason_of(city, "way/1"), "");
  ASSERT_TRUE(city.scene.georeference);
  EXPECT_EQ(city.scene.georeference->latitude_deg, 48.1374);
  EXPECT_EQ(city.scene.georeference->longitude_deg, 11.5755);
  EXPECT_EQ(city.scene.georeference->vertical, "flat ground");
}

TEST_F(CityTest, PartsReplaceTheOutlineTheyLieIn) {
  MapText map;
  map.box(0, 0, 40, 40, {{"building", "yes"}, {"height", "100"}});
  map.box(0, 0, 40, 40, {{"building:part", "yes"}, {"height", "20"}});
  map.box(10, 10, 30, 30, {{"building:part", "yes"}, {"height", "100"}, {"min_height", "20"}});
  const City city = build(map);
  EXPECT_EQ(object_volume(city.scene, "way/1"), 0) << "the outline is not built";
  EXPECT_NEAR(object_volume(city.scene, "way/2"), 40 * 40 * 20, 30);
  EXPECT_NEAR(object_volume(city.scene, "way/3"), 20 * 20 * 80, 40);
  EXPECT_NEAR(record_of(city, "way/3").base_m, 20, 1e-9);
  testing::expect_wording(reason_of(city, "way/1"));
  EXPECT_TRUE(city.scene.ledger.empty());
}

TEST_F(CityTest, WhatPartsLeaveOpenIsBuilt) {
  MapText map;
  map.box(0, 0, 40, 40, {{"building", "yes"}, {"height", "10"}});
  map.box(0, 0, 20, 40, {{"building:part", "yes"}, {"height", "30"}});
  const City city = build(map);
  EXPECT_NEAR(object_volume(city.scene, "way/1"), 20 * 40 * 10, 5) << "the open half";
  EXPECT_EQ(record_of(city, "way/1").remarks.size(), 1U);
  EXPECT_NEAR(record_of(city, "way/1").footprint_m2, 20 * 40, 1);
}

TEST_F(CityTest, WhatStandsOnARoofLeavesNoShaftBelow) {
  MapText map;
  map.box(0, 0, 40, 40, {{"building", "yes"}, {"height", "50"}});
  map.box(10, 10, 20, 20, {{"building:part", "yes"}, {"height", "55"}, {"min_height", "50"}});
  const City city = build(map);
  EXPECT_NEAR(object_volume(city.scene, "way/1"), 40 * 40 * 50, 20);
  EXPECT_NEAR(object_volume(city.scene, "way/2"), 10 * 10 * 5, 1);
}

TEST_F(CityTest, WhatIsNoWallTakesNoBuildingAway) {
  const std::vector<MapText::TagList> parts = {{{"building:part", "yes"}},
                                               {{"building:part", "yes"}, {"height", "tall"}},
                                               {{"building:part", "yes"}, {"layer", "-1"}, {"height", "3"}},
                                               {{"building:part", "yes"}, {"building:levels", "0"}, {"layer", "-2"}},
                                               {{"building:part", "roof"}, {"height", "102"}},
                                               {{"building:part", "yes"}, {"wall", "no"}, {"height", "102"}}};
  for (const MapText::TagList& tags : parts) {
    MapText map;
    map.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "100"}});
    map.box(0, 0, 12, 20, tags);
    const City city = build(map);
    EXPECT_NEAR(object_volume(city.scene, "way/1"), 20 * 20 * 100, 80) << tags.back().second;
    EXPECT_GT(object_volume(city.scene, "way/2"), 0) << tags.back().second;
  }
  MapText low;
  low.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "100"}});
  low.box(0, 0, 20, 20, {{"building:part", "yes"}, {"building:levels", "2"}});
  EXPECT_EQ(object_volume(build(low).scene, "way/1"), 0) << "a part that says its levels";
}

TEST_F(CityTest, ManySmallPiecesThatPartsLeaveOpenAreBuilt) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "100"}});
  for (int i = 0; i < 20; ++i) map.box(i, 0, i + 0.955, 20, {{"building:part", "yes"}, {"height", "3"}});
  EXPECT_NEAR(record_of(build(map), "way/1").footprint_m2, 18, 2);
}

TEST_F(CityTest, HeightsOfPiecesAndRelationsCount) {
  for (const bool tagged : {false, true}) {
    MapText map;
    const long a = map.node(0, 0), b = map.node(20, 0), c = map.node(20, 20), d = map.node(0, 20);
    const long south = map.way({a, b, c}, {{"building", "yes"}, {"height", "100"}});
    const long north = map.way({c, d, a}, {{"building", "yes"}, {"height", "90"}});
    MapText::TagList tags = {{"type", "multipolygon"}};
    if (tagged) tags.insert(tags.end(), {{"building", "yes"}, {"height", "50"}});
    map.relation({{"way", south, "outer"}, {"way", north, "outer"}}, tags);
    EXPECT_NEAR(object_volume(build(map).scene, "relation/1"), 20 * 20 * 100, 80) << tagged;
  }
  struct Case {
    MapText::TagList own, other;
    double top_m;
  };
  const auto expect_top = [&](const MapText& map, const std::string& object, const Case& one) {
    EXPECT_NEAR(record_of(build(map), object).top_m, one.top_m, 1e-6)
        << (one.own.empty() ? "" : one.own[0].first) << " and " << one.other.back().first;
  };
  const std::vector<Case> both = {{{}, {{"height", "100"}}, 100},
                                  {{}, {{"height", "6"}}, 6},
                                  {{{"height", "10"}}, {{"building:levels", "20"}}, 60},
                                  {{{"building:levels", "20"}}, {{"height", "4"}}, 60},
                                  {{{"est_height", "60"}}, {{"height", "12"}}, 60},
                                  {{{"height", "10"}}, {{"building:levels", "5"}, {"roof:levels", "4"}}, 25},
                                  {{{"building:levels", "5"}}, {{"roof:levels", "4"}}, 25},
                                  {{{"height", "10"}}, {{"building:height", "9 storeys"}}, 27}};
  const std::vector<Case> others = {{{{"building:levels", "20"}}, {{"barrier", "fence"}, {"height", "2"}}, 60},
                                    {{}, {{"barrier", "fence"}, {"height", "2"}}, 9},
                                    {{{"est_height", "60"}}, {{"leisure", "park"}, {"height", "12"}}, 60},
                                    {{{"est_height", "6"}}, {{"leisure", "park"}, {"height", "12"}}, 12}};
  for (const bool is_piece : {false, true}) {
    std::vector<Case> cases = both;
    if (is_piece) cases.insert(cases.end(), others.begin(), others.end());
    for (Case& one : cases) {
      MapText map;
      one.own.emplace_back("building", "yes");
      one.own.emplace_back("type", "multipolygon");
      const long a = map.node(0, 0), b = map.node(20, 0), c = map.node(20, 20), d = map.node(0, 20);
      const long south = map.way({a, b, c}, is_piece ? one.other : MapText::TagList()), north = map.way({c, d, a}, {});
      const long outline = map.relation({{"way", south, "outer"}, {"way", north, "outer"}}, one.own);
      one.other.emplace_back("type", "building");
      if (!is_piece) map.relation({{"relation", outline, "outline"}}, one.other);
      expect_top(map, "relation/1", one);
    }
  }
  MapText tank;
  const long a = tank.node(0, 0), b = tank.node(20, 0), c = tank.node(20, 20);
  const long piece = tank.way({a, b, c}, {{"height", "30"}}), rest = tank.way({c, a}, {});
  tank.relation({{"way", piece, "outer"}, {"way", rest, "outer"}},
                {{"type", "multipolygon"}, {"man_made", "storage_tank"}, {"est_height", "12"}});
  EXPECT_NEAR(record_of(build(tank), "relation/1").top_m, 30, 1e-6);
}

TEST_F(CityTest, BuildingRelationsBuildWhatNoMemberIs) {
  const MapText::TagList building = {{"type", "building"}, {"building", "yes"}, {"height", "50"}};
  const MapText::TagList low = {{"building", "yes"}, {"height", "20"}}, part = {{"building:part", "yes"}};
  const auto built = [&](const MapText::TagList& first, const MapText::TagList& second, const std::string& role) {
    MapText map;
    const long west = map.box(0, 0, 20, 20, first), east = map.box(40, 0, 60, 20, second);
    map.relation({{"way", west, role}, {"way", east, role}}, building);
    return build(map);
  };
  const City outlines = built(low, {}, "outline");
  EXPECT_NEAR(record_of(outlines, "way/1").top_m, 50, 1e-6);
  EXPECT_NEAR(object_volume(outlines.scene, "relation/1"), 20 * 20 * 50, 40) << "the outline without tags";
  const City fence = built({{"barrier", "fence"}}, {{"barrier", "fence"}}, "outline");
  EXPECT_NEAR(object_volume(fence.scene, "relation/1"), 2 * 20 * 20 * 50, 80);
  EXPECT_NEAR(record_of(fence, "way/1").top_m, 1.5, 1e-6);
  const City parts = built(part, {{"building:part", "yes"}, {"height", "8"}}, "part");
  EXPECT_NEAR(record_of(parts, "way/1").top_m, 50, 1e-6) << "it says no height";
  EXPECT_NEAR(record_of(parts, "way/2").top_m, 8, 1e-6);
  const City mixed = built(part, {}, "part");
  EXPECT_NEAR(record_of(mixed, "way/1").top_m, 50, 1e-6);
  EXPECT_NEAR(object_volume(mixed.scene, "relation/1"), 20 * 20 * 50, 40) << "the part without tags";
  MapText tower;
  const long outline = tower.box(0, 0, 20, 20, low);
  tower.relation({{"way", outline, "outline"}}, {{"type", "building"}, {"man_made", "tower"}, {"height", "50"}});
  const City told = build(tower);
  EXPECT_NEAR(record_of(told, "way/1").top_m, 50, 1e-6);
  EXPECT_NE(reason_of(told, "relation/1"), "");
}

TEST_F(CityTest, APartLowersNoBuildingButItsOwn) {
  for (const bool named : {false, true}) {
    MapText map;
    map.box(-30, -30, 30, 30, {{"building", "yes"}, {"height", "100"}});
    const long own = map.box(-20, -20, 10, 10, {{"building", "yes"}, {"height", "50"}});
    const long part = map.box(-15, -15, 5, -5, {{"building:part", "yes"}, {"height", "10"}});
    if (named) map.relation({{"way", own, "outline"}, {"way", part, "part"}}, {{"type", "building"}});
    const City city = build(map);
    EXPECT_NEAR(object_volume(city.scene, "way/1"), 60 * 60 * 100, 500) << named;
    EXPECT_NEAR(record_of(city, "way/2").footprint_m2, 30 * 30 - 20 * 10, 2) << named;
  }
  MapText two;  // the part lies in the first of two outlines
  const long west = two.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "100"}});
  const long east = two.box(40, 0, 60, 20, {{"building", "yes"}, {"height", "100"}});
  const long part = two.box(0, 0, 20, 10, {{"building:part", "yes"}, {"height", "10"}});
  two.relation({{"way", west, "outline"}, {"way", east, "outline"}, {"way", part, "part"}}, {{"type", "building"}});
  EXPECT_NEAR(record_of(build(two), "way/1").footprint_m2, 20 * 10, 1);
}

TEST_F(CityTest, SmallBuildingsAreBuilt) {
  MapText map;
  map.box(0, 0, 0.9, 0.9, {{"building", "yes"}, {"height", "30"}});
  map.box(0, 0, 0.9, 0.9, {{"building:part", "yes"}, {"layer", "-1"}, {"height", "2"}});
  map.box(10, 0, 10.9, 0.9, {{"building", "yes"}, {"height", "30"}});
  map.box(10, 0, 10.4, 0.9, {{"building:part", "yes"}, {"height", "2"}});
  const City city = build(map);
  EXPECT_NEAR(record_of(city, "way/1").footprint_m2, 0.81, 0.05);
  EXPECT_NEAR(record_of(city, "way/3").footprint_m2, 0.45, 0.05);
}

TEST_F(CityTest, APieceOfARingMaySayWhatItBounds) {
  for (const bool named : {false, true}) {
    MapText map;
    const long a = map.node(0, 0), b = map.node(20, 0), c = map.node(20, 20), d = map.node(0, 20);
    const MapText::TagList tags = {{"building", "yes"}, {"height", "20"}};
    const long south = map.way({a, b, c}, tags), north = map.way({c, d, a}, named ? tags : MapText::TagList());
    MapText::TagList own = {{"type", "multipolygon"}};
    if (named) own.emplace_back("amenity", "school");
    map.relation({{"way", south, "outer"}, {"way", north, "outer"}}, own);
    const City city = build(map);
    EXPECT_NEAR(record_of(city, "relation/1").footprint_m2, 20 * 20, 1) << named;
    EXPECT_TRUE(city.scene.ledger.empty()) << named;
  }
}

TEST_F(CityTest, ARelationJoinsPartsThatLieOutside) {
  MapText map;
  const long outline = map.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "10"}});
  const long inside = map.box(0, 0, 20, 20, {{"building:part", "yes"}, {"height", "10"}});
  const long annex = map.box(20, 0, 40, 20, {{"building:part", "yes"}, {"height", "6"}});
  map.relation({{"way", outline, "outline"}, {"way", inside, "part"}, {"way", annex, "part"}}, {{"type", "building"}});
  const City city = build(map);
  EXPECT_THROW(record_of(city, "way/1"), std::runtime_error) << "the outline is not built";
  EXPECT_NEAR(object_volume(city.scene, "way/3"), 20 * 20 * 6, 2);
}

TEST_F(CityTest, PartsReplaceEveryOutlineTheyLieIn) {
  MapText map;
  map.box(0, 0, 100, 40, {{"building", "retail"}, {"height", "10"}});
  map.box(0, 0, 40, 40, {{"building", "yes"}, {"height", "172"}});
  map.box(0, 0, 40, 40, {{"building:part", "yes"}, {"height", "50"}});
  map.box(0, 0, 100, 40, {{"building:part", "yes"}, {"location", "underground"}});
  const City city = build(map);
  testing::expect_wording(reason_of(city, "way/2"));
  EXPECT_NEAR(record_of(city, "way/1").footprint_m2, 60 * 40, 3) << "what is underground covers nothing";
  EXPECT_NEAR(object_volume(city.scene, "way/3"), 40 * 40 * 50, 30);
}

TEST_F(CityTest, TellsOfPointsAndGroups) {
  MapText map;
  const long outline = map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.node(30, 30, {{"building", "yes"}});
  map.relation({{"way", outline, "outline"}}, {{"type", "building"}, {"building", "yes"}});
  const City city = build(map);
  EXPECT_EQ(city.report.records.size(), 2U);
  EXPECT_EQ(record_of(city, "node/5").object.kind, ObjectKind::stand_in);
  testing::expect_wording(reason_of(city, "relation/1"));
}

TEST_F(CityTest, APartOfNoBuildingStandsAlone) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building:part", "yes"}, {"height", "10"}});
  const City city = build(map);
  EXPECT_EQ(record_of(city, "way/1").object.kind, ObjectKind::building_part);
  EXPECT_NEAR(object_volume(city.scene, "way/1"), 4000, 1);
}

TEST_F(CityTest, CourtyardsStayOpen) {
  MapText map;
  const long outer = map.box(0, 0, 40, 40, {});
  const long inner = map.box(10, 10, 30, 30, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}},
               {{"type", "multipolygon"}, {"building", "yes"}, {"height", "15"}});
  const City city = build(map);
  EXPECT_NEAR(object_volume(city.scene, "relation/1"), (1600 - 400) * 15, 5);
}

TEST_F(CityTest, MendsAnOutlineThatCrossesItself) {
  MapText map;
  map.area({{0, 0}, {20, 20}, {20, 0}, {0, 20}}, {{"building", "yes"}, {"height", "10"}});
  const City city = build(map);
  EXPECT_NE(reason_of(city, "way/1"), "");
  EXPECT_NEAR(object_volume(city.scene, "way/1"), 400 * 10, 10) << "two corners may have been swapped";
}

/// Positions in 1e-7 degrees, two of each; ways of their numbers from 1 on.
std::string exact_map(const std::vector<std::array<int, 2>>& positions, const std::vector<std::vector<long>>& ways,
                      const std::function<std::string(long way)>& tags) {
  std::string nodes, all;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    nodes += testing::osm_node(static_cast<long>(i) + 1, positions[i][0] * 1e-7, positions[i][1] * 1e-7);
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const long way = static_cast<long>(i) + 1;
    all += testing::osm_way(way, ways[i], tags(way));
  }
  return nodes + all;
}

CityOptions round_place(double latitude, double longitude, double radius_m) {
  CityOptions options;
  options.region.center_deg = {latitude, longitude};
  options.region.radius_m = radius_m;
  return options;
}

// Rounding to the grid moves a corner that lies on a side of another piece to and fro across it.
TEST_F(CityTest, PiecesThatGoOnCrossingByLessThanAUnitAreBuilt) {
  const std::string ways =
      exact_map({{669000, 930000},
                 {689000, 925000},
                 {674000, 925000},
                 {689000, 920000},
                 {694000, 920000},
                 {699000, 920000},
                 {699000, 925000},
                 {699000, 930000},
                 {699000, 935000},
                 {694000, 935000},
                 {689000, 935000},
                 {689000, 930000}},
                {{1, 2, 3, 1}, {4, 5, 6, 7, 8, 9, 10, 11, 12, 2, 4}}, [](long) { return std::string(); });
  write_bytes(folder_ / "city.osm",
              testing::osm_xml(ways + testing::osm_relation(1, {"way 1 outer", "way 2 outer"},
                                                            testing::osm_tag("type", "multipolygon") +
                                                                testing::osm_tag("building", "yes"))));
  const City city = build_city(folder_ / "city.osm", round_place(0.12965, 0.12965, 20000));
  EXPECT_NEAR(record_of(city, "relation/1").footprint_m2, (0.5 * 15 * 5 + 10 * 15) * 123.09, 200);
}

// Its parts cut two holes into it that touch each other and its side.
TEST_F(CityTest, TheHullOfWhatCannotBeDrawnApartStandsIn) {
  const std::string ways = exact_map(
      {{575600, 550400},
       {575167, 549985},
       {575582, 549552},
       {576015, 549967},
       {575311, 550123},
       {575239, 550054},
       {575308, 549982},
       {575380, 550051},
       {575383, 550193},
       {575519, 549907},
       {575591, 549976}},
      {{1, 2, 3, 4, 1}, {5, 6, 7, 8, 5}, {9, 5, 10, 11, 9}}, [](long way) {
        return way == 1 ? testing::osm_tag("building", "yes") + testing::osm_tag("height", "30")
                        : testing::osm_tag("building:part", "yes") + testing::osm_tag("height", way == 2 ? "20" : "30");
      });
  write_bytes(folder_ / "city.osm", testing::osm_xml(ways));
  const City city = build_city(folder_ / "city.osm", round_place(0.0528976, 0.0539891, 5000));
  ASSERT_EQ(city.scene.ledger.size(), 1u);
  const LedgerEntry& entry = city.scene.ledger[0];
  EXPECT_TRUE(entry.stand_in);
  ASSERT_TRUE(entry.box);
  EXPECT_EQ(entry.box->max.z(), 30);
  testing::expect_wording(entry.reason + "; stands in: " + entry.instead);
  EXPECT_GT(object_volume(city.scene, "way/1"), 0.9 * 600 * 600 * 1e-4 * 123.09 * 0.3);
}

TEST_F(CityTest, SaysWhatItMadeUp) {
  MapText map;
  map.line({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {{"building", "yes"}, {"height", "10"}});
  const long a = map.node(40, 0), b = map.node(60, 0), c = map.node(60, 20);
  map.way({a, b, c, 99, a}, {{"building", "yes"}});
  map.way({a, 99, b}, {{"barrier", "wall"}});
  const City city = build(map);
  testing::expect_wording(reason_of(city, "way/1"));
  testing::expect_wording(reason_of(city, "way/2"));
  EXPECT_NE(reason_of(city, "way/3"), "");
  EXPECT_NEAR(object_volume(city.scene, "way/2"), 400 * 9, 5) << "the rectangle round the corners that are known";
}

TEST_F(CityTest, ScribblesCostNeitherTimeNorTheOthers) {
  MapText map;
  map.box(-30, 0, -10, 20, {{"building", "yes"}});
  std::mt19937 random(4);  // the seed
  const auto corner = [&] { return static_cast<double>(random() % 30000) / 100; };
  MapText::Positions scribble, tangle;
  for (int i = 0; i < 1900; ++i) scribble.emplace_back(corner(), corner());
  for (int i = 0; i < 60; ++i) tangle.emplace_back(corner(), corner());
  map.area(scribble, {{"building", "yes"}});
  map.area(tangle, {{"building", "yes"}});
  map.line(scribble, {{"barrier", "wall"}, {"height", "3"}});
  MapText::Positions round = {{600, 0}};  // 1900 corners and one crossing
  for (int i = 0; i < 1900; ++i) round.emplace_back(500 + 90 * std::cos(i * 0.0033), 90 * std::sin(i * 0.0033));
  round.emplace_back(600, 20);
  map.area(round, {{"building", "yes"}});
  const City city = build(map);
  EXPECT_GT(object_volume(city.scene, "way/5"), 0);
  EXPECT_EQ(reason_of(city, "way/1"), "");
  EXPECT_EQ(record_of(city, "way/2").object.kind, ObjectKind::stand_in);
  EXPECT_GT(record_of(city, "way/2").footprint_m2, 299 * 299) << "the rectangle round it";
  EXPECT_NE(reason_of(city, "way/3"), "");
  EXPECT_EQ(reason_of(city, "way/4"), "");
  EXPECT_EQ(object_mesh(city.scene, "way/4").triangles.size(), 1899U * 12) << "each side is a box";
}

TEST_F(CityTest, SkipsWhatIsUndergroundAndWhatIsNoBuilding) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.box(30, 0, 50, 20, {{"building", "yes"}, {"location", "underground"}});
  map.area({{60, 0}, {70, 0}, {80, 0}}, {{"building", "yes"}});
  map.box(-6000, 100, 6000, 120, {{"building", "yes"}});
  map.box(0, 40, 20, 60, {{"building", "no"}});
  const City city = build(map);
  EXPECT_EQ(reason_of(city, "way/2"), "underground");
  EXPECT_EQ(record_of(city, "way/3").object.kind, ObjectKind::stand_in) << "a line";
  EXPECT_EQ(reason_of(city, "way/4"), "") << "however large";
  EXPECT_EQ(city.report.records.size(), 3U) << "way/5 is no building at all";
  EXPECT_EQ(city.report.passed_over.size(), 1U);
  EXPECT_EQ(city.scene.ledger.size(), 1U);
}

TEST_F(CityTest, WhatLiesUndergroundIsNotBuilt) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}, {"layer", "-1"}});
  map.box(30, 0, 50, 20, {{"man_made", "storage_tank"}, {"location", "underground"}});
  const City city = build(map);
  EXPECT_EQ(reason_of(city, "way/2"), "underground");
  const CityRecord& doubtful = record_of(city, "way/1");  // a layer alone does not say that it cannot be seen
  ASSERT_EQ(doubtful.remarks.size(), 1U);
  testing::expect_wording(doubtful.remarks[0].text);
}

TEST_F(CityTest, DefaultsCanBeSet) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.box(30, 0, 50, 20, {{"building", "house"}});
  map.box(60, 0, 80, 20, {{"building", "yes"}, {"building:levels", "5"}});
  const City plain = build(map);
  EXPECT_NEAR(record_of(plain, "way/1").top_m, 9, 1e-9) << "three storeys of 3 m";
  EXPECT_NEAR(record_of(plain, "way/3").top_m, 15, 1e-9);
  CityOptions options;
  options.defaults.level_m = 4;
  options.defaults.levels = 2;
  options.defaults.levels_of["house"] = 1;
  const City set = build(map, options);
  EXPECT_NEAR(record_of(set, "way/1").top_m, 8, 1e-9);
  EXPECT_NEAR(record_of(set, "way/2").top_m, 4, 1e-9);
  EXPECT_NEAR(record_of(set, "way/3").top_m, 20, 1e-9);
  MapText levels;
  levels.box(0, 0, 20, 20, {{"amenity", "parking"}, {"building:levels", "5"}});
  levels.box(30, 0, 50, 20, {{"building:levels", "5"}, {"roof:shape", "gabled"}});
  const City stand_ins = build(levels, options);
  EXPECT_NEAR(record_of(stand_ins, "way/1").top_m, 20, 1e-9) << "of stand-ins, too";
  EXPECT_GT(record_of(stand_ins, "way/2").top_m, 24) << "its roof is on top of its levels";
}

TEST_F(CityTest, TakesWhatHasACornerInTheRegionWhole) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.box(90, 0, 140, 20, {{"building", "yes"}});
  map.box(300, 0, 320, 20, {{"building", "yes"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 100;
  const City city = build(map, options);
  EXPECT_EQ(city.report.records.size(), 2U);
  EXPECT_EQ(city.report.outside, 1U);
  EXPECT_NEAR(bounding_box(object_mesh(city.scene, "way/2")).max.x(), 140, 1e-2);
}

/// What a map holds round a small region, or reaching into it, is built for it as for the whole map.
TEST_F(CityTest, WhatStandsInTheRegionIsBuiltHoweverItIsDrawn) {
  const MapText::TagList block = {{"building", "yes"}, {"height", "50"}};
  const double r = 1500;
  const MapText::Positions corners = {{r, -r}, {-r, -r}, {-r, r}, {r, r}};
  const MapText::Positions twice = {{-r, -r}, {r, -r}, {r, r}, {-r, r}, {-r, -r}, {r, -r}, {r, r}, {-r, r}};
  const MapText::Positions open = {{r, -1}, {r, -r}, {-r, -r}, {-r, r}, {r, r}, {r, 1}};
  // Of a square on a corner, whose lowest is missing.
  const MapText::Positions on_corner = {{600, 590}, {2800, 2790}, {0, 5590}, {-2800, 2790}, {-600, 590}};
  const MapText::TagList rotor = {{"power", "generator"}, {"generator:source", "wind"}, {"height", "200"}};
  const auto unfinished = [&](MapText& map, const MapText::Positions& known) {
    std::vector<long> refs;
    for (const auto& [east, north] : known) refs.push_back(map.node(east, north));
    refs.insert(refs.end(), {999, refs.front()});
    map.way(refs, block);
  };
  const auto group = [&](MapText& map, long one, const char* role, long other, const char* other_role) {
    const bool is_outline = std::string(role) == "outline";
    map.relation({{"way", one, role}, {"way", other, other_role}},
                 {{"type", is_outline ? "building" : "multipolygon"}, {"building", "yes"}, {"height", "50"}});
  };
  using Draw = std::function<void(MapText&)>;
  const std::vector<std::pair<const char*, Draw>> cases = {
      {"open way", [&](MapText& m) { m.line(open, block); }},
      {"wound twice", [&](MapText& m) { m.area(twice, block); }},
      {"rare kind",
       [&](MapText& m) {
         m.area(corners, {{"attraction", "animal"}, {"height", "30"}});
       }},
      {"open castle",
       [&](MapText& m) {
         m.line(corners, {{"historic", "castle"}, {"height", "30"}});
       }},
      {"corner missing", [&](MapText& m) { unfinished(m, corners); }},
      {"corner of a turned rectangle", [&](MapText& m) { unfinished(m, on_corner); }},
      {"outer twice", [&](MapText& m) { group(m, m.area(corners, {}), "outer", m.area(corners, {}), "outer"); }},
      {"all hole", [&](MapText& m) { group(m, m.area(corners, {}), "outer", m.area(corners, {}), "inner"); }},
      {"nested", [&](MapText& m) { group(m, m.area(corners, {}), "outer", m.box(-900, -900, 900, 900, {}), "outer"); }},
      {"open ring", [&](MapText& m) { group(m, m.line(open, {}), "outer", m.box(-900, 800, 900, 900, {}), "outer"); }},
      {"half missing", [&](MapText& m) { group(m, m.line(corners, {}), "outer", 99, "outer"); }},
      {"outline without tags", [&](MapText& m) { group(m, m.area(corners, {}), "outline", m.area(corners, {}), ""); }},
      {"point", [&](MapText& m) { m.node(25, 0, block); }},
      {"rotor", [&](MapText& m) { m.node(60, 0, rotor); }},
      {"crown",
       [&](MapText& m) {
         m.node(0, -24, {{"natural", "tree"}, {"height", "20"}});
       }},
      {"wide wall", [&](MapText& m) {
         m.line({{-9, 22}, {9, 22}}, {{"barrier", "wall"}, {"width", "6"}});
       }}};
  for (const auto& [name, draw] : cases) {
    SCOPED_TRACE(name);
    MapText map;
    map.box(5, 5, 10, 10, {{"building", "yes"}, {"height", "3"}});
    draw(map);
    CityOptions options;
    options.region.center_deg = {48.1374, 11.5755};
    options.region.radius_m = 6000;
    const City whole = build(map, options);
    ASSERT_EQ(whole.report.records.size(), 2U);
    options.region.radius_m = 20;
    const City part = build(map, options);
    ASSERT_EQ(part.report.records.size(), 2U);
    EXPECT_EQ(part.report.outside, 0U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(part.report.records[i].object, whole.report.records[i].object);
      EXPECT_NEAR(part.report.records[i].footprint_m2, whole.report.records[i].footprint_m2, 0.01);
    }
  }
}

TEST_F(CityTest, WhatOnlyLiesRoundTheRegionIsNotBuilt) {
  MapText map;
  map.box(5, 5, 10, 10, {{"building", "yes"}, {"height", "3"}});
  const long outer = map.box(-1500, -1500, 1500, 1500, {}), inner = map.box(-1000, -1000, 1000, 1000, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}}, {{"type", "multipolygon"}, {"building", "yes"}});
  map.box(-500, -500, 500, 500, {{"barrier", "wall"}});
  map.node(33, 0, {{"building", "yes"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 20;
  const City city = build(map, options);
  EXPECT_EQ(city.report.records.size(), 1U);
  EXPECT_EQ(city.report.outside, 3U);
}

TEST_F(CityTest, ABuildingComesWithAllItsParts) {
  MapText map;
  map.box(50, 0, 250, 20, {{"building", "yes"}, {"height", "9"}});
  map.box(50, 0, 150, 20, {{"building:part", "yes"}, {"height", "9"}});
  map.box(150, 0, 250, 20, {{"building:part", "yes"}, {"height", "30"}});
  map.box(150, 40, 250, 60, {{"building", "yes"}, {"height", "30"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 100;
  const City city = build(map, options);
  EXPECT_EQ(record_of(city, "way/3").object.kind, ObjectKind::building_part) << "no corner of it lies in the region";
  EXPECT_EQ(city.report.records.size(), 2U) << "way/1 has parts";
  EXPECT_EQ(city.report.outside, 1U);
}

TEST_F(CityTest, RefusesRegionsThatHoldNothing) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.node(2000, 0);
  CityOptions options;
  options.region.radius_m = 50;
  options.region.center_deg = {48.1374, 11.5955};
  expect_refused(map, options, ErrorCode::region_empty);
  options.region.center_deg = {11.5755, 48.1374};
  expect_refused(map, options, ErrorCode::region_outside);
  options.region.center_deg = {47, 11};
  expect_refused(map, options, ErrorCode::region_outside);
  options.region.center_deg = {148, 11};
  expect_refused(map, options, ErrorCode::not_on_earth);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 0;
  expect_refused(map, options, ErrorCode::region_invalid);
  options.region = {};
  options.region.bbox_deg = {11.6, 48.1, 11.5, 48.2};
  expect_refused(map, options, ErrorCode::region_invalid);
  options.region.bbox_deg = {48.1, 11.5, 48.2, 11.6};
  expect_refused(map, options, ErrorCode::region_outside);
}

TEST_F(CityTest, SaysWhyNothingCanBeBuilt) {
  MapText map;
  const long cellar = map.box(0, 0, 20, 20, {{"building", "yes"}, {"location", "underground"}});
  map.box(30, 0, 50, 20, {{"building", "yes"}, {"location", "underground"}});
  map.relation({{"way", cellar, "outline"}}, {{"type", "building"}, {"building", "yes"}});
  expect_refused(map, {}, ErrorCode::map_empty);
  map.box(1000, 0, 1020, 20, {{"building", "yes"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 100;
  expect_refused(map, options, ErrorCode::region_empty);
  expect_refused(map, options, ErrorCode::region_empty);
}

TEST_F(CityTest, GroupsBelongToTheRegionThatTheirMembersDo) {
  MapText map;
  const long near = map.box(0, 0, 20, 20, {{"building", "yes"}});
  const long far = map.box(1000, 0, 1020, 20, {{"building", "yes"}});
  map.relation({{"way", near, "outline"}}, {{"type", "building"}, {"building", "yes"}});
  map.relation({{"way", far, "outline"}}, {{"type", "building"}, {"building", "yes"}});
  CityOptions options;
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 100;
  const City city = build(map, options);
  EXPECT_EQ(city.report.records.size(), 1U);
  EXPECT_NE(reason_of(city, "relation/1"), "");
  EXPECT_EQ(reason_of(city, "relation/2"), "");
}

TEST_F(CityTest, RefusesAMapWithoutBuildings) {
  MapText map;
  map.line({{0, 0}, {100, 0}}, {{"highway", "residential"}});
  expect_refused(map, {}, ErrorCode::map_empty);
}

TEST_F(CityTest, AFileThatSaysThatItIsNotCompleteIsRefused) {
  MapText map;
  map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}});
  std::string text = map.text();
  text.insert(text.rfind("</osm>"), "<remark> runtime error: Query timed out after 26 seconds. </remark>");
  write_bytes(folder_ / "city.osm", text);
  CityOptions options;
  testing::expect_error([&] { build_city(folder_ / "city.osm", options); }, ErrorCode::scene_incomplete, "city.osm");
  testing::expect_code([&] { plan_tiles(folder_ / "city.osm", options, 100, 10); }, ErrorCode::scene_incomplete);
  testing::expect_code([&] { read_areas(folder_ / "city.osm"); }, ErrorCode::scene_incomplete);
  options.partial = true;
  const City city = build_city(folder_ / "city.osm", options);
  EXPECT_EQ(city.report.records.size(), 1u);
  ASSERT_EQ(city.scene.ledger.size(), 1u);
  EXPECT_FALSE(city.scene.ledger[0].box);
  EXPECT_FALSE(city.scene.ledger[0].stand_in);
  testing::expect_wording(city.scene.ledger[0].what + ": " + city.scene.ledger[0].reason);
  testing::expect_wording(city.report.notes);
}

TEST_F(CityTest, VoidsOfTheTerrainAreInTheLedger) {
  MapText map({9, 45.15});
  map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}});
  const geo::CoordinateSystem utm("EPSG:32632", "test");
  const Eigen::Vector2d middle = utm.from_lonlat({9, 45.15});
  testing::TestRaster raster = testing::make_raster(300, 300, [](int column, int row) {
    const bool is_void = column >= 200 && column < 210 && row >= 145 && row < 155;
    return is_void ? -9999 : column == 199 && row == 150 ? 530 : 500;
  });
  raster.transform = {middle.x() - 150, 1, 0, middle.y() + 150, 0, -1};
  CityOptions options;
  options.terrain = testing::write_raster(folder_.path(), "dem", raster);
  const City city = build(map, options);
  ASSERT_EQ(city.scene.ledger.size(), 1u);
  const LedgerEntry& entry = city.scene.ledger[0];
  ASSERT_TRUE(entry.stand_in && entry.box);
  EXPECT_EQ(city.scene.objects[*entry.stand_in], (SceneObject{"ground", "", ObjectKind::ground}));
  EXPECT_NEAR(entry.box->min.x(), 50, 1);
  EXPECT_NEAR(entry.box->max.x(), 60, 1);
  // What is at least 30 m above the ground there is so above the rim, what is at most 50 m above it above its lowest.
  const GroundLevels levels(ground_of(city.scene).value());
  const auto range = levels.at(55, 0).value();
  EXPECT_NEAR(range.highest_m, 530, 0.01);
  EXPECT_NEAR(range.lowest_m, 500, 0.01);
  EXPECT_NEAR(levels.at(30, 0).value().highest_m, 500, 0.5);

  options.missing = MissingPolicy::warn;
  const City warned = build(map, options);
  ASSERT_EQ(warned.scene.ledger.size(), 1u);
  EXPECT_FALSE(warned.scene.ledger[0].stand_in);
  EXPECT_LT(GroundLevels(ground_of(warned.scene).value()).at(55, 0).value().highest_m, 520);
}

TEST_F(CityTest, StandsOnTerrain) {
  MapText map;
  map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}});
  map.box(-10, -10, 10, 0, {{"building:part", "yes"}, {"height", "12"}});
  map.box(-10, 0, 10, 10, {{"building:part", "yes"}, {"height", "12"}});
  CityOptions options;
  options.terrain = slope(0.1);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 100;
  const City city = build(map, options);
  for (const char* part : {"way/2", "way/3"}) {
    EXPECT_NEAR(record_of(city, part).ground_m, 499, 0.05) << "the lowest ground under the building, not the part";
    EXPECT_NEAR(record_of(city, part).top_m, 511, 0.05);
  }
  const Box ground = bounding_box(object_mesh(city.scene, "ground"));
  EXPECT_NEAR(ground.max.z() - ground.min.z(), 0.1 * (20 + 2 * options.ground_margin_m), 0.2);
}

/// z of the highest facet over a place; minus infinity where there is none.
double highest_over(const Mesh& mesh, double x, double y) {
  double highest = -HUGE_VAL;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const auto is_left = [&](const Vec3& p, const Vec3& q) {
      return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x()) >= 0;
    };
    if (!(normal.z() > 0) || !is_left(a, b) || !is_left(b, c) || !is_left(c, a)) continue;
    highest = std::max(highest, a.z() - (normal.x() * (x - a.x()) + normal.y() * (y - a.y())) / normal.z());
  }
  return highest;
}

TEST_F(CityTest, WhatStandsInIsAboveAllGroundUnderIt) {
  MapText map;
  map.area({{-100, -200}, {100, -200}, {100, 200}}, {{"natural", "wood"}, {"height", "20"}});
  map.box(200, 0, 210, 16, {{"natural", "wood"}, {"height", "20"}});
  const long first = map.node(-300, -20), second = map.node(-260, -20), third = map.node(-260, 20);
  map.way({first, second, third, 999, map.node(-300, -10), first},
          {{"building", "yes"}, {"height", "15"}, {"roof:shape", "gabled"}});
  map.node(250, 0, {{"building", "yes"}, {"height", "9"}});
  map.box(300, 0, 310, 10, {{"building", "yes"}, {"height", "9"}});
  CityOptions options;
  options.terrain = slope(0.5);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 2000;
  const City city = build(map, options);
  const Mesh ground = object_mesh(city.scene, "ground");
  const double z = highest_over(ground, 0, 0);
  // In pieces, at most 20 m higher than they must be.
  const Mesh wood = object_mesh(city.scene, "way/1");
  for (double north = -199.5; north < 199; north += 3.7) {
    for (double east = 99.5; east > -99.5 + (north + 200) / 2; east -= 3.3) {
      const double above = highest_over(wood, east, north) - highest_over(ground, east, north);
      EXPECT_GE(above, 20 - 1e-3) << east << " " << north;
      EXPECT_LE(above, 40 + 1e-3) << east << " " << north;
    }
  }
  EXPECT_NEAR(record_of(city, "way/1").base_m, z - 100, 0.2);
  const std::string& instead = city.scene.ledger.at(1).instead;
  EXPECT_NE(instead.find(" pieces, each "), std::string::npos) << instead;
  // In one piece.
  EXPECT_NEAR(record_of(city, "way/2").base_m, z, 0.1);
  EXPECT_NEAR(record_of(city, "way/2").top_m, z + 8 + 20, 0.1);
  EXPECT_NEAR(record_of(city, "node/12").top_m - record_of(city, "node/12").base_m, 20 * 0.5 + 9, 0.3);
  // The whole rectangle, without a roof.
  const Mesh tall = object_mesh(city.scene, "way/3");
  EXPECT_GE(highest_over(tall, -299, 19), highest_over(ground, -299, 19) + 15);
  EXPECT_GE(highest_over(tall, -261, 19), highest_over(ground, -261, 19) + 15);
  EXPECT_NEAR(record_of(city, "way/4").top_m, z + 9, 0.1) << "a building's height counts from the lowest";
}

TEST_F(CityTest, WallsFollowTheGround) {
  MapText map;
  map.box(-2, -150, 2, 150, {{"barrier", "city_wall"}, {"area", "yes"}, {"height", "6"}});
  map.line({{20, -50}, {20, 50}}, {{"barrier", "fence"}, {"height", "1.5"}});
  CityOptions options;
  options.terrain = slope(0.3);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 400;
  const City city = build(map, options);
  const Mesh ground = object_mesh(city.scene, "ground");
  const Mesh wall = object_mesh(city.scene, "way/1"), fence = object_mesh(city.scene, "way/2");
  for (double north = -149.3; north < 149.5; north += 1.7) {
    const double above = highest_over(wall, 0.3, north) - highest_over(ground, 0.3, north);
    EXPECT_GE(above, 6 - 1e-3) << north;
    EXPECT_LE(above, 12.1) << north;
  }
  for (double north = -49.3; north < 49.5; north += 0.73) {
    const double above = highest_over(fence, 20.01, north) - highest_over(ground, 20.01, north);
    EXPECT_GE(above, 1.5 - 1e-3) << north;
    EXPECT_LE(above, 1.5 + 3.1) << north;
  }
  EXPECT_TRUE(city.scene.ledger.empty());
}

TEST_F(CityTest, TreesOfAHedgeStandOnTheGround) {
  MapText map;
  map.line({{20, -50}, {20, 50}}, {{"barrier", "hedge"}, {"natural", "tree_row"}});
  CityOptions options;
  options.terrain = slope(0.3);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 400;
  const City city = build(map, options);
  const Mesh ground = object_mesh(city.scene, "ground"), row = object_mesh(city.scene, "way/1");
  const double south = highest_over(ground, 20, -50), north = highest_over(ground, 20, 50);
  EXPECT_NEAR(bounding_box(row).max.z(), north + OccluderDefaults().tree_m, 0.5);
  EXPECT_NEAR(bounding_box(row).min.z(), south, 0.5);
}

TEST_F(CityTest, NoNeedleOfAWoodIsCutOff) {
  MapText map;
  const double tip = 31;
  map.area({{-40, 0}, {tip, 0}, {0, 0.03}, {0, 60}, {-40, 60}}, {{"natural", "wood"}, {"height", "5"}});
  CityOptions options;
  options.terrain = slope(0.5);
  options.region.center_deg = {48.1374, 11.5755};
  options.region.radius_m = 400;
  const Box box = bounding_box(object_mesh(build(map, options).scene, "way/1"));
  EXPECT_NEAR(box.max.x(), tip, 0.02);
}

}  // namespace
}  // namespace vantage
