#include <gtest/gtest.h>

#include <vector>

#include "prove/lowest_point.h"
#include "support/random.h"

namespace vantage {
namespace {

using internal::prove::highest;
using internal::prove::lowest_point;
using internal::prove::Plane2;
using testing::Random;

/// No place of a grid over the box is lower.
void expect_lowest(const std::vector<Plane2>& planes, const Eigen::Vector2d& min, const Eigen::Vector2d& max) {
  const Eigen::Vector2d place = lowest_point(planes, min, max);
  EXPECT_TRUE((place.array() >= min.array()).all() && (place.array() <= max.array()).all());
  constexpr int kParts = 40;
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts; ++j) {
      const Eigen::Vector2d other = min + (max - min).cwiseProduct(Eigen::Vector2d(i, j) / kParts);
      EXPECT_LE(highest(planes, place), highest(planes, other) + 1e-9);
    }
  }
}

TEST(LowestPoint, OfRandomPlanes) {
  Random random(61);
  for (int round = 0; round < 200; ++round) {
    std::vector<Plane2> planes(1 + round % 9);
    for (Plane2& plane : planes) {
      plane = {random.uniform(-1, 1), {random.uniform(-1, 1), random.uniform(-1, 1)}};
      if (round % 5 == 0) plane.slope.y() = 0;
    }
    expect_lowest(planes, {-random.uniform(0, 2), -random.uniform(0, 2)}, {random.uniform(0, 2), random.uniform(0, 2)});
    expect_lowest(planes, {0, -1}, {0, 1});  // one variable is fixed
  }
}

TEST(LowestPoint, WherePlanesAreTheSame) {
  const std::vector<Plane2> level(30, Plane2{3, {0, 0}});
  EXPECT_EQ(highest(level, lowest_point(level, {-1, -1}, {1, 1})), 3);
  const std::vector<Plane2> slanted(30, Plane2{3, {1, -2}});
  EXPECT_EQ(highest(slanted, lowest_point(slanted, {-1, -1}, {1, 1})), 0);
}

}  // namespace
}  // namespace vantage
