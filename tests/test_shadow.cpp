// Shadows on a target's plane, and what they leave of it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "query/measure.h"
#include "query/shadow.h"
#include "support/internals.h"
#include "support/random.h"

namespace vantage {
namespace {

using query::Pieces;
using query::Point2;
using query::Shadows;
using testing::Random;

const std::vector<Point2> kSquare = {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}};

double area_of(const Pieces& pieces) {
  const query::Measure measure(FractionMeasure::area, kSquare, {0, 0, 1});
  double sum = 0;
  for (std::size_t i = 0; i < pieces.count(); ++i) sum += measure.of(pieces[i]);
  return sum;
}

/// A sheet over the square, torn along a jagged net into triangles that share corners and edges; some edges have a
/// corner of the next triangle between their ends.
std::vector<std::vector<Vec3>> tiles(Random& random, bool with_corners_on_edges) {
  constexpr int kCount = 9;
  const Vec3 right = Vec3(1, 0.1, random.uniform(-0.1, 0.1)).normalized(), ahead = Vec3(-0.1, 1, 0.07).normalized();
  std::vector<std::vector<Vec3>> corners(kCount, std::vector<Vec3>(kCount));
  for (int i = 0; i < kCount; ++i) {
    for (int j = 0; j < kCount; ++j) {
      const double to_right = i - 4 + random.uniform(-0.4, 0.4), to_front = j - 4 + random.uniform(-0.4, 0.4);
      corners[i][j] = Vec3(0, 0, 9) + to_right * 3 * right + to_front * 3 * ahead;
    }
  }
  std::vector<std::vector<Vec3>> result;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if (with_corners_on_edges && random.chance(0.5)) {
      const Vec3 between = a + random.uniform(0.1, 0.9) * (b - a);
      result.push_back({a, between, c});
      result.push_back({between, c, b});
    } else {
      result.push_back({a, b, c});
    }
  };
  for (int i = 0; i + 1 < kCount; ++i) {
    for (int j = 0; j + 1 < kCount; ++j) {
      add(corners[i][j], corners[i + 1][j], corners[i + 1][j + 1]);
      add(corners[i + 1][j + 1], corners[i][j + 1], corners[i][j]);
    }
  }
  return result;
}

TEST(Shadows, OfNeighboursLeaveNoGaps) {
  Random random(21);
  for (int round = 0; round < 400; ++round) {
    const double scale = std::pow(10.0, random.integer(-3, 4));
    std::vector<Point2> target = kSquare;
    for (Point2& t : target) t *= scale;
    Shadows shadows;
    const double x = random.uniform(-3, 3), y = random.uniform(-3, 3);  // in this order with every compiler
    shadows.begin(target, scale * Vec3(x, y, random.uniform(15, 60)));
    std::uint32_t name = 0;
    bool is_any_left = true;
    for (std::vector<Vec3> tile : tiles(random, round % 2 == 1)) {
      for (Vec3& corner : tile) corner *= scale;
      is_any_left = shadows.add(tile, name++) && is_any_left;
    }
    EXPECT_TRUE(is_any_left) << "no tile hides all alone";
    // Where many edges meet, a piece as large as the rounding of its corners may be left.
    EXPECT_LE(area_of(shadows.seen()), 1e-25 * scale * scale) << round;
  }
}

TEST(Shadows, TheirOrderChangesNoBit) {
  Random random(22);
  int lit = 0;
  for (int round = 0; round < 50; ++round) {
    std::vector<std::vector<Vec3>> triangles;
    for (int i = 0; i < 25; ++i) {
      const double x = random.uniform(-6, 6), y = random.uniform(-6, 6);  // in this order with every compiler
      const Vec3 o(x, y, random.uniform(2, 25)), to_b = 2 * random.point(0, 1), to_c = 2 * random.point(-1, 0);
      triangles.push_back({o, o + to_b, o + to_c});
      if (i % 3 == 0) triangles.push_back(triangles.back());
    }
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<std::vector<Point2>> first;
    for (int turn = 0; turn < 3; ++turn) {
      Shadows shadows;
      shadows.begin(kSquare, {1, 2, 20});
      for (const std::uint32_t i : order) shadows.add(triangles[i], i);
      const Pieces& seen = shadows.seen();
      std::vector<std::vector<Point2>> pieces;
      for (std::size_t i = 0; i < seen.count(); ++i) pieces.emplace_back(seen[i].begin(), seen[i].end());
      if (turn == 0) first = pieces;
      EXPECT_EQ(pieces, first);
      for (std::size_t i = order.size() - 1; i > 0; --i) {
        std::swap(order[i], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
      }
    }
    lit += first.size() > 1;
  }
  EXPECT_GT(lit, 40);  // a triangle next to the eye may hide all
}

// Merged polygons are planar to rounding only. From beside them an eye sees no convex outline, but what their triangles
// hide is sure. Drawn with bumps of millimetres, to tell the two apart.
TEST(Shadows, OfABumpyPolygonSeenAlongIt) {
  Random random(23);
  int bumpy = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3> polygon;
    for (int k = 0; k < 8; ++k) {
      const double angle = k * std::numbers::pi / 4;
      polygon.emplace_back(random.uniform(-1e-3, 1e-3), 6 + 3 * std::cos(angle), 9 + 3 * std::sin(angle));
    }
    const Vec3 eye(random.uniform(-1e-3, 1e-3), 14,
                   random.uniform(14, 20));  // the square is on both sides of the plane
    Shadows whole, apart;
    whole.begin(kSquare, eye);
    apart.begin(kSquare, eye);
    whole.add(polygon, 0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      apart.add(std::vector{polygon[0], polygon[k], polygon[k + 1]}, static_cast<std::uint32_t>(k));
    }
    const double of_whole = area_of(whole.seen()), of_triangles = area_of(apart.seen());
    EXPECT_NEAR(of_whole, of_triangles, 1e-12);
    bumpy += of_triangles < 100 - 1e-4;
  }
  EXPECT_GT(bumpy, 200);
}

TEST(Shadows, OfAPolygonSeenFromItsEdgeAreNone) {
  for (const Vec3& eye : {Vec3(0, 14, 20), Vec3(0, 6, 20), Vec3(0, 1, 15)}) {  // the last is on an edge's line
    Shadows shadows;
    shadows.begin(kSquare, eye);
    EXPECT_TRUE(shadows.add(std::vector<Vec3>{{0, 1, 5}, {0, 8, 5}, {0, 8, 12}, {0, 1, 12}}, 0));
    EXPECT_EQ(area_of(shadows.seen()), 100);
  }
}

}  // namespace
}  // namespace vantage
