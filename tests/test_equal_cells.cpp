// Targets cut into cells of the same area: no point is lost, at no scale.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/internals.h"
#include "support/random.h"
#include "target/equal_cells.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using target::area_of;
using target::equal_cells;
using testing::Random;
using Polygon = std::vector<Vector2d>;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// How far a point lies inside a convex polygon; negative outside.
double depth_in(const Polygon& polygon, const Vector2d& point) {
  double depth = INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    depth = std::min(depth, cross(edge.normalized(), point - polygon[i]));
  }
  return depth;
}

double deepest_in(const std::vector<Polygon>& cells, const Vector2d& point) {
  double depth = -INFINITY;
  for (const Polygon& cell : cells) depth = std::max(depth, depth_in(cell, point));
  return depth;
}

Polygon random_polygon(Random& random, int corners, double size, double flatness) {
  Polygon polygon;
  const double turn = random.uniform(0, 7);
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * (k + random.uniform(-0.3, 0.3)) / corners;
    const Vector2d p(size * std::cos(angle), size * flatness * std::sin(angle));
    polygon.emplace_back(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                         std::sin(turn) * p.x() + std::cos(turn) * p.y());
  }
  return polygon;
}

TEST(EqualCells, OfASquareAreSquares) {
  const Polygon square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const std::size_t side : {1, 2, 4, 8}) {
    const std::vector<Polygon> cells = equal_cells(square, side * side);
    ASSERT_EQ(cells.size(), side * side);
    for (const Polygon& cell : cells) {
      ASSERT_EQ(cell.size(), 4u);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR((cell[(i + 1) % 4] - cell[i]).norm(), 2.0 / static_cast<double>(side), 1e-11);
      }
    }
  }
}

TEST(EqualCells, OfAStripStandInARow) {
  const std::vector<Polygon> cells = equal_cells({{-10, -0.5}, {10, -0.5}, {10, 0.5}, {-10, 0.5}}, 20);
  ASSERT_EQ(cells.size(), 20u);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double low = INFINITY, high = -INFINITY;
    for (const Vector2d& p : cells[i]) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
    EXPECT_NEAR(low, -10.0 + static_cast<double>(i), 1e-10);
    EXPECT_NEAR(high, -9.0 + static_cast<double>(i), 1e-10);
  }
}

TEST(EqualCells, HoldEveryPoint) {
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    const double size = std::pow(10, random.integer(-3, 4));
    const Polygon polygon = random_polygon(random, random.integer(3, 12), size, std::pow(10, random.uniform(-3, 0)));
    double extent = 0;
    for (const Vector2d& p : polygon) extent = std::max(extent, p.cwiseAbs().maxCoeff());
    const auto count = static_cast<std::size_t>(round % 10 == 0 ? 1024 : random.integer(2, 90));
    const std::vector<Polygon> cells = equal_cells(polygon, count);
    ASSERT_EQ(cells.size(), count);
    SCOPED_TRACE("round " + std::to_string(round));
    const double equal = area_of(polygon) / static_cast<double>(count);
    for (const Polygon& cell : cells) {
      double outline = 0;
      for (std::size_t i = 0; i < cell.size(); ++i) {
        const Vector2d edge = cell[(i + 1) % cell.size()] - cell[i], next = cell[(i + 2) % cell.size()] - cell[i];
        outline += edge.norm();
        EXPECT_GE(cross(edge, next), 0) << "a corner turns the wrong way";
        EXPECT_GE(depth_in(polygon, cell[i]), -target::kMostOutlineGrowth * extent);
      }
      EXPECT_NEAR(area_of(cell), equal, 0x1p-39 * extent * outline);
    }
    // On cuts most of all: corners of cells, and points of their sides.
    for (int k = 0; k < 300; ++k) {
      const Polygon& cell = cells[static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1))];
      const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(cell.size()) - 1));
      const double along = random.chance(0.3) ? 0 : random.uniform(0, 1);
      const Vector2d p = (1 - along) * cell[i] + along * cell[(i + 1) % cell.size()];
      const double inside = std::min(0.0, depth_in(polygon, p));
      EXPECT_GE(deepest_in(cells, p), inside - 0x1p-50 * extent);
    }
    for (const Vector2d& corner : polygon) EXPECT_GE(deepest_in(cells, corner), -0x1p-50 * extent);
  }
}

TEST(EqualCells, TwiceAsManyAreHalves) {
  Random random(12);
  for (int round = 0; round < 20; ++round) {
    const Polygon polygon = random_polygon(random, random.integer(3, 8), 10, random.uniform(0.1, 1));
    const std::vector<Polygon> some = equal_cells(polygon, 16), more = equal_cells(polygon, 32);
    for (std::size_t i = 0; i < more.size(); ++i) {
      for (const Vector2d& corner : more[i]) EXPECT_GE(depth_in(some[i / 2], corner), -1e-10);
    }
  }
}

}  // namespace
}  // namespace vantage
