// The intersection of the balls about a target's vertices, against trying all of them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random.h"
#include "target/range_region.h"

namespace vantage::testing {
namespace {

using Eigen::Vector2d;
using internal::target::RangeRegion;

/// Vertices on an ellipse about a point near the origin: evenly spread, at random, or many of them close together.
std::vector<Vector2d> draw_polygon(Random& random) {
  const int count = random.chance(0.3) ? 64 : random.integer(3, 40), kind = random.integer(0, 2);
  const double wide = std::pow(10, random.uniform(-2, 0.5)), narrow = random.chance(0.3) ? wide : 0.1 * wide;
  std::vector<double> angles;
  for (int k = 0; k < count; ++k) {
    angles.push_back(kind == 0                         ? 2 * std::numbers::pi * k / count
                     : kind == 1 || random.chance(0.5) ? random.uniform(0, 2 * std::numbers::pi)
                                                       : random.uniform(1, 1.001));
  }
  std::sort(angles.begin(), angles.end());
  const Vector2d middle(random.uniform(-0.3, 0.3) * wide, random.uniform(-0.3, 0.3) * narrow);
  std::vector<Vector2d> polygon;
  for (const double angle : angles)
    polygon.push_back(middle + Vector2d(wide * std::cos(angle), narrow * std::sin(angle)));
  return polygon;
}

Vec3 draw_direction(Random& random) {
  Vec3 direction = random.direction();
  direction.z() = std::abs(direction.z());
  if (random.chance(0.2)) direction.head<2>() *= std::pow(10, random.uniform(-9, -1));
  if (random.chance(0.2)) direction.z() = 0;
  if (random.chance(0.05)) direction = Vec3::UnitZ();
  return direction;
}

double farthest_from(const std::vector<Vector2d>& polygon, const Vec3& point) {
  double farthest = 0;
  for (const Vector2d& c : polygon) farthest = std::max(farthest, (point - Vec3(c.x(), c.y(), 0)).norm());
  return farthest;
}

TEST(RangeRegion, EndsWhereTheFirstBallDoes) {
  Random random(31);
  for (int k = 0; k < 300; ++k) {
    const std::vector<Vector2d> polygon = draw_polygon(random);
    const double radius = std::pow(10, random.uniform(1, 3));
    const RangeRegion region(polygon, radius);
    std::size_t remembered = 0;
    for (int d = 0; d < 100; ++d) {
      const Vec3 direction = draw_direction(random);
      double greatest = 0;
      for (std::size_t ball = 0; ball < region.ball_count(); ++ball)
        greatest = std::max(greatest, region.gauge(ball, direction));
      EXPECT_NEAR(region.gauge(direction) / greatest, 1, 1e-13);
      EXPECT_NEAR(region.gauge(direction, remembered) / greatest, 1, 1e-13);
    }
  }
}

// What is farther from one centre than from its neighbours is farther from it than from all.
TEST(RangeRegion, NeighboursBoundThePartOfABall) {
  Random random(32);
  for (int k = 0; k < 300; ++k) {
    const std::vector<Vector2d> polygon = draw_polygon(random);
    const double radius = std::pow(10, random.uniform(1, 3));
    const RangeRegion region(polygon, radius);
    for (int d = 0; d < 100; ++d) {
      const Vec3 point = draw_direction(random) * random.uniform(0, radius);
      for (std::size_t ball = 0; ball < region.ball_count(); ++ball) {
        const auto beyond = [&](std::uint32_t other) {
          const auto side = region.farther_from(ball, other);
          return side.normal.dot(point) >= side.height;
        };
        if (!std::ranges::all_of(region.neighbours(ball), beyond)) continue;
        const Vec3 below(point.x(), point.y(), 0);
        EXPECT_NEAR((point.head<2>() - polygon[ball]).norm(), farthest_from(polygon, below), 1e-12 * radius);
      }
    }
  }
}

TEST(RangeRegion, HasFewNeighboursEach) {
  std::vector<Vector2d> polygon;
  for (int k = 0; k < 64; ++k)
    polygon.emplace_back(7 * std::cos(std::numbers::pi * k / 32), 5 * std::sin(std::numbers::pi * k / 32));
  const RangeRegion region(polygon, 300);
  std::size_t all = 0;
  for (std::size_t ball = 0; ball < 64; ++ball) all += region.neighbours(ball).size();
  EXPECT_LE(all, 2U * (2 * 64 - 3));
}

TEST(RangeRegion, KnowsOfAnyPointOfATriangleThatLiesDeep) {
  Random random(33);
  for (int k = 0; k < 3000; ++k) {
    const std::vector<Vector2d> polygon = draw_polygon(random);
    const double radius = std::pow(10, random.uniform(1, 3));
    const RangeRegion region(polygon, radius);
    const Vec3 middle = draw_direction(random);
    const double spread = std::pow(10, random.uniform(-3, -0.5));
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      Vec3 direction = middle + spread * random.direction();
      direction.z() = std::abs(direction.z());
      corner = direction / region.gauge(direction);
    }
    double deepest = 0;
    for (int sample = 0; sample < 50; ++sample) {
      Vec3 weights(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
      weights /= weights.sum();
      const Vec3 point = weights.x() * corners[0] + weights.y() * corners[1] + weights.z() * corners[2];
      deepest = std::max(deepest, radius - farthest_from(polygon, point));
    }
    EXPECT_TRUE(region.is_deeper_than(deepest - 1e-12 * radius, corners));
  }
}

// Else all creases between balls would be in the mesh.
TEST(RangeRegion, SmallTrianglesAreNotDeep) {
  Random random(34);
  for (int k = 0; k < 1000; ++k) {
    const RangeRegion region(draw_polygon(random), 100);
    const Vec3 middle = draw_direction(random).normalized();
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      Vec3 direction = middle + 1e-4 * random.direction();
      direction.z() = std::abs(direction.z());
      corner = direction / region.gauge(direction);
    }
    EXPECT_FALSE(region.is_deeper_than(0.01, corners));
  }
}

}  // namespace
}  // namespace vantage::testing
