// Convex pieces joined to polygons with holes, the narrowest cone, and what is written of seen parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "query/join_pieces.h"
#include "query/measure.h"
#include "support/internals.h"
#include "support/random.h"
#include "vantage/fraction.h"
#include "vantage/georeference.h"

namespace vantage {
namespace {

using query::JoinedPolygon;
using query::Pieces;
using query::Point2;
using query::Ring;

void add_square(Pieces& pieces, double x, double y, double size = 1) {
  pieces.add(Ring{{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}});
}

double ring_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Every corner once, no corner on the line between those beside it.
void expect_proper(const Ring& ring) {
  ASSERT_GE(ring.size(), 3U);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT((ring[i] - ring[k]).norm(), 1e-6);
    const Point2 in = ring[i] - ring[(i + ring.size() - 1) % ring.size()], out = ring[(i + 1) % ring.size()] - ring[i];
    EXPECT_GT(std::abs(in.x() * out.y() - in.y() * out.x()), 1e-9);
  }
}

TEST(JoinPieces, SquaresSideBySideAreOne) {
  Pieces pieces;
  add_square(pieces, 0, 0, 2);
  add_square(pieces, 2, 0);
  add_square(pieces, 2, 1 + 1e-12);  // rounding
  add_square(pieces, -1, 0.5);       // its corners lie on an edge
  const auto joined = query::join_pieces(pieces, 1e-9);
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_TRUE(joined[0].holes.empty());
  EXPECT_EQ(joined[0].outer.size(), 8U);
  EXPECT_NEAR(ring_area(joined[0].outer), 7, 1e-9);
  expect_proper(joined[0].outer);
}

TEST(JoinPieces, NothingOfNothing) { EXPECT_TRUE(query::join_pieces(Pieces(), 1e-9).empty()); }

TEST(JoinPieces, ThoseThatTouchInACornerStayApart) {
  Pieces pieces;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      if ((x + y) % 2 == 0) add_square(pieces, x, y);
    }
  }
  const auto joined = query::join_pieces(pieces, 1e-9);
  EXPECT_EQ(joined.size(), 8U);
  for (const JoinedPolygon& polygon : joined) {
    EXPECT_EQ(polygon.outer.size(), 4U);
    EXPECT_TRUE(polygon.holes.empty());
  }
}

TEST(JoinPieces, HolesMayTouchTheRingAndEachOther) {
  Pieces pieces;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      const bool is_hole =
          (x == 1 && y == 1) || (x == 2 && y == 2) || (x == 4 && y == 4) || (x == 5 && y == 5) || (x == 3 && y == 1);
      if (!is_hole) add_square(pieces, x, y);
    }
  }
  const auto joined = query::join_pieces(pieces, 1e-9);
  ASSERT_EQ(joined.size(), 1U);
  double sum = ring_area(joined[0].outer);
  expect_proper(joined[0].outer);
  for (const Ring& hole : joined[0].holes) {
    EXPECT_LT(ring_area(hole), 0);
    expect_proper(hole);
    sum += ring_area(hole);
  }
  EXPECT_EQ(joined[0].holes.size(), 4U) << "the corner is no hole";
  EXPECT_NEAR(sum, 31, 1e-9);
}

TEST(JoinPieces, IslandsInHolesHaveHolesOfTheirOwn) {
  Pieces pieces;
  for (int x = 0; x < 9; ++x) {
    for (int y = 0; y < 9; ++y) {
      const int ring = std::max(std::abs(x - 4), std::abs(y - 4));
      if (ring % 2 == 0 && ring > 0) add_square(pieces, x, y);
    }
  }
  auto joined = query::join_pieces(pieces, 1e-9);
  ASSERT_EQ(joined.size(), 2U);
  std::vector<double> areas;
  for (const JoinedPolygon& polygon : joined) {
    ASSERT_EQ(polygon.holes.size(), 1U);
    areas.push_back(ring_area(polygon.outer) + ring_area(polygon.holes[0]));
  }
  std::sort(areas.begin(), areas.end());
  EXPECT_NEAR(areas[0], 16, 1e-9);
  EXPECT_NEAR(areas[1], 32, 1e-9);
}

TEST(NarrowestCone, IsThatOfAllPairsAndTriples) {
  testing::Random random(3);
  for (int round = 0; round < 300; ++round) {
    const int count = random.integer(1, 9);
    const double height = std::pow(10.0, random.uniform(-3, 4));
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
      directions.push_back(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), -height).normalized());
      if (random.chance(0.1)) directions.push_back(directions.front());
    }
    const auto chord_of = [&](const Vec3& axis) {
      double most = 0;
      for (const Vec3& d : directions) most = std::max(most, (d - axis).norm());
      return most;
    };
    double least = 9;
    const auto offer = [&](const Vec3& sum) {
      if (sum.norm() > 0) least = std::min({least, chord_of(sum.normalized()), chord_of(-sum.normalized())});
    };
    for (const Vec3& a : directions) {
      for (const Vec3& b : directions) {
        offer(a + b);
        for (const Vec3& c : directions) offer((b - a).cross(c - a));
      }
    }
    EXPECT_NEAR(chord_of(query::narrowest_cone_axis(directions)), least, 1e-14 + 1e-7 * least)
        << round << " at " << height;
  }
}

PointFraction seen_square() {
  PointFraction answer;
  answer.fraction = 0.75;
  answer.seen = {
      {{{0, 0, 5}, {40, 0, 5}, {40, 40, 5}, {0, 40, 5}}, {{{10, 10, 5}, {10, 30, 5}, {30, 30, 5}, {30, 10, 5}}}}};
  return answer;
}

/// Of a ring of positions.
double turn_of_ring(const nlohmann::json& ring) {
  Ring points;
  for (const auto& position : ring) points.emplace_back(position[0].get<double>(), position[1].get<double>());
  EXPECT_EQ(ring.front(), ring.back());
  points.pop_back();
  return ring_area(points);
}

TEST(SeenGeoJson, IsACollectionOfOneFeatureAPoint) {
  SeenGeoJson writer(std::nullopt, FractionMeasure::solid_angle);
  PointFraction dark, two = seen_square();
  two.seen.push_back(two.seen[0]);
  std::string text = writer.beginning();
  text += writer.feature(seen_square(), "P 7");
  text += writer.feature(dark);
  text += writer.feature(two, "\xff");
  const auto json = nlohmann::json::parse(text + writer.end());
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["coordinate_frame"], "scene, metres");
  ASSERT_EQ(json["features"].size(), 3U);
  const auto& first = json["features"][0];
  EXPECT_EQ(first["type"], "Feature");
  EXPECT_EQ(first["id"], "P 7");
  EXPECT_EQ(first["properties"], nlohmann::json({{"index", 0}, {"measure", "solid_angle"}, {"fraction", 0.75}}));
  EXPECT_EQ(first["geometry"]["type"], "Polygon");
  ASSERT_EQ(first["geometry"]["coordinates"].size(), 2U);
  EXPECT_EQ(turn_of_ring(first["geometry"]["coordinates"][0]), 1600);
  EXPECT_EQ(turn_of_ring(first["geometry"]["coordinates"][1]), -400);
  EXPECT_EQ(first["geometry"]["coordinates"][0][0], nlohmann::json({0, 0, 5}));
  EXPECT_TRUE(json["features"][1]["geometry"].is_null());
  EXPECT_FALSE(json["features"][1].contains("id"));
  EXPECT_EQ(json["features"][1]["properties"]["index"], 1);
  EXPECT_EQ(json["features"][2]["geometry"]["type"], "MultiPolygon");
  EXPECT_EQ(json["features"][2]["geometry"]["coordinates"].size(), 2U);
  SeenGeoJson none(std::nullopt, FractionMeasure::area);
  EXPECT_EQ(nlohmann::json::parse(none.beginning() + none.end())["features"].size(), 0U);
}

TEST(SeenGeoJson, TurnsRingsOfCeilingsForTheMap) {
  PointFraction answer = seen_square();  // as a target that looks down has it
  std::reverse(answer.seen[0].outer.begin(), answer.seen[0].outer.end());
  std::reverse(answer.seen[0].holes[0].begin(), answer.seen[0].holes[0].end());
  SeenGeoJson writer(std::nullopt, FractionMeasure::area);
  const auto json = nlohmann::json::parse(writer.beginning() + writer.feature(answer) + writer.end());
  EXPECT_EQ(turn_of_ring(json["features"][0]["geometry"]["coordinates"][0]), 1600);
  EXPECT_EQ(turn_of_ring(json["features"][0]["geometry"]["coordinates"][1]), -400);
}

TEST(SeenGeoJson, SaysWhereOnTheEarth) {
  const Georeference place{48.1, 11.5, "NAP height", "EPSG:7415"};
  SeenGeoJson writer(place, FractionMeasure::area);
  const auto json = nlohmann::json::parse(writer.beginning() + writer.feature(seen_square()) + writer.end());
  EXPECT_EQ(json["coordinate_frame"], "WGS 84, z of the scene");
  EXPECT_EQ(json["georeference"]["vertical"], "NAP height");
  const PointFraction answer = seen_square();
  const auto& ring = json["features"][0]["geometry"]["coordinates"][0];
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d back = scene_position(place, ring[i][0], ring[i][1]);
    EXPECT_NEAR((back - answer.seen[0].outer[i].head<2>()).norm(), 0, 1e-7);
    EXPECT_EQ(ring[i][2], 5);
  }
}

}  // namespace
}  // namespace vantage
