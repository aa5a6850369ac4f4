// Hulls of points that lie on one line, in one plane, in one place, and nearly so.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/grown_polygon.h"
#include "core/orientation.h"
#include "solid/convex_body.h"
#include "solid/convex_hull.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {
namespace {

using testing::first_open_edge;
using testing::Random;

const Vec3 kMapPlace(-3e6, 4.7e6, 0);

/// What is wrong with the hull of these points, or empty: exact.
std::string fault_of(const Mesh& hull, const std::vector<Vec3>& points) {
  const std::string open = first_open_edge(hull);
  if (!open.empty()) return open;
  const MeshMeasures measures = measure(hull);
  if (measures.euler != 2 || measures.pieces != 1) return "Euler number " + std::to_string(measures.euler);
  for (const auto& [i, j, k] : hull.triangles) {
    const Vec3 &a = hull.vertices[i], &b = hull.vertices[j], &c = hull.vertices[k];
    for (const Vec3& point : points) {
      if (core::orientation(a, b, c, point) < 0) return "a point lies outside";
    }
    const bool is_flat = std::all_of(points.begin(), points.end(),
                                     [&](const Vec3& point) { return core::orientation(a, b, c, point) == 0; });
    if (is_flat) return "a facet without area";
  }
  for (const Vec3& vertex : hull.vertices) {
    if (std::find(points.begin(), points.end(), vertex) == points.end()) return "a vertex that is no point";
  }
  return "";
}

/// Points that nearly lie in planes and on lines, in steps of a grid, several times over.
std::vector<Vec3> degenerate_points(Random& random) {
  const double size = std::pow(10.0, random.uniform(-3, 4));
  const Vec3 middle = random.chance(0.5) ? Vec3::Zero() : kMapPlace;
  const int kind = random.integer(0, 3), count = random.integer(5, 120);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(random.chance(0.5) ? 0 : random.uniform(0, 6), random.direction()).toRotationMatrix();
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 point = random.point(-1, 1);
    if (kind == 0) point = (3 * point).array().round() / 3;           // a grid
    if (kind == 1) point[random.integer(0, 2)] = random.chance(0.5);  // faces of a box
    if (kind == 2) point = point.normalized();                        // a ball
    if (kind == 3 && i % 3) point.z() = 0;                            // most in one plane
    points.push_back(turn * (size * point) + middle);
    if (random.chance(0.2)) points.push_back(points[static_cast<std::size_t>(random.integer(0, i))]);
  }
  for (Vec3& point : points) {
    if (point.x() != 0 && random.chance(0.3)) point.x() = std::nextafter(point.x(), 1e9);
  }
  return points;
}

TEST(ConvexHull, IsConvexAndHoldsItsPointsExactly) {
  Random random(211);
  int solid = 0;
  for (int round = 0; round < 400; ++round) {
    const std::vector<Vec3> points = degenerate_points(random);
    const Mesh hull = convex_hull(points);
    if (hull.empty()) continue;
    ++solid;
    EXPECT_EQ(fault_of(hull, points), "") << "round " << round;
  }
  EXPECT_GT(solid, 300);
}

// What clearance makes of a convex building: all its walls, grown, have their outer sides in the same planes but for
// rounding, which is coarse at map coordinates.
TEST(ConvexHull, OfGrownWallsIsConvex) {
  Random random(223);
  for (int round = 0; round < 300; ++round) {
    const Vec3 low = random.point(-30, 30), high = low + random.point(2, 24);
    const Vec3 shift = round % 2 ? kMapPlace : Vec3::Zero();
    std::vector<Vec3> points;
    Mesh box = testing::make_box_mesh(low, high);
    for (Vec3& vertex : box.vertices) vertex = (vertex + shift) - shift;
    const double radius = random.uniform(0.1, 5);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (unsigned side = 0; side < 2; ++side) {
        const unsigned u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, at = side << axis;
        const std::vector<Vec3> wall = {box.vertices[at], box.vertices[at + u], box.vertices[at + u + v],
                                        box.vertices[at + v]};
        const Mesh grown = core::grow_polygon(wall, radius);
        points.insert(points.end(), grown.vertices.begin(), grown.vertices.end());
      }
    }
    EXPECT_EQ(fault_of(convex_hull(points), points), "") << "round " << round;
  }
}

TEST(ConvexHull, OfPointsInAPlaneIsEmpty) {
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_TRUE(convex_hull(std::vector<Vec3>(9, Vec3(1, 2, 3))).empty());
  std::vector<Vec3> points;
  for (int i = 0; i < 9; ++i) points.emplace_back(i, i * i, 2 * i);
  EXPECT_TRUE(convex_hull(points).empty());
  for (Vec3& point : points) point.y() = 0;
  EXPECT_TRUE(convex_hull(points).empty());
  points.emplace_back(0, 1, 0);
  EXPECT_TRUE(convex_hull(points).empty());
  points.emplace_back(0, 0, 1e-30);
  EXPECT_FALSE(convex_hull(points).empty());
}

TEST(ConvexHull, IsTheSameEachTime) {
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) points.push_back(random.direction());
  const Mesh first = convex_hull(points);
  EXPECT_EQ(first.vertices.size(), points.size());
  for (int i = 0; i < 2; ++i) {
    const Mesh again = convex_hull(points);
    EXPECT_TRUE(again.vertices == first.vertices && again.triangles == first.triangles) << i;
  }
}

TEST(SureNormal, IsRightOfFacetsAsNarrowAsRounding) {
  Random random(227);
  for (int round = 0; round < 1000; ++round) {
    // Whole numbers: the exact normal is one of whole numbers below 2^53.
    const Vec3 a = (1e3 * random.point(-1, 1)).array().round(), u = (1e4 * random.point(-1, 1)).array().round();
    const Vec3 v = 1000 * u + (2 * random.point(-1, 1)).array().round().matrix();
    const Vec3 exact = u.cross(Vec3(v - 1000 * u));
    const double scale = std::ldexp(1.0, random.integer(-40, 40));
    const Vec3 found = sure_normal(scale * a, scale * (a + u), scale * (a + v)) / (scale * scale);
    EXPECT_LE((found - exact).norm(), 1e-12 * exact.norm()) << round;
  }
}

}  // namespace
}  // namespace vantage::internal::solid
