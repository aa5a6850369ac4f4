#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "io/join_holes.h"
#include "io/triangulate_polygon.h"
#include "support/random.h"

namespace vantage::internal::io {
namespace {

using Ring = std::vector<Vec3>;

struct Covered {
  double area = 0;  // of all triangles, each counted positive
  Vec3 turned;      // the sum of their areas as vectors
  std::size_t left_out = 0;
  std::size_t triangles = 0;
};

Vec3 area_vector(const Ring& ring) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    sum +=
        (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]) / 2;  // about a corner: they may be far away
  }
  return sum;
}

/// Joins, triangulates and measures. No two triangles overlap just when the area of all is that of the polygon.
Covered cover(const std::vector<Ring>& rings) {
  std::vector<Vec3> points;
  std::vector<std::size_t> ends;
  for (const Ring& ring : rings) {
    points.insert(points.end(), ring.begin(), ring.end());
    ends.push_back(points.size());
  }
  Covered covered;
  std::vector<Vec3> corners;
  for (const std::uint32_t i : join_holes(points, ends, covered.left_out)) corners.push_back(points[i]);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangulate_polygon(corners, triangles);
  covered.turned = Vec3::Zero();
  covered.triangles = triangles.size();
  for (const auto& t : triangles) {
    const Vec3 area = (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]) / 2;
    covered.area += area.norm();
    covered.turned += area;
  }
  return covered;
}

Ring square(double x, double y, double size, bool clockwise = false) {
  Ring ring = {{x, y, 0}, {x + size, y, 0}, {x + size, y + size, 0}, {x, y + size, 0}};
  if (clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

void expect_covers(const std::vector<Ring>& rings, double area) {
  const Covered covered = cover(rings);
  EXPECT_EQ(covered.left_out, 0u);
  EXPECT_NEAR(covered.area, area, 1e-9 * area);
  EXPECT_NEAR(covered.turned.norm(), area, 1e-9 * area);
  EXPECT_GT(covered.turned.dot(area_vector(rings[0])), 0);
}

TEST(JoinHoles, LeavesHolesOpen) {
  expect_covers({square(0, 0, 10), square(2, 2, 3)}, 91);
  expect_covers({square(0, 0, 10), square(2, 2, 3, true)}, 91);
  expect_covers({square(0, 0, 10, true), square(2, 2, 3)}, 91);
  expect_covers({square(0, 0, 10), square(1, 1, 2), square(4, 1, 2), square(1, 4, 2), square(7, 7, 2)}, 84);
  // Several at one height, and rows of corners on one line.
  expect_covers({square(0, 0, 10), square(1, 4, 1), square(3, 4, 1), square(5, 4, 1), square(7, 4, 1)}, 96);
}

TEST(JoinHoles, LetsHolesTouch) {
  const Ring diamond = {{5, 0, 0}, {7, 2, 0}, {5, 4, 0}, {3, 2, 0}};
  Ring border = square(0, 0, 10);
  border.insert(border.begin() + 1, Vec3(5, 0, 0));
  expect_covers({border, diamond}, 92);                                     // a corner of the border
  expect_covers({square(0, 0, 10), square(2, 2, 2), square(4, 4, 2)}, 92);  // each other
  const Ring right = {{10, 5, 0}, {8, 7, 0}, {6, 5, 0}, {8, 3, 0}};
  Ring with_corner = square(0, 0, 10);
  with_corner.insert(with_corner.begin() + 2, Vec3(10, 5, 0));
  expect_covers({with_corner, right}, 92);
  expect_covers({with_corner, right, diamond}, 84);
}

TEST(JoinHoles, LeavesOutHolesOutside) {
  for (const Ring& hole : {square(20, 2, 3), square(-20, 2, 3), square(2, 30, 3)}) {
    const Covered covered = cover({square(0, 0, 10), hole, square(1, 1, 1)});
    EXPECT_EQ(covered.left_out, 1u);
    EXPECT_NEAR(covered.area, 99, 1e-9);
  }
}

TEST(JoinHoles, CoversRandomPolygonsInSpace) {
  testing::Random random(20240611);
  for (int round = 0; round < 300; ++round) {
    // A star-shaped border around a grid of star-shaped holes, turned and far from the origin, as a map's are.
    const Eigen::AngleAxisd turn(random.uniform(0, 3), random.direction());
    const auto star = [&](double x, double y, double low, double high, bool reversed) {
      const int corners = random.integer(3, 14);
      Ring ring;
      for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.9)) / corners;
        const double radius = random.uniform(low, high);
        ring.push_back(turn * Vec3(x + radius * std::cos(angle), y + radius * std::sin(angle), 0) +
                       Vec3(85000, 447000, 3));
      }
      if (reversed) std::reverse(ring.begin(), ring.end());
      return ring;
    };
    std::vector<Ring> rings = {square(-8, -8, 16)};
    for (Vec3& corner : rings[0]) corner = turn * corner + Vec3(85000, 447000, 3);
    double area = 256;
    const int count = random.integer(1, 4);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < count; ++k) {
        rings.push_back(star(-6 + 4 * i, -6 + 4 * k, 0.2, 1.9, random.chance(0.5)));
        area -= area_vector(rings.back()).norm();
      }
    }
    const Covered covered = cover(rings);
    EXPECT_EQ(covered.left_out, 0u);
    EXPECT_NEAR(covered.area, area, 1e-5) << "round " << round;
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace vantage::internal::io
