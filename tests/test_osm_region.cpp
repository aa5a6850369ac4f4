// What a region takes and leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geo/local_frame.h"
#include "maps/osm/region_filter.h"
#include "support/osm_maps.h"
#include "support/random.h"
#include "support/shared_data.h"

namespace vantage::internal::osm {
namespace {

using testing::extract_of;
using testing::find_object;
using testing::osm_node;
using testing::osm_relation;
using testing::osm_ring;
using testing::osm_square;
using testing::osm_tag;
using testing::osm_way;
using testing::relation_id;
using testing::way_id;

const std::string kWholeBuilding = osm_tag("building", "yes"), kPart = osm_tag("building:part", "yes");

ReadOptions circle(LonLat centre, double radius_m) {
  ReadOptions options;
  options.region = Region{std::pair{centre, radius_m}, std::nullopt};
  return options;
}

ReadOptions box(double west, double south, double east, double north) {
  ReadOptions options;
  options.region = Region{std::nullopt, std::array{west, south, east, north}};
  return options;
}

/// Geodesics of the WGS 84 ellipsoid, by geod_inverse of PROJ 9.1.
TEST(OsmRegion, MeasuresOnTheEllipsoid) {
  struct Case {
    LonLat a, b;
    double metres, tolerance;
  };
  const std::vector<Case> cases = {{{8, 47}, {8.001, 47.001}, 134.69731, 1e-5},
                                   {{-73.9857, 40.7484}, {-73.9857, 40.7664}, 1998.88599, 2e-5},
                                   {{-73.9857, 40.7484}, {-73.9, 40.8}, 9229.24582, 2e-5},
                                   {{24, 60}, {24.1, 60.9}, 100428.80730, 0.01},
                                   {{0, 0}, {1, 0}, 111319.49079, 0.01},
                                   {{179.5, 0}, {-179.5, 0}, 111319.49079, 0.01},
                                   {{0, 89.999}, {180, 89.999}, 223.38796, 1e-5},
                                   {{-74, 40.7}, {24.9, 60.2}, 6634067.50157, 33000},
                                   {{0, 0}, {0, 90}, 10001965.72931, 50000}};
  for (const Case& one : cases) {
    EXPECT_NEAR(distance_m(one.a, one.b), one.metres, one.tolerance);
    EXPECT_DOUBLE_EQ(distance_m(one.a, one.b), distance_m(one.b, one.a));
  }
  EXPECT_EQ(distance_m({8, 47}, {8, 47}), 0);
}

TEST(OsmRegion, TakesAnObjectWholeWhenOneOfItsPositionsIsInside) {
  // Three squares of 0.001 degrees in a row, 0.01 degrees apart; a circle about the corner of the second one.
  const std::string content = osm_square(1, 8.00, 47, 0.001) + osm_square(5, 8.01, 47, 0.001) +
                              osm_square(9, 8.02, 47, 0.001) + osm_node(20, 8.0101, 47, kWholeBuilding) +
                              osm_node(21, 8.03, 47, kWholeBuilding) + osm_way(31, osm_ring(1), kWholeBuilding) +
                              osm_way(32, osm_ring(5), kWholeBuilding) + osm_way(33, osm_ring(9), kWholeBuilding) +
                              osm_way(34, {3, 5}, osm_tag("barrier", "wall"));
  const Extract extract = extract_of(content, circle({8.01, 47}, 20));
  ASSERT_EQ(extract.areas.size(), 1u) << testing::describe(extract);
  EXPECT_EQ(extract.areas[0].id, way_id(32));
  EXPECT_EQ(extract.areas[0].polygons[0].outer.size(), 4u);
  ASSERT_EQ(extract.lines.size(), 1u);
  ASSERT_EQ(extract.points.size(), 1u);
  EXPECT_EQ(extract.outside, 3u);
  EXPECT_NEAR(extract.nearest_outside_m, distance_m({8.01, 47}, {8.001, 47}), 0.01);
  EXPECT_EQ(extract.bounds_deg, (std::array<double, 4>{8, 47, 8.03, 47.001}));  // of all of the file
  EXPECT_EQ(extract.nodes, 14u);

  // Just short of the nearest one, and just as far.
  const double gap = extract.nearest_outside_m;
  EXPECT_EQ(extract_of(content, circle({8.01, 47}, gap - 0.01)).areas.size(), 1u);
  EXPECT_EQ(extract_of(content, circle({8.01, 47}, gap + 0.01)).areas.size(), 2u);

  const Extract boxed = extract_of(content, box(8.0005, 46.9, 8.015, 47.0005));
  EXPECT_EQ(boxed.areas.size(), 2u);
  EXPECT_EQ(boxed.outside, 2u);
  EXPECT_EQ(boxed.points.size(), 1u);
  const Extract nothing = extract_of(content, box(9, 48, 9.1, 48.1));
  EXPECT_TRUE(nothing.areas.empty() && nothing.lines.empty() && nothing.points.empty());
  EXPECT_EQ(nothing.outside, 6u);
  EXPECT_NEAR(nothing.nearest_outside_m, distance_m({9.05, 48.05}, {8.03, 47}), 1e-6);
}

/// A slab of 0.004 by 0.0002 degrees, 303 by 22 m, whose corners are all far from the middle of its long sides.
TEST(OsmRegion, TakesWhatReachesInWithoutACorner) {
  const std::string slab = osm_node(1, 8.000, 47.0000) + osm_node(2, 8.004, 47.0000) + osm_node(3, 8.004, 47.0002) +
                           osm_node(4, 8.000, 47.0002);
  const std::string content =
      slab + osm_way(31, osm_ring(1), kWholeBuilding) + osm_way(32, {1, 2}, osm_tag("barrier", "wall"));
  const LonLat beside{8.002, 46.9999};
  const double gap = distance_m(beside, {8.002, 47});
  const Extract near = extract_of(content, circle(beside, gap + 0.01));
  EXPECT_EQ(near.areas.size(), 1u);
  EXPECT_EQ(near.lines.size(), 1u);
  const Extract far = extract_of(content, circle(beside, gap - 0.01));
  EXPECT_TRUE(far.areas.empty() && far.lines.empty());
  EXPECT_NEAR(far.nearest_outside_m, gap, 0.001);

  const Extract across = extract_of(content, box(8.001, 46.9999, 8.0011, 47.1));
  EXPECT_EQ(across.areas.size(), 1u);
  EXPECT_EQ(across.lines.size(), 1u);
  const Extract past = extract_of(content, box(8.001, 46.9998, 8.0011, 46.9999));
  EXPECT_EQ(past.outside, 2u);
}

TEST(OsmRegion, TakesAreasThatGoRoundIt) {
  const std::string content =
      osm_square(1, 8, 47, 0.01) + osm_square(5, 8.004, 47.004, 0.002) + osm_way(31, osm_ring(1)) +
      osm_way(34, osm_ring(1), kWholeBuilding) + osm_way(32, osm_ring(1), osm_tag("barrier", "wall")) +
      osm_way(33, osm_ring(5)) +
      osm_relation(40, {"way 31 outer", "way 33 inner"}, osm_tag("type", "multipolygon") + kPart);
  const Extract in_hole = extract_of(content, circle({8.005, 47.005}, 20));
  EXPECT_NE(find_object(in_hole.areas, way_id(34)), nullptr);
  // What is made of rings is known when they are assembled: a courtyard, or a line that goes round, comes along.
  EXPECT_NE(find_object(in_hole.areas, relation_id(40)), nullptr);
  EXPECT_EQ(in_hole.outside, 0u);
  const Extract in_ring = extract_of(content, box(8.002, 47.002, 8.0021, 47.0021));
  EXPECT_NE(find_object(in_ring.areas, relation_id(40)), nullptr);
}

/// No rectangle about some positions, in any direction, has a corner in a region that their box does not reach.
TEST(OsmRegion, ABoxHoldsTurnedRectangles) {
  testing::Random random(7);
  std::size_t inside = 0, beyond = 0;
  for (const LonLat centre : {LonLat{8, 47}, LonLat{179.9999, -20}, LonLat{10, 89.9}}) {
    const geo::LocalFrame frame(centre);
    Region region;
    region.circle = {centre, 100};
    const RegionFilter filter(region);
    EXPECT_FALSE(filter.meets_box_of({}, true));
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector2d from(random.uniform(-600, 600), random.uniform(-600, 600));
      std::vector<LonLat> positions;
      const double angle = random.uniform(0, 3), sine = std::sin(angle), cosine = std::cos(angle);
      Eigen::Matrix2d turn;
      turn << cosine, sine, -sine, cosine;
      Eigen::Vector2d low = Eigen::Vector2d::Constant(HUGE_VAL), high = -low;
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d at = from + Eigen::Vector2d(random.uniform(-200, 200), random.uniform(-200, 200));
        positions.push_back(frame.to_lonlat(at));
        low = low.cwiseMin(turn * at);
        high = high.cwiseMax(turn * at);
      }
      bool reaches = false;
      for (const Eigen::Vector2d& corner :
           {low, high, Eigen::Vector2d(low.x(), high.y()), Eigen::Vector2d(high.x(), low.y())}) {
        reaches |= corner.norm() < 99.5;
      }
      const bool is_met = filter.meets_box_of(positions, true);
      EXPECT_TRUE(is_met || !reaches) << i;
      inside += reaches;
      beyond += !is_met;
    }
  }
  EXPECT_GT(inside, 200u);
  EXPECT_GT(beyond, 1000u);
}

TEST(OsmRegion, MayLieOverTheDateLine) {
  const std::string content = osm_node(1, 179.9999, 0, kWholeBuilding) + osm_node(2, -179.9999, 0, kWholeBuilding) +
                              osm_node(3, 179.99, 0, kWholeBuilding) + osm_node(4, 0, 0, kWholeBuilding);
  EXPECT_EQ(extract_of(content, circle({180, 0}, 20)).points.size(), 2u);
  EXPECT_EQ(extract_of(content, circle({-180, 0}, 20)).points.size(), 2u);
  const Extract extract = extract_of(content, box(179.995, -1, -179.995, 1));
  EXPECT_EQ(extract.points.size(), 2u);
  EXPECT_NEAR(extract.nearest_outside_m, 0.01 * 111319.49, 0.1);
}

TEST(OsmRegion, TakesMultipolygonsAndBuildingsTogether) {
  const std::string content =
      osm_square(1, 8, 47, 0.001) + osm_square(5, 8.01, 47, 0.001) + osm_square(9, 8.002, 47, 0.001) +
      osm_way(31, osm_ring(1), kWholeBuilding) + osm_way(32, osm_ring(5)) + osm_way(33, osm_ring(9), kPart) +
      osm_relation(40, {"way 31 outline", "way 33 part"}, osm_tag("type", "building")) +
      osm_relation(41, {"way 31 outer", "way 32 outer"}, osm_tag("type", "multipolygon") + osm_tag("landuse", "x"));
  const Extract extract = extract_of(content, circle({8, 47}, 20));
  EXPECT_NE(find_object(extract.areas, way_id(31)), nullptr);
  EXPECT_NE(find_object(extract.areas, way_id(33)), nullptr);  // its outline is inside
  ASSERT_NE(find_object(extract.areas, relation_id(41)), nullptr);
  EXPECT_EQ(find_object(extract.areas, relation_id(41))->polygons.size(), 2u);
  EXPECT_EQ(extract.building_relations.size(), 1u);
  EXPECT_EQ(extract.outside, 0u);
  const Extract other = extract_of(content, circle({8.01, 47}, 20));
  EXPECT_EQ(other.areas.size(), 1u);
  EXPECT_TRUE(other.building_relations.empty());
  EXPECT_EQ(other.outside, 2u);
}

TEST(OsmRegion, WhatIsBrokenOutsideIsNoProblem) {
  const std::string content = osm_square(1, 8, 47, 0.001) + osm_square(5, 9, 47, 0.001) +
                              osm_way(31, osm_ring(1), kWholeBuilding) + osm_way(32, {5, 7, 6, 8, 5}, kWholeBuilding) +
                              osm_relation(40, {"way 32 outer"}, osm_tag("type", "multipolygon") + kPart) +
                              osm_relation(41, {"way 32 outer"}, osm_tag("type", "site") + kPart);
  EXPECT_EQ(extract_of(content).problems.size(), 3u);
  const Extract extract = extract_of(content, circle({8, 47}, 20));
  EXPECT_EQ(extract.problems.size(), 0u) << testing::describe(extract);
  EXPECT_EQ(extract.outside, 3u);
}

TEST(OsmRegion, RefusesRegionsThatAreNone) {
  const double nan = std::nan("");
  const std::string content = osm_node(1, 8, 47);
  for (const ReadOptions& options :
       {circle({8, 47}, 0), circle({8, 47}, -1), circle({8, 47}, nan), circle({8, 47}, HUGE_VAL), circle({181, 47}, 5),
        circle({8, 91}, 5), circle({nan, 47}, 5), box(8, 47, 8, 48), box(8, 48, 9, 47), box(8, 47, 9, 47),
        box(8, nan, 9, 48), box(8, 47, 200, 48)}) {
    try {
      extract_of(content, options);
      ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      EXPECT_EQ(error.where(), "the region");
    }
  }
}

/// Every object of the whole map is either in the part or counted as outside. None is left out that has a corner in it;
/// of the others few are taken, those whose box reaches in.
TEST(OsmRegion, PartAndRestMakeTheWholeMap) {
  VANTAGE_REQUIRE_SHARED("osm/new-york-unsorted.osm.pbf");
  const std::filesystem::path map = testing::shared_data("osm/new-york-unsorted.osm.pbf");
  const Extract whole = read_extract(map);
  const LonLat centre = whole.areas.at(whole.areas.size() / 2).polygons[0].outer[0];
  ASSERT_TRUE(whole.building_relations.empty());  // whose members go together
  for (const double radius : {50., 200., 400.}) {
    const Extract part = read_extract(map, circle(centre, radius));
    std::size_t inside = 0;
    for (const Area& area : whole.areas) {
      double nearest = HUGE_VAL;
      for (const Polygon& polygon : area.polygons) {
        for (const LonLat at : polygon.outer) nearest = std::min(nearest, distance_m(centre, at));
        for (const Ring& hole : polygon.holes) {
          for (const LonLat at : hole) nearest = std::min(nearest, distance_m(centre, at));
        }
      }
      inside += nearest <= radius;
      const bool is_taken = find_object(part.areas, area.id) != nullptr;
      EXPECT_TRUE(is_taken || nearest > radius) << text(area.id);
      EXPECT_TRUE(is_taken || part.nearest_outside_m <= nearest + 1e-6);
    }
    EXPECT_GE(part.areas.size(), inside);
    EXPECT_LE(part.areas.size(), inside + 10 + inside / 10);
    EXPECT_GT(inside, 3u);
    EXPECT_GT(part.nearest_outside_m, radius);
    std::set<ObjectId> left_out;  // an object may be both an area and a line
    for (const Area& area : whole.areas) {
      if (find_object(part.areas, area.id) == nullptr) left_out.insert(area.id);
    }
    for (const Line& line : whole.lines) {
      if (find_object(part.lines, line.id) == nullptr) left_out.insert(line.id);
    }
    for (const Point& point : whole.points) {
      if (find_object(part.points, point.id) == nullptr) left_out.insert(point.id);
    }
    for (const Problem& problem : whole.problems) {
      if (problem.lost && testing::find_problem(part, problem.object) == nullptr) left_out.insert(problem.object);
    }
    EXPECT_EQ(part.outside, left_out.size()) << radius;
  }
}

}  // namespace
}  // namespace vantage::internal::osm
