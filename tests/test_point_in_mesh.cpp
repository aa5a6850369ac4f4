// Which points lie in closed meshes, decided without rounding.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/solids.h"
#include "support/torus.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using testing::append;
using testing::expect_code;
using testing::make_box_mesh;
using testing::make_torus;
using testing::Random;

/// Small, ordinary, large; and at map coordinates.
const std::vector<std::pair<double, Vec3>> kScales = {
    {1e-3, Vec3::Zero()}, {1, Vec3::Zero()}, {30, Vec3(4, 5, 6)}, {1e4, Vec3::Zero()}, {1, Vec3(5e5, 5e6, 300)}};

std::vector<std::uint8_t> inside(const Mesh& mesh, const std::vector<Vec3>& points) {
  return SolidIndex(mesh).contains(points);
}

TEST(PointInMesh, TheSurfaceBelongsToTheSolid) {
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    const Vec3 low = at, high = at + Vec3::Constant(size);
    const Mesh box = make_box_mesh(low, high);
    const double middle = (low.x() + high.x()) / 2;
    const auto above = [](double v) { return std::nextafter(v, INFINITY); };
    const auto below = [](double v) { return std::nextafter(v, -INFINITY); };
    // Corners, an edge, sides, and what is one step of the numbers beside them.
    const std::vector<Vec3> on = {low,
                                  high,
                                  {middle, low.y(), low.z()},
                                  {low.x(), high.y(), (low.z() + high.z()) / 2},
                                  {middle, high.y(), above(low.z())},
                                  {above(low.x()), above(low.y()), below(high.z())}};
    for (const std::uint8_t is_in : inside(box, on)) EXPECT_EQ(is_in, 1);
    const std::vector<Vec3> off = {{below(low.x()), low.y(), low.z()},
                                   {middle, middle, above(high.z())},
                                   {above(high.x()), high.y(), high.z()},
                                   {middle, middle, below(low.z())},
                                   {middle, above(high.y()), low.z()}};
    for (const std::uint8_t is_in : inside(box, off)) EXPECT_EQ(is_in, 0);
  }
}

/// The diagonal side x + y + z = 1 of a corner of a cube: of numbers of which it is known on which side they are.
TEST(PointInMesh, OneStepOfTheNumbersDecides) {
  Mesh corner;
  corner.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  corner.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const double step = 0x1p-53;  // 0.25 + 0.25 + (0.5 +- a step) is exact in double
  EXPECT_EQ(inside(corner, {{0.25, 0.25, 0.5}, {0.25, 0.25, 0.5 - step}, {0.25, 0.25, 0.5 + 2 * step}}),
            (std::vector<std::uint8_t>{1, 1, 0}));
  EXPECT_EQ(inside(corner, {{0.5, 0.5, 0}, {0.5, 0.5, 0x1p-1000}, {0.5, 0.5 - step, 0}, {0.5, 0.5, -0x1p-1000}}),
            (std::vector<std::uint8_t>{1, 0, 1, 0}));
}

TEST(PointInMesh, RaysThroughEdgesAndUprightSidesCountOnce) {
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    // Two boxes on top of each other, and a third beside them, with a gap: all corners are straight above each other.
    Mesh mesh = make_box_mesh(at, at + size * Vec3(1, 1, 1));
    append(mesh, make_box_mesh(at + size * Vec3(0, 0, 2), at + size * Vec3(1, 1, 3)));
    append(mesh, make_box_mesh(at + size * Vec3(1, 0, 5), at + size * Vec3(2, 1, 6)));
    const auto holds = [&, size = size, at = at](double x, double y, double z) {
      return inside(mesh, {Vec3(at + size * Vec3(x, y, z))})[0] == 1;
    };
    for (const double x : {0.0, 0.25, 0.5, 1.0}) {
      for (const double y : {0.0, 0.5, 1.0}) {
        EXPECT_TRUE(holds(x, y, 0.5)) << x << " " << y;
        EXPECT_FALSE(holds(x, y, 1.5)) << x << " " << y;
        EXPECT_FALSE(holds(x, y, -1)) << x << " " << y;
        EXPECT_TRUE(holds(x, y, 2.5)) << x << " " << y;
      }
    }
    EXPECT_TRUE(holds(1, 0, 5.5));
    EXPECT_FALSE(holds(0.5, 0.5, 5.5));
    EXPECT_FALSE(holds(1.5, 0.5, 4));
  }
}

/// Whole numbers of 27 bits: double rounds their products, and which points lie in a facet is known all the same.
TEST(PointInMesh, PointsOfTiltedFacetsBelongToTheSolid) {
  Random random(13);
  constexpr int kParts = 21;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    Mesh mesh;
    for (int i = 0; i < 4; ++i) {
      const auto whole = [&] { return 1.0 * random.integer(-(1 << 26), 1 << 26); };
      const double x = whole(), y = whole();
      mesh.vertices.emplace_back(kParts * Vec3(x, y, whole()));
    }
    const Vec3 a = mesh.vertices[1] - mesh.vertices[0], b = mesh.vertices[2] - mesh.vertices[0];
    if (a.cross(b).dot(mesh.vertices[3] - mesh.vertices[0]) > 0) std::swap(mesh.vertices[0], mesh.vertices[1]);
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    std::vector<Vec3> on, beside;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
      const Vec3 normal = (q - p).cross(r - p);
      Eigen::Index axis = 0;
      normal.cwiseAbs().maxCoeff(&axis);
      const Vec3 outward = std::copysign(1.0, normal[axis]) * Vec3::Unit(axis);
      for (int i = 0; i <= kParts; i += 3) {
        for (int j = 0; i + j <= kParts; j += 2) {
          on.push_back(i * (p / kParts) + j * (q / kParts) + (kParts - i - j) * (r / kParts));
          beside.push_back(on.back() + outward);
        }
      }
    }
    const std::vector<std::uint8_t> is_on = inside(mesh, on), is_beside = inside(mesh, beside);
    EXPECT_EQ(std::count(is_on.begin(), is_on.end(), 1), static_cast<std::ptrdiff_t>(on.size()));
    EXPECT_EQ(std::count(is_beside.begin(), is_beside.end(), 1), 0);
  }
}

TEST(PointInMesh, CavitiesAreOutside) {
  Mesh mesh = make_box_mesh({0, 0, 0}, {4, 4, 4});
  Mesh cavity = make_box_mesh({1, 1, 1}, {3, 3, 3});
  for (Triangle& t : cavity.triangles) std::swap(t[0], t[1]);
  append(mesh, cavity);
  EXPECT_EQ(inside(mesh, {{2, 2, 2}, {0.5, 2, 2}, {1, 2, 2}, {3, 3, 3}, {1.5, 1.5, 1.5}}),
            (std::vector<std::uint8_t>{0, 1, 1, 1, 0}));
}

TEST(PointInMesh, AgreesWithSolidAngles) {
  Random random(20261123);
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    const Mesh torus = make_torus(at, 3 * size, size, 24, 12);
    std::vector<Vec3> points;
    for (int i = 0; i < 400; ++i) points.push_back(at + size * random.point(-4.2, 4.2));
    for (const Vec3& v : torus.vertices) points.push_back(v);  // on the surface
    const std::vector<std::uint8_t> found = inside(torus, points);
    for (std::size_t i = 0; i < 400; ++i) EXPECT_EQ(found[i] == 1, testing::holds(torus, points[i])) << i;
    for (std::size_t i = 400; i < points.size(); ++i) EXPECT_EQ(found[i], 1) << i;
  }
}

/// The depth, which is rounded, has the same sign wherever it is not rounding itself.
TEST(PointInMesh, AgreesWithDepths) {
  Random random(7);
  const Vec3 at(5e5, 5e6, 300);
  const SolidIndex torus(make_torus(at, 300, 100, 60, 30));
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) points.push_back(at + 420 * random.point(-1, 1));
  const std::vector<std::uint8_t> found = torus.contains(points);
  const std::vector<double> depths = torus.depths_m(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(depths[i]) <= 1e-8) continue;
    EXPECT_EQ(found[i] == 1, depths[i] > 0) << i;
  }
}

TEST(PointInMesh, ManyPointsAreQuick) {
  const SolidIndex torus(make_torus({0, 0, 0}, 300, 100, 500, 100));  // 100,000 facets
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 100000; ++i) points.push_back(400 * random.point(-1, 1));
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::uint8_t> found = torus.contains(points);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << "100,000 points in 100,000 facets: " << seconds << " s with the hierarchy\n";
  EXPECT_GT(std::count(found.begin(), found.end(), 1), 5000);
  EXPECT_LT(seconds, 20);  // of a machine that does other things, and of builds that check themselves
}

TEST(PointInMesh, RefusesWhatIsNotClosedOrNotOriented) {
  Mesh open = make_box_mesh({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  expect_code([&] { SolidIndex{open}; }, ErrorCode::mesh_not_closed);
  Mesh turned = make_box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expect_code([&] { (void)inside(turned, {Vec3::Zero()}); }, ErrorCode::mesh_not_oriented);
  const Mesh box = make_box_mesh({0, 0, 0}, {1, 1, 1});
  expect_code([&] { (void)inside(box, {Vec3(0, NAN, 0)}); }, ErrorCode::coordinate_not_finite);
  EXPECT_EQ(inside(Mesh(), {Vec3::Zero()}), std::vector<std::uint8_t>{0});
}

}  // namespace
}  // namespace vantage
