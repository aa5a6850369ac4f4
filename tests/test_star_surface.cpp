// Surfaces inside of convex ones.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solid/star_surface.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/geometry.h"

namespace vantage {
namespace {

using internal::solid::star_inside;
using testing::Random;

/// From `from` on, in a ball of radius 1 about the origin.
double way_out(const Vec3& from, const Vec3& direction) {
  const double along = direction.dot(from);
  return std::sqrt(along * along + 1 - from.squaredNorm()) - along;
}

TEST(StarSurface, FillsABallButForItsShare) {
  Random random(63);
  for (int trial = 0; trial < 5; ++trial) {
    const Vec3 from = random.uniform(0, 0.7) * random.direction();
    const Mesh mesh = star_inside([&](const Vec3& direction) { return way_out(from, direction); }, 5e-4);
    EXPECT_EQ(testing::first_open_edge(mesh), "");
    for (const Vec3& vertex : mesh.vertices) EXPECT_NEAR((from + vertex).norm(), 1, 1e-12);
    const double ball = 4 * std::numbers::pi / 3;
    EXPECT_LT(enclosed_volume(mesh), ball);
    EXPECT_GT(enclosed_volume(mesh), (1 - 2e-3) * ball);
  }
}

/// The lens of two balls, and what four have in common: the edges between them cost little more.
TEST(StarSurface, FollowsTheEdgesBetweenBalls) {
  const double apart = 0.8;
  const Mesh lens = star_inside(
      [&](const Vec3& direction) {
        return std::min(way_out(Vec3(apart, 0, 0), direction), way_out(Vec3(-apart, 0, 0), direction));
      },
      5e-4);
  // Two caps of height h, each pi h^2 (3 - h) / 3.
  const double h = 1 - apart, exact = 2 * std::numbers::pi * h * h * (3 - h) / 3;
  EXPECT_LT(enclosed_volume(lens), exact);
  EXPECT_GT(enclosed_volume(lens), (1 - 3e-3) * exact);
}

}  // namespace
}  // namespace vantage
