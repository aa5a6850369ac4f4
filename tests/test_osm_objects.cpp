// What becomes of nodes, ways and relations, sound and broken.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "maps/osm/meaning.h"
#include "support/osm_maps.h"
#include "support/shared_data.h"

namespace vantage::internal::osm {
namespace {

using testing::doubled_area;
using testing::extract_of;
using testing::find_problem;
using testing::osm_node;
using testing::osm_relation;
using testing::osm_ring;
using testing::osm_square;
using testing::osm_tag;
using testing::osm_way;
using testing::relation_id;
using testing::way_id;
using Kind = Problem::Kind;

const std::string kBuilding = osm_tag("building", "yes");
const std::string kMultipolygon = osm_tag("type", "multipolygon");
// A square of 0.001 degrees, nodes 1 to 4, and one inside it, nodes 5 to 8.
const std::string kNodes = osm_square(1, 8, 47, 0.001) + osm_square(5, 8.0002, 47.0002, 0.0005);

Tags tags_of(std::vector<std::pair<std::string, std::string>> all) { return Tags{std::move(all)}; }

void expect_problem(const Extract& extract, ObjectId id, Kind kind, bool lost, const std::string& what) {
  const Problem* const problem = find_problem(extract, id);
  ASSERT_NE(problem, nullptr) << text(id) << testing::describe(extract);
  EXPECT_EQ(problem->kind, kind) << problem->what;
  EXPECT_EQ(problem->lost, lost) << problem->what;
  EXPECT_NE(problem->what.find(what), std::string::npos) << problem->what;
}

TEST(OsmTags, AreSearchedByKey) {
  const Tags tags = tags_of({{"building", "yes"}, {"name", ""}});
  EXPECT_EQ(tags.get("building"), "yes");
  EXPECT_EQ(tags.get("name"), "");
  EXPECT_EQ(tags.get("build"), "");
  EXPECT_TRUE(tags.has("name"));
  EXPECT_FALSE(tags.has("build"));
}

TEST(OsmTags, SayWhatAClosedWayIs) {
  struct Case {
    std::vector<std::pair<std::string, std::string>> tags;
    bool area, line;
  };
  const std::vector<Case> cases = {{{{"building", "yes"}}, true, false},
                                   {{{"building", "no"}}, false, true},
                                   {{{"building:part", "yes"}}, true, false},
                                   {{{"building", "yes"}, {"area", "no"}}, true, false},
                                   {{{"barrier", "wall"}}, false, true},
                                   {{{"barrier", "wall"}, {"area", "yes"}}, true, false},
                                   {{{"barrier", "hedge"}, {"leisure", "garden"}}, true, true},
                                   {{{"natural", "tree_row"}}, false, true},
                                   {{{"natural", "wood"}}, true, false},
                                   {{{"landuse", "grass"}, {"area", "no"}}, false, true},
                                   {{{"amenity", "parking"}}, true, false},
                                   {{{"place", "square"}}, true, false},
                                   {{{"area:highway", "footway"}}, true, false},
                                   {{{"man_made", "storage_tank"}}, true, false},
                                   {{{"man_made", "embankment"}}, false, true},
                                   {{{"highway", "pedestrian"}}, false, true},
                                   {{{"highway", "pedestrian"}, {"area", "yes"}}, true, false},
                                   {{{"name", "x"}}, false, true}};
  for (const Case& one : cases) {
    const std::string name = one.tags[0].first + "=" + one.tags[0].second;
    EXPECT_EQ(means_area(tags_of(one.tags)), one.area) << name;
    EXPECT_EQ(means_line(tags_of(one.tags)), one.line) << name;
  }
}

TEST(OsmWays, BecomeAreasLinesOrBoth) {
  const Extract extract =
      extract_of(kNodes + osm_way(11, osm_ring(1), kBuilding) + osm_way(12, osm_ring(5), osm_tag("barrier", "wall")) +
                 osm_way(13, {4, 3, 2, 1, 4}, osm_tag("leisure", "garden") + osm_tag("barrier", "fence")) +
                 osm_way(14, {1, 2, 3}, osm_tag("barrier", "wall")) +
                 osm_way(15, {1, 2, 3}, osm_tag("leisure", "track")) + osm_way(16, {1, 2, 3}));
  EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
  ASSERT_EQ(extract.areas.size(), 2u);
  EXPECT_EQ(extract.areas[0].id, way_id(11));
  EXPECT_EQ(extract.areas[1].id, way_id(13));
  for (const Area& area : extract.areas) {
    ASSERT_EQ(area.polygons.size(), 1u);
    EXPECT_EQ(area.polygons[0].outer.size(), 4u);
    EXPECT_NEAR(doubled_area(area.polygons[0].outer), 2e-6, 1e-12);
  }
  ASSERT_EQ(extract.lines.size(), 4u);
  EXPECT_EQ(extract.lines[0].id, way_id(12));
  EXPECT_EQ(extract.lines[0].points.size(), 5u);
  EXPECT_EQ(extract.lines[1].id, way_id(13));
  EXPECT_EQ(extract.lines[2].points.size(), 3u);
  EXPECT_EQ(extract.nodes, 8u);
  EXPECT_EQ(extract.ways, 6u);
  EXPECT_EQ(extract.bounds_deg, (std::array<double, 4>{8, 47, 8.001, 47.001}));
}

TEST(OsmWays, OnlyWhatIsWantedIsRead) {
  ReadOptions options;
  options.wanted = [](const Tags& tags) { return tags.get("height") == "7"; };
  const std::string wanted = osm_tag("height", "7");
  const Extract extract =
      extract_of(kNodes + osm_node(9, 8, 47, wanted) + osm_node(10, 8, 47, kBuilding) +
                     osm_way(11, osm_ring(1), kBuilding) + osm_way(12, osm_ring(5), kBuilding + wanted) +
                     osm_way(13, {1, 2}, kBuilding) + osm_relation(20, {"way 11 outer"}, kMultipolygon + kBuilding) +
                     osm_relation(21, {"way 12 outer"}, kMultipolygon),
                 options);
  EXPECT_EQ(extract.points.size(), 1u);
  EXPECT_EQ(extract.lines.size(), 0u);
  EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.areas[0].id, relation_id(21));  // old-style: the way's tags make it wanted
}

TEST(OsmWays, WithTooFewNodesAreLost) {
  const Extract extract = extract_of(
      kNodes + osm_node(9, 8.0005, 47) + osm_node(10, 8, 47) + osm_way(11, {}, kBuilding) +
      osm_way(12, {1}, kBuilding) + osm_way(13, {1, 2}, kBuilding) + osm_way(14, {1, 2, 1}, kBuilding) +
      osm_way(15, {1, 9, 2, 1}, kBuilding) + osm_way(16, {1, 1, 1, 1}, kBuilding) + osm_way(17, {1, 10, 1}, kBuilding) +
      osm_way(21, {}, osm_tag("barrier", "wall")) + osm_way(22, {1, 10}, osm_tag("barrier", "wall")));
  EXPECT_TRUE(extract.lines.empty());
  EXPECT_EQ(extract.problems.size(), 9u);
  expect_problem(extract, way_id(11), Kind::degenerate, true, "bound no area");  // no place at all
  for (long id = 12; id <= 17; ++id) expect_problem(extract, way_id(id), Kind::degenerate, false, "bound no area");
  ASSERT_EQ(extract.areas.size(), 6u);
  for (const Area& area : extract.areas) EXPECT_TRUE(area.polygons.at(0).incomplete);
  expect_problem(extract, way_id(22), Kind::degenerate, true, "no two different positions");
}

TEST(OsmWays, AreBuiltFromTheNodesThatAreThere) {
  const Extract extract =
      extract_of(kNodes + osm_way(11, {1, 99, 2, 3, 4, 1}, kBuilding) + osm_way(12, {99, 1, 2, 3, 99}, kBuilding) +
                 osm_way(13, {98, 1, 99, 98}, kBuilding) + osm_way(14, {97, 98, 99, 97}, kBuilding) +
                 osm_way(15, {1, 99, 2}, osm_tag("barrier", "wall")));
  expect_problem(extract, way_id(11), Kind::missing_nodes, false, "1 of 6 nodes is not in the file");
  expect_problem(extract, way_id(12), Kind::missing_nodes, false, "2 of 5 nodes are not in the file");
  expect_problem(extract, way_id(13), Kind::missing_nodes, false, "3 of 4 nodes are not in the file");
  expect_problem(extract, way_id(14), Kind::missing_nodes, true, "bound no area");
  expect_problem(extract, way_id(15), Kind::missing_nodes, false, "1 of 3 nodes");
  ASSERT_EQ(extract.areas.size(), 3u);
  EXPECT_EQ(extract.areas[0].polygons[0].outer.size(), 4u);
  EXPECT_EQ(extract.areas[1].polygons[0].outer.size(), 3u);
  EXPECT_EQ(extract.areas[2].polygons[0].outer.size(), 1u);
  for (const Area& area : extract.areas) EXPECT_TRUE(area.polygons[0].incomplete);
  ASSERT_EQ(extract.lines.size(), 1u);
  EXPECT_EQ(extract.lines[0].points.size(), 2u);
}

TEST(OsmWays, AnOpenBuildingIsClosed) {
  const Extract extract = extract_of(kNodes + osm_way(11, {1, 2, 3, 4}, kBuilding) +
                                     osm_way(12, {1, 2, 3}, osm_tag("area", "yes") + osm_tag("landuse", "grass")));
  // 0.001 degrees of latitude at 47 degrees north: 111.2 m.
  expect_problem(extract, way_id(11), Kind::open_outline, false, "a straight side of 111.2 m closes it");
  expect_problem(extract, way_id(12), Kind::open_outline, false, "closes it");
  ASSERT_EQ(extract.areas.size(), 2u);
  EXPECT_NEAR(doubled_area(extract.areas[0].polygons[0].outer), 2e-6, 1e-12);
}

TEST(OsmWays, ThatCrossThemselvesAreTakenAsDrawn) {
  const Extract extract = extract_of(kNodes + osm_way(11, {1, 3, 2, 4, 1}, kBuilding));
  expect_problem(extract, way_id(11), Kind::broken_multipolygon, false,
                 "it crosses itself at 8.0005000, 47.0005000; taken as it is drawn");
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.areas[0].polygons[0].outer.size(), 4u);
}

TEST(OsmNodes, OffTheEarthAreMissing) {
  const Extract extract = extract_of(kNodes + osm_node(9, 200, 47) + osm_node(10, 8, -91, osm_tag("natural", "tree")) +
                                     osm_way(11, {1, 2, 9, 3, 4, 1}, kBuilding));
  EXPECT_EQ(extract.bounds_deg, (std::array<double, 4>{8, 47, 8.001, 47.001}));
  expect_problem(extract, way_id(11), Kind::missing_nodes, false, "1 of 6 nodes is nowhere on the earth");
  expect_problem(extract, {ObjectType::node, 10}, Kind::degenerate, true, "nowhere on the earth");
  EXPECT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.points.size(), 0u);
}

TEST(OsmVersions, OnlyTheCurrentOnesCount) {
  const std::string tree = osm_tag("natural", "tree");
  const std::string content =
      "<node id='1' version='1' lon='8' lat='47'>" + tree + "</node><node id='1' version='2' lon='9' lat='47'/>" +
      "<node id='2' version='1' lon='8' lat='47'>" + tree + "</node><node id='2' version='2' visible='false'/>" +
      "<node id='3' version='1' lon='8' lat='47'>" + tree + "</node><node id='3' version='3' lon='8.5' lat='47'>" +
      tree + "</node>" + osm_square(4, 8, 47, 0.001) +
      "<way id='10' version='1'><nd ref='4'/><nd ref='5'/><nd ref='6'/><nd ref='4'/>" + kBuilding + "</way>" +
      "<way id='10' version='2' visible='false'/>" +
      "<way id='11' version='1' visible='true'><nd ref='4'/><nd ref='5'/><nd ref='6'/><nd ref='4'/>" + kBuilding +
      "</way><way id='11' version='4' visible='true'><nd ref='4'/><nd ref='5'/><nd ref='6'/><nd ref='7'/><nd "
      "ref='4'/>" +
      kBuilding + "</way>" + "<way id='12' version='1'><nd ref='4'/><nd ref='2'/>" + tree + "</way>" +
      "<relation id='20' version='1'><member type='way' ref='12' role='outer'/>" + kMultipolygon + kBuilding +
      "</relation><relation id='20' version='2' visible='false'/>";
  const Extract extract = extract_of(content);
  ASSERT_EQ(extract.areas.size(), 1u) << testing::describe(extract);
  EXPECT_EQ(extract.areas[0].id, way_id(11));
  EXPECT_EQ(extract.areas[0].polygons[0].outer.size(), 4u);
  ASSERT_EQ(extract.points.size(), 1u);
  EXPECT_EQ(extract.points[0].position.longitude_deg, 8.5);
  expect_problem(extract, way_id(12), Kind::missing_nodes, true, "1 of 2 nodes");
  EXPECT_EQ(extract.problems.size(), 1u);
  EXPECT_EQ(extract.nodes, 6u);
  EXPECT_EQ(extract.ways, 2u);
  EXPECT_EQ(extract.relations, 0u);
  EXPECT_EQ(extract.superseded, 6u);
  EXPECT_TRUE(extract.sorted);
}

TEST(OsmVersions, OfCopiesTheLastCounts) {
  const std::string far = osm_node(2, 8.002, 47);
  const Extract extract = extract_of(kNodes + osm_way(11, osm_ring(1), kBuilding) + far +
                                     osm_way(11, osm_ring(1), osm_tag("building", "shed")));
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.areas[0].tags.get("building"), "shed");
  EXPECT_EQ(extract.areas[0].polygons[0].outer[1].longitude_deg, 8.002);
  EXPECT_EQ(extract.superseded, 2u);
  EXPECT_EQ(extract.ways, 1u);
  EXPECT_FALSE(extract.sorted);
}

TEST(OsmMultipolygons, HaveTheTagsOfTheirOuterWaysWhereTheyHaveNone) {
  const Extract extract =
      extract_of(kNodes + osm_way(11, osm_ring(1), kBuilding + osm_tag("height", "9")) + osm_way(12, osm_ring(5)) +
                 osm_relation(20, {"way 11 outer", "way 12 inner"}, kMultipolygon + osm_tag("source", "survey")));
  EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
  ASSERT_EQ(extract.areas.size(), 1u);  // the way is not one of its own
  EXPECT_EQ(extract.areas[0].id, relation_id(20));
  EXPECT_EQ(extract.areas[0].tags.get("height"), "9");
  ASSERT_EQ(extract.areas[0].polygons.size(), 1u);
  ASSERT_EQ(extract.areas[0].polygons[0].holes.size(), 1u);
  EXPECT_LT(doubled_area(extract.areas[0].polygons[0].holes[0]), 0);
}

TEST(OsmMultipolygons, StandForWaysThatSayNothingMore) {
  const std::string relation_tags = kMultipolygon + osm_tag("building", "school") + osm_tag("height", "9");
  const auto read = [&](const std::string& outer_tags, const std::string& inner_tags) {
    return extract_of(kNodes + osm_way(11, osm_ring(1), outer_tags) + osm_way(12, osm_ring(5), inner_tags) +
                      osm_relation(20, {"way 11 outer", "way 12 inner"}, relation_tags));
  };
  const Extract repeated = read(kBuilding + osm_tag("height", "9"), relation_tags);
  EXPECT_EQ(repeated.areas.size(), 2u) << "with a house in the courtyard";
  expect_problem(repeated, way_id(11), Kind::repeated_outline, true, "it bounds relation/20, which stands for it");
  EXPECT_EQ(testing::find_problem(repeated, way_id(12)), nullptr);
  const std::string wood = osm_tag("natural", "wood");
  const Extract clearing = extract_of(kNodes + osm_way(11, osm_ring(1)) + osm_way(12, osm_ring(5), wood) +
                                      osm_relation(20, {"way 11 outer", "way 12 inner"}, kMultipolygon + wood));
  EXPECT_EQ(clearing.areas.size(), 1u);
  expect_problem(clearing, way_id(12), Kind::repeated_outline, true, "tagged like relation/20, whose hole it bounds");
  // A tower of its own over the same outline, and a house in the courtyard.
  const Extract different = read(kBuilding + osm_tag("height", "90"), kBuilding);
  EXPECT_EQ(different.areas.size(), 3u);
  EXPECT_EQ(different.problems.size(), 0u);
}

TEST(OsmMultipolygons, JoinPiecesOfRings) {
  const std::string pieces = osm_way(11, {1, 2, 3}, kBuilding) + osm_way(12, {3, 4, 1}, kBuilding);
  const Extract old_style =
      extract_of(kNodes + pieces + osm_relation(20, {"way 11 outer", "way 12 outer"}, kMultipolygon));
  ASSERT_EQ(old_style.areas.size(), 1u) << testing::describe(old_style);
  EXPECT_EQ(old_style.areas[0].tags.get("building"), "yes");
  EXPECT_EQ(old_style.problems.size(), 0u);
  // With a piece missing what encloses the other one stands in.
  const Extract broken = extract_of(kNodes + osm_way(11, {1, 2, 3}, kBuilding) +
                                    osm_relation(20, {"way 11 outer", "way 12 outer"}, kMultipolygon));
  expect_problem(broken, relation_id(20), Kind::missing_members, false,
                 "1 of 2 ways is not in the file; the ring is open");
  ASSERT_EQ(broken.areas.size(), 1u);
  EXPECT_EQ(broken.areas[0].id, relation_id(20));
  EXPECT_TRUE(broken.areas[0].polygons.at(0).incomplete);
  // The relation has the tags: its pieces have nothing to add.
  const Extract repeated =
      extract_of(kNodes + pieces + osm_relation(20, {"way 11 outer", "way 12 outer"}, kMultipolygon + kBuilding));
  EXPECT_EQ(repeated.areas.size(), 1u);
  expect_problem(repeated, way_id(11), Kind::repeated_outline, true, "it bounds relation/20, which stands for it");
}

TEST(OsmMultipolygons, JoinPiecesThatBoundSomethingElse) {
  const std::string high = osm_tag("height", "40"), low = osm_tag("height", "10");
  const auto read = [&](const std::string& one, const std::string& other) {
    return extract_of(
        kNodes + osm_way(11, osm_ring(1)) + osm_way(12, {5, 6, 7}, one) + osm_way(13, {7, 8, 5}, other) +
        osm_relation(20, {"way 11 outer", "way 12 inner", "way 13 inner"}, kMultipolygon + kBuilding + low));
  };
  for (const std::string& other : {high, osm_tag("height", "30")}) {
    const Extract extract = read(kBuilding + high, kBuilding + other);
    ASSERT_EQ(extract.areas.size(), 2u) << testing::describe(extract);
    EXPECT_EQ(extract.areas[0].id, way_id(12));
    EXPECT_EQ(extract.areas[0].tags.get("height"), "40");
    EXPECT_EQ(extract.areas[0].heights.size(), other == high ? 0u : 1u);
    EXPECT_NEAR(doubled_area(extract.areas[0].polygons.at(0).outer), 5e-7, 1e-12);
    EXPECT_EQ(extract.areas[1].polygons.at(0).holes.size(), 1u);
    expect_problem(extract, way_id(13), Kind::repeated_outline, true, "it bounds way/12, which stands for it");
  }
  const Extract same = read(kBuilding + low, kBuilding + low);
  EXPECT_EQ(same.areas.size(), 1u) << "tagged like what it is a hole in";
  const Extract alone = read(kBuilding + high, "");
  expect_problem(alone, way_id(12), Kind::open_outline, false, "a straight side");
  const Extract hedges = read(osm_tag("barrier", "hedge"), osm_tag("barrier", "hedge"));
  EXPECT_EQ(hedges.areas.size(), 1u);
  EXPECT_EQ(hedges.lines.size(), 2u);
  const Extract wall =
      extract_of(kNodes + osm_way(11, {1, 2, 3}, kBuilding + high) + osm_way(12, {3, 4, 1}, kBuilding + high) +
                 osm_relation(20, {"way 11 outer", "way 12 outer"}, kMultipolygon + osm_tag("barrier", "wall")));
  EXPECT_NE(testing::find_object(wall.areas, way_id(11)), nullptr) << testing::describe(wall);
}

TEST(OsmMultipolygons, HeightsOfPiecesAreKeptBesideTheirOwn) {
  const auto read = [&](const std::string& own, const std::string& piece) {
    const Extract extract = extract_of(kNodes + osm_way(11, {1, 2, 3}, piece) + osm_way(12, {3, 4, 1}) +
                                       osm_relation(20, {"way 11 outer", "way 12 outer"}, kMultipolygon + own));
    const Area* const area = testing::find_object(extract.areas, relation_id(20));
    return area == nullptr ? Area{} : *area;
  };
  const std::string high = osm_tag("height", "10"), levels = osm_tag("building:levels", "20");
  const Area other = read(kBuilding + high, levels);
  EXPECT_EQ(other.tags.get("building:levels"), "");
  ASSERT_EQ(other.heights.size(), 1u);
  const Tags with = with_heights(other.tags, other.heights[0]);
  EXPECT_EQ(with.get("building:levels"), "20");
  EXPECT_FALSE(with.has("height"));
  EXPECT_TRUE(with.has("building"));
  EXPECT_EQ(read(kBuilding + high, kBuilding + high).heights.size(), 0u);
  EXPECT_EQ(read(kBuilding, high).tags.get("height"), "10") << "which it does not say itself";
  const Area fence = read(kBuilding, osm_tag("barrier", "fence") + high);
  EXPECT_FALSE(fence.tags.has("height"));
  EXPECT_EQ(fence.heights.size(), 1u) << "which may be of the fence alone";
}

TEST(OsmMultipolygons, AreMadeOfThoseThatAreTheirMembers) {
  const std::string tags = kMultipolygon + kBuilding;
  const Extract extract = extract_of(kNodes + osm_way(11, osm_ring(1)) + osm_way(12, osm_ring(5)) +
                                     osm_relation(20, {"way 12 inner"}, kMultipolygon) +
                                     osm_relation(21, {"way 11 outer", "relation 20 inner"}, tags) +
                                     osm_relation(22, {"way 11 outer", "relation 99 "}, tags));
  const Area* const nested = testing::find_object(extract.areas, relation_id(21));
  ASSERT_NE(nested, nullptr);
  EXPECT_EQ(nested->polygons.at(0).holes.size(), 1u);
  EXPECT_EQ(testing::find_problem(extract, relation_id(21)), nullptr);
  expect_problem(extract, relation_id(22), Kind::missing_members, false, "1 of 2 ways is not in the file");
  const Extract deep = extract_of(
      kNodes + osm_way(11, osm_ring(1)) + osm_way(12, osm_ring(5)) + osm_relation(20, {"way 12 outer"}, kMultipolygon) +
      osm_relation(21, {"relation 20 outer", "relation 22 outer"}, kMultipolygon) +
      osm_relation(22, {"way 11 outer", "relation 21 outer"}, tags) +
      osm_relation(23, {"way 11 outer", "relation 20 part"}, tags) + osm_relation(24, {"relation 20 outline"}, tags));
  for (const long id : {22, 23}) {
    expect_problem(deep, relation_id(id), Kind::missing_members, false, "relations in its relations are not read");
    EXPECT_TRUE(testing::find_object(deep.areas, relation_id(id))->partial) << id;
  }
  EXPECT_NE(testing::find_object(deep.areas, relation_id(24)), nullptr);
}

TEST(OsmMultipolygons, AnInnerMemberOutsideIsBuiltAndTold) {
  const std::string far = osm_node(31, 8.01, 47) + osm_node(32, 8.011, 47) + osm_node(33, 8.011, 47.001);
  const std::string ways =
      kNodes + far + osm_way(11, osm_ring(1)) + osm_way(12, osm_ring(5)) + osm_way(13, {31, 32, 33, 31});
  const Extract extract =
      extract_of(ways + osm_relation(20, {"way 11 outer", "way 12 inner", "way 13 inner"}, kMultipolygon + kBuilding));
  expect_problem(extract, relation_id(20), Kind::wrong_role, false, "its inner way/13 lies outside of its outer ones");
  EXPECT_EQ(extract.problems.size(), 1u);
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_EQ(extract.areas[0].polygons.size(), 2u);
}

TEST(OsmMultipolygons, SayWhatIsBroken) {
  const std::string tags = kMultipolygon + kBuilding;
  const Extract extract = extract_of(
      kNodes + osm_node(9, 8.002, 47) + osm_way(11, osm_ring(1)) + osm_way(12, osm_ring(5)) +
      osm_way(13, {1, 6, 4, 9, 1}) + osm_way(14, {1, 2, 3}) + osm_way(15, {}) +
      osm_relation(20, {"way 11 outer", "way 13 inner"}, tags) + osm_relation(21, {"way 14 outer"}, tags) +
      osm_relation(22, {}, tags) + osm_relation(23, {"node 1 admin_centre", "relation 23 outer"}, tags) +
      osm_relation(24, {"way 15 outer"}, tags) + osm_relation(25, {"way 99 outer"}, tags) +
      osm_relation(26, {"way 11 outer", "way 99 inner"}, tags) +
      osm_relation(27, {"way 11 outer"}, osm_tag("type", "site") + kBuilding) +
      osm_relation(28, {"way 11 outer"}, kBuilding) + osm_relation(29, {"way 11 "}, osm_tag("type", "route")));
  expect_problem(extract, relation_id(20), Kind::broken_multipolygon, false, " crosses way/1");
  expect_problem(extract, relation_id(21), Kind::broken_multipolygon, false, "the ring is open at 8.0");
  expect_problem(extract, relation_id(22), Kind::broken_multipolygon, true, "none of its members is a way");
  expect_problem(extract, relation_id(23), Kind::broken_multipolygon, true, "none of its members is a way");
  expect_problem(extract, relation_id(24), Kind::broken_multipolygon, true, "do not bound an area");
  expect_problem(extract, relation_id(25), Kind::missing_members, true, "1 of 1 ways is not in the file");
  expect_problem(extract, relation_id(26), Kind::missing_members, false, "1 of 2 ways is not in the file");
  expect_problem(extract, relation_id(27), Kind::broken_multipolygon, true, "its type is site, not multipolygon");
  expect_problem(extract, relation_id(28), Kind::broken_multipolygon, false, "without a type");
  EXPECT_EQ(extract.problems.size(), 9u);
  ASSERT_EQ(extract.areas.size(), 4u);
  EXPECT_EQ(extract.areas[0].id, relation_id(20));
  EXPECT_EQ(extract.areas[0].polygons.at(0).holes.size(), 1u) << "to be told that it is none";
  EXPECT_TRUE(extract.areas[1].polygons.at(0).incomplete);
  EXPECT_EQ(extract.areas[2].id, relation_id(26));
  EXPECT_EQ(extract.areas[3].id, relation_id(28));
}

TEST(OsmBuildingRelations, NameOutlinesAndParts) {
  const std::string type = osm_tag("type", "building");
  const Extract extract = extract_of(
      kNodes + osm_way(11, osm_ring(1), kBuilding) + osm_way(12, osm_ring(5), osm_tag("building:part", "yes")) +
      osm_relation(20, {"way 11 outline", "way 12 part", "way 99 part", "node 1 entrance", "relation 20 outline"},
                   type) +
      osm_relation(21, {"way 11 outline", "relation 23 part", "relation 24 part"}, type) +
      osm_relation(22, {"relation 22 part"}, type) +
      osm_relation(23, {"way 12 outer"}, kMultipolygon + osm_tag("building:part", "roof")));
  ASSERT_EQ(extract.building_relations.size(), 2u);
  const BuildingRelation& first = extract.building_relations[0];
  EXPECT_EQ(first.id, relation_id(20));
  EXPECT_EQ(first.outlines, std::vector<ObjectId>{way_id(11)});
  EXPECT_EQ(first.parts, std::vector<ObjectId>{way_id(12)});
  EXPECT_EQ(extract.building_relations[1].parts, std::vector<ObjectId>{relation_id(23)});
  expect_problem(extract, relation_id(20), Kind::missing_members, false,
                 "1 of 3 outlines and parts is not in the file");
  expect_problem(extract, relation_id(21), Kind::missing_members, false,
                 "1 of 3 outlines and parts is not in the file");
  expect_problem(extract, relation_id(22), Kind::degenerate, true, "neither an outline nor parts");
  // Without a role: what its tags say, or else an outline.
  const Extract roles = extract_of(
      kNodes + osm_way(11, osm_ring(1), kBuilding) + osm_way(12, osm_ring(5), osm_tag("building:part", "yes")) +
      osm_way(13, osm_ring(5), kBuilding) + osm_relation(20, {"way 11 ", "way 12 ", "way 13 outer"}, type));
  ASSERT_EQ(roles.building_relations.size(), 1u);
  EXPECT_EQ(roles.building_relations[0].outlines, (std::vector<ObjectId>{way_id(11), way_id(13)}));
  EXPECT_EQ(roles.building_relations[0].parts, std::vector<ObjectId>{way_id(12)});
}

TEST(OsmFixtures, HugeAreasAreRead) {
  VANTAGE_REQUIRE_SHARED("osm-fixtures/huge_areas.osm");
  const Extract extract = read_extract(testing::shared_data("osm-fixtures/huge_areas.osm"));
  EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
  ASSERT_EQ(extract.areas.size(), 3u);
  EXPECT_EQ(extract.areas[2].id, way_id(-111));
  EXPECT_GT(doubled_area(extract.areas[2].polygons[0].outer), 20);
}

TEST(OsmFixtures, HolesOfMultipolygonsAreHoles) {
  VANTAGE_REQUIRE_SHARED("osm-fixtures/mp_two_holes.osm");
  for (const std::string name : {"mp_two_holes", "mp_two_holes_advanced", "mp_two_holes_advanced2",
                                 "mp_two_holes_outer_tagged", "mp_two_holes_touching_inners"}) {
    SCOPED_TRACE(name);
    const Extract extract = read_extract(testing::shared_data("osm-fixtures/" + name + ".osm"));
    EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
    ASSERT_EQ(extract.areas.size(), 1u) << testing::describe(extract);
    ASSERT_EQ(extract.areas[0].polygons.size(), 1u);
    EXPECT_EQ(extract.areas[0].polygons[0].holes.size(), 2u);  // of three that touch, two have a side in common
  }
  const Extract broken = read_extract(testing::shared_data("osm-fixtures/mp_broken.osm"));
  expect_problem(broken, relation_id(-42), Kind::broken_multipolygon, false, "the ring is open");
}

}  // namespace
}  // namespace vantage::internal::osm
