#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/stopwatch.h"
#include "io/triangulate_polygon.h"

namespace vantage::internal::io {
namespace {

using Indices = std::vector<std::array<std::uint32_t, 3>>;

/// Twice the vector area; its length is twice the area of a planar polygon.
Vec3 twice_area(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
  }
  return sum;
}

/// Expects n - 2 triangles that cover a simple polygon exactly: none is turned against the polygon, and their areas add
/// up to its own. (Were one to leave the polygon or overlap another, the sum of their areas would exceed it.)
void expect_covered(const std::vector<Vec3>& points, const std::string& what) {
  Indices triangles;
  triangulate_polygon(points, triangles);
  ASSERT_EQ(triangles.size(), points.size() - 2) << what;
  const Vec3 whole = twice_area(points);
  const Vec3 normal = whole.normalized();
  double sum = 0;
  std::vector<int> uses(points.size(), 0);
  for (const auto& t : triangles) {
    const Vec3 area = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    EXPECT_GE(area.dot(normal), -1e-9 * whole.norm()) << what;
    sum += area.norm();
    for (const std::uint32_t corner : t) ++uses[corner];
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm()) << what;
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0) << what << ": a corner is in no triangle";
}

std::vector<Vec3> in_space(const std::vector<Eigen::Vector2d>& flat, const Eigen::Affine3d& place) {
  std::vector<Vec3> points;
  for (const auto& p : flat) points.push_back(place * Vec3(p.x(), p.y(), 0));
  return points;
}

TEST(TriangulatePolygon, KeepsATriangle) {
  Indices triangles;
  triangulate_polygon({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, triangles);
  EXPECT_EQ(triangles, (Indices{{0, 1, 2}}));
}

TEST(TriangulatePolygon, CutsAQuadrilateralAcrossItsReflexCorner) {
  for (int turn = 0; turn < 4; ++turn) {  // the reflex corner first, second, third, fourth
    std::vector<Vec3> arrow = {Vec3(0, 0, 5), Vec3(4, -2, 5), Vec3(1.5, 0, 5), Vec3(4, 2, 5)};
    std::rotate(arrow.begin(), arrow.begin() + turn, arrow.end());
    expect_covered(arrow, "arrow " + std::to_string(turn));
  }
}

TEST(TriangulatePolygon, KeepsCornersOnStraightSides) {
  const std::vector<Eigen::Vector2d> comb = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 1}, {4, 2},
                                             {3, 2}, {3, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}};
  expect_covered(in_space(comb, Eigen::Affine3d::Identity()), "comb");
  std::vector<Eigen::Vector2d> square;
  for (int i = 0; i < 40; ++i) square.emplace_back(i, 0);
  for (int i = 0; i < 40; ++i) square.emplace_back(40, i);
  for (int i = 0; i < 40; ++i) square.emplace_back(40 - i, 40);
  for (int i = 0; i < 40; ++i) square.emplace_back(0, 40 - i);
  expect_covered(in_space(square, Eigen::Affine3d::Identity()), "square");
}

TEST(TriangulatePolygon, CutsRoundAHoleThatAnEdgeJoinsToTheBorder) {
  std::vector<Vec3> points = {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 10, 0), Vec3(0, 10, 0), Vec3(0, 0, 0),
                              Vec3(3, 3, 0), Vec3(3, 7, 0),  Vec3(7, 7, 0),   Vec3(7, 3, 0),  Vec3(3, 3, 0)};
  for (std::size_t start = 0; start < points.size(); ++start) {
    Indices triangles;
    triangulate_polygon(points, triangles);
    ASSERT_EQ(triangles.size(), points.size() - 2);
    double area = 0;
    for (const auto& t : triangles) {
      const double twice = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).z();
      EXPECT_GE(twice, 0) << "start " << start;
      area += twice / 2;
      const Vec3 centre = (points[t[0]] + points[t[1]] + points[t[2]]) / 3;
      const bool in_hole = centre.x() > 3 && centre.x() < 7 && centre.y() > 3 && centre.y() < 7;
      EXPECT_FALSE(in_hole && twice > 0) << "start " << start << ": " << centre.transpose();
    }
    EXPECT_DOUBLE_EQ(area, 100 - 16) << "start " << start;
    std::rotate(points.begin(), points.begin() + 1, points.end());
  }
}

/// Star-shaped about the origin with corners at every angle: simple, and as jagged as can be.
TEST(TriangulatePolygon, CoversRandomStarsInAnyPlaceAndTurn) {
  const unsigned seed = 20240117;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 4 + static_cast<int>(random() % 60);
    std::vector<Eigen::Vector2d> star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.8 * unit(random)) / n;
      star.push_back((0.05 + unit(random)) * 20 * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (trial % 2 == 1) std::reverse(star.begin(), star.end());
    const Vec3 axis = Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5).normalized();
    const Eigen::Affine3d place =
        Eigen::Translation3d(580000, 4785000, 1000) * Eigen::AngleAxisd(6 * unit(random), axis);
    expect_covered(in_space(star, place), "seed " + std::to_string(seed) + ", trial " + std::to_string(trial));
  }
}

/// Random orthogonal spirals: long thin arms, where an ear taken without looking would cross the next arm.
TEST(TriangulatePolygon, CoversSpirals) {
  for (int turns = 1; turns < 30; ++turns) {
    std::vector<Eigen::Vector2d> outer, inner;
    for (int k = 0; k < 4 * turns; ++k) {
      const double angle = k * std::numbers::pi / 2;
      outer.push_back((k + 1.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      inner.push_back((k + 0.5) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    expect_covered(in_space(outer, Eigen::Affine3d::Identity()), std::to_string(turns) + " turns");
  }
}

TEST(TriangulatePolygon, JoinsAllCornersOfNonsense) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  for (int trial = 0; trial < 300; ++trial) {  // few places for many corners: repeats, crossings, no area
    const int n = 4 + static_cast<int>(random() % 40);
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.emplace_back(random() % 4, random() % 4, trial % 3 == 0 ? random() % 2 : 0);
    Indices triangles;
    triangulate_polygon(points, triangles);
    ASSERT_EQ(triangles.size(), points.size() - 2) << "seed " << seed << ", trial " << trial;
    std::vector<bool> used(points.size(), false);
    for (const auto& t : triangles) {
      for (const std::uint32_t corner : t) used[corner] = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "seed " << seed << ", trial " << trial;
  }
}

/// The worst that a file may hold: the most corners, half of them reflex, crossing everywhere.
TEST(TriangulatePolygon, EndsInBoundedTime) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> tangle, saw;
  for (int i = 0; i < 16384; ++i) {
    tangle.emplace_back(unit(random), unit(random), 0);
    saw.emplace_back(i % 2 == 0 ? 0 : 1, i, 0);
  }
  for (const auto& points : {tangle, saw}) {
    const core::Stopwatch stopwatch;
    Indices triangles;
    triangulate_polygon(points, triangles);
    EXPECT_EQ(triangles.size(), points.size() - 2);
    EXPECT_LT(stopwatch.seconds(), 20) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vantage::internal::io
