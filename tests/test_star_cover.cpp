// Star-shaped targets of several parts, covered by convex polygons about one point: nothing is lost, nothing is added.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/internals.h"
#include "support/random.h"
#include "target/star_cover.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using target::star_cover;
using target::StarCover;
using testing::Random;
using Polygon = std::vector<Vector2d>;

/// How far a point lies inside a convex polygon; negative outside.
double depth_inside(const Polygon& polygon, const Vector2d& point) {
  double depth = INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d edge = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized(), to = point - polygon[i];
    depth = std::min(depth, edge.x() * to.y() - edge.y() * to.x());
  }
  return depth;
}

double depth_in_any(const std::vector<Polygon>& polygons, const Vector2d& point) {
  double depth = -INFINITY;
  for (const Polygon& polygon : polygons) depth = std::max(depth, depth_inside(polygon, point));
  return depth;
}

Vector2d point_of(Random& random, const Polygon& polygon) {
  Vector2d sum(0, 0);
  double weights = 0;
  for (const Vector2d& corner : polygon) {
    const double weight = std::pow(random.uniform(0, 1), 6);  // often next to a corner, or to an edge
    sum += weight * corner;
    weights += weight;
  }
  return sum / weights;
}

double extent_of(const std::vector<Polygon>& polygons) {
  double extent = 0;
  for (const Polygon& polygon : polygons) {
    for (const Vector2d& corner : polygon) extent = std::max(extent, corner.cwiseAbs().maxCoeff());
  }
  return extent;
}

/// Points of a cover that lie between two parts that touch are as near to these as rounding leaves them.
void expect_covers(const std::vector<Polygon>& parts, const StarCover& cover, Random& random) {
  const double extent = extent_of(parts), rounding = 1e-12 * extent, growth = 1.1 * target::kMostStarGrowth * extent;
  for (const Polygon& polygon : cover.polygons) EXPECT_GT(depth_inside(polygon, cover.centre), 0);
  for (const Polygon& part : parts) {
    for (const Vector2d& corner : part) EXPECT_GE(depth_in_any(cover.polygons, corner), -rounding);
    for (int i = 0; i < 50; ++i) EXPECT_GE(depth_in_any(cover.polygons, point_of(random, part)), -rounding);
  }
  for (const Polygon& polygon : cover.polygons) {
    for (const Vector2d& corner : polygon) {
      EXPECT_GE(depth_in_any(parts, corner), -growth);
      EXPECT_GE(depth_inside(cover.hull, corner), -growth);
    }
    for (int i = 0; i < 100; ++i) EXPECT_GE(depth_in_any(parts, point_of(random, polygon)), -growth);
  }
}

/// Triangles between a point and the edges of an outline that it sees all of.
std::vector<Polygon> fan(const Polygon& outline, const Vector2d& centre) {
  std::vector<Polygon> parts;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    parts.push_back({centre, outline[i], outline[(i + 1) % outline.size()]});
  }
  return parts;
}

TEST(StarCover, OfAnLIsItsTwoBars) {
  const std::vector<Polygon> parts = {{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, {{0, 4}, {3, 4}, {3, 15}, {0, 15}}};
  const auto cover = star_cover(parts);
  ASSERT_TRUE(cover.has_value());
  ASSERT_EQ(cover->polygons.size(), 2U);
  EXPECT_NEAR((cover->centre - Vector2d(1.5, 2)).norm(), 0, 1e-12);
  for (const Polygon& polygon : cover->polygons) EXPECT_EQ(polygon.size(), 4U);
  EXPECT_EQ(cover->hull.size(), 5U);
  Random random(5101);
  expect_covers(parts, *cover, random);
}

TEST(StarCover, JoinsPartsOfAConvexPolygon) {
  Polygon outline;
  constexpr int kCorners = 60;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    outline.emplace_back(20 * std::cos(angle), 12 * std::sin(angle));
  }
  const std::vector<Polygon> parts = fan(outline, {1, 2});
  const auto cover = star_cover(parts);
  ASSERT_TRUE(cover.has_value());
  EXPECT_EQ(cover->polygons.size(), 1U);
  EXPECT_EQ(cover->polygons[0].size(), outline.size());
}

TEST(StarCover, KnowsSidesThatMeetInTheirMiddle) {
  // The edge between the upper two and the lower one is cut on one side only.
  const std::vector<Polygon> parts = {
      {{0, 0}, {10, 0}, {10, 4}, {0, 4}}, {{1, 4}, {3, 4}, {3, 9}, {1, 9}}, {{3, 4}, {6, 4}, {6, 7}, {3, 7}}};
  const auto cover = star_cover(parts);
  ASSERT_TRUE(cover.has_value());
  Random random(5102);
  expect_covers(parts, *cover, random);
}

TEST(StarCover, IsNoneOfWhatNoPointSeesAllOf) {
  const Polygon bar = {{0, 0}, {10, 0}, {10, 1}, {0, 1}};
  const auto moved = [](Polygon polygon, double x, double y) {
    for (Vector2d& corner : polygon) corner += Vector2d(x, y);
    return polygon;
  };
  const Polygon post = {{0, 0}, {1, 0}, {1, 5}, {0, 5}};
  EXPECT_FALSE(star_cover({bar, moved(post, 0, 1), moved(post, 9, 1)})) << "a U";
  EXPECT_FALSE(star_cover({bar, moved(bar, 0, 3)})) << "two bars";
  EXPECT_FALSE(star_cover({bar, moved(post, 0, 1), moved(post, 9, 1), moved(bar, 0, 6)})) << "a ring";
  EXPECT_FALSE(star_cover({bar, moved(bar, 10, 1)})) << "bars that touch in a corner";
}

// Outlines with corners at any distance from a middle, in fans about it: at most scales, far from the origin, too.
TEST(StarCover, LosesAndAddsNothing) {
  Random random(5103);
  int covered = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const double size = std::pow(10, random.uniform(-6, 4));
    const Vector2d at = random.integer(0, 1) > 0 ? Vector2d(0, 0) : Vector2d(size * random.uniform(-3, 3), 0);
    const int corners = random.integer(5, 40);
    Polygon outline;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.4)) / corners;
      outline.push_back(at + size * random.uniform(0.4, 1) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    const std::vector<Polygon> parts = fan(outline, at);
    const auto cover = star_cover(parts);
    if (!cover) continue;
    ++covered;
    EXPECT_LE(cover->polygons.size(), parts.size());
    expect_covers(parts, *cover, random);
  }
  EXPECT_GT(covered, 200);
}

// Corners that rounding has moved apart: parts come out of frames of their own.
TEST(StarCover, BearsRounding) {
  Random random(5104);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    std::vector<Polygon> parts = {
        {{0, 0}, {10, 0}, {10, 4}, {0, 4}}, {{0, 4}, {3, 4}, {3, 15}, {0, 15}}, {{0, -6}, {4, -6}, {4, 0}, {0, 0}}};
    const double turn = random.uniform(0, 7), rounding = std::pow(10, random.uniform(-15, -10));
    for (Polygon& part : parts) {
      for (Vector2d& corner : part) {
        corner = Vector2d(std::cos(turn) * corner.x() - std::sin(turn) * corner.y(),
                          std::sin(turn) * corner.x() + std::cos(turn) * corner.y());
        corner += rounding * Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
      }
    }
    const auto cover = star_cover(parts);
    ASSERT_TRUE(cover.has_value());
    EXPECT_LE(cover->polygons.size(), 3U);
    expect_covers(parts, *cover, random);
  }
}

}  // namespace
}  // namespace vantage
