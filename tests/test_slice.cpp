// Level sections of closed meshes, and what they cover in plan.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/torus.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/solid.h"
#include "vantage/target.h"

namespace vantage {
namespace {

using testing::append;
using testing::expect_code;
using testing::make_box_mesh;
using testing::make_torus;
using testing::Random;

using Ring = PlanPolygon::Ring;

const std::vector<std::pair<double, Vec3>> kScales = {
    {1e-3, Vec3::Zero()}, {1, Vec3::Zero()}, {30, Vec3(4, 5, 6)}, {1e4, Vec3::Zero()}, {1, Vec3(5e5, 5e6, 300)}};

double total_area(const std::vector<PlanPolygon>& polygons) {
  double sum = 0;
  for (const PlanPolygon& polygon : polygons) sum += area_m2(polygon);
  return sum;
}

double signed_area(const Ring& ring) { return area_m2({ring, {}}); }

/// Outer rings turn left, holes right, and nothing is repeated.
void expect_in_order(const std::vector<PlanPolygon>& polygons) {
  for (const PlanPolygon& polygon : polygons) {
    EXPECT_GE(polygon.outer.size(), 3u);
    EXPECT_GT(signed_area(polygon.outer), 0);
    for (const Ring& hole : polygon.holes) {
      EXPECT_GE(hole.size(), 3u);
      EXPECT_LT(signed_area(hole), 0);
    }
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      EXPECT_NE(polygon.outer[i], polygon.outer[(i + 1) % polygon.outer.size()]);
    }
  }
}

/// By a ray eastward; of points that are on no side.
bool covers(const PlanPolygon& polygon, const Eigen::Vector2d& p) {
  bool is_odd = false;
  const auto count = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) is_odd = !is_odd;
    }
  };
  count(polygon.outer);
  for (const Ring& hole : polygon.holes) count(hole);
  return is_odd;
}

bool covers(const std::vector<PlanPolygon>& polygons, const Eigen::Vector2d& p) {
  return std::any_of(polygons.begin(), polygons.end(), [&](const PlanPolygon& polygon) { return covers(polygon, p); });
}

double distance_to_rings(const std::vector<PlanPolygon>& polygons, const Eigen::Vector2d& p) {
  double least = INFINITY;
  const auto look = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - a - t * (b - a)).norm());
    }
  };
  for (const PlanPolygon& polygon : polygons) {
    look(polygon.outer);
    for (const Ring& hole : polygon.holes) look(hole);
  }
  return least;
}

TEST(Slice, OfABoxIsItsBaseUpToButNotAtItsTop) {
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    const Vec3 low = at, high = at + size * Vec3(2, 3, 4);
    const Mesh box = make_box_mesh(low, high);
    const double just_below = std::nextafter(high.z(), -INFINITY);
    for (const double z : {low.z(), (low.z() + high.z()) / 2, just_below}) {
      const std::vector<PlanPolygon> slice = slice_mesh(box, z);
      ASSERT_EQ(slice.size(), 1u);
      ASSERT_EQ(slice[0].outer.size(), 4u);  // no points on straight sides
      EXPECT_TRUE(slice[0].holes.empty());
      expect_in_order(slice);
      for (const Eigen::Vector2d& corner : slice[0].outer) {  // to the bit
        EXPECT_TRUE(corner.x() == low.x() || corner.x() == high.x());
        EXPECT_TRUE(corner.y() == low.y() || corner.y() == high.y());
      }
    }
    EXPECT_TRUE(slice_mesh(box, high.z()).empty());
    EXPECT_TRUE(slice_mesh(box, std::nextafter(low.z(), -INFINITY)).empty());
  }
}

TEST(Slice, OfATetrahedronHasTheAreaOfTheFormula) {
  for (const auto& [size, at] : kScales) {
    Mesh mesh;
    mesh.vertices = {at, at + size * Vec3(1, 0, 0), at + size * Vec3(0, 1, 0), at + size * Vec3(0, 0, 1)};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (const double share : {0.0, 0.25, 0.5, 0.999}) {
      SCOPED_TRACE(share);
      const double z = at.z() + share * size, left = 1 - (z - at.z()) / size;
      const std::vector<PlanPolygon> slice = slice_mesh(mesh, z);
      ASSERT_EQ(slice.size(), 1u);
      expect_in_order(slice);
      const double rounding = 0x1p-50 * (at + Vec3::Constant(size)).cwiseAbs().maxCoeff() * 4 * size;
      EXPECT_NEAR(total_area(slice), size * size * left * left / 2, rounding);
    }
    EXPECT_TRUE(slice_mesh(mesh, at.z() + size).empty());
  }
}

TEST(Slice, OfATorusIsARingOrTwoDiscs) {
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    const Mesh lying = make_torus(at, 3 * size, size, 64, 32);
    const std::vector<PlanPolygon> ring = slice_mesh(lying, at.z() + 0.3 * size);
    ASSERT_EQ(ring.size(), 1u);
    ASSERT_EQ(ring[0].holes.size(), 1u);
    expect_in_order(ring);
    const double half_width = std::sqrt(1 - 0.09);
    EXPECT_NEAR(total_area(ring), 4 * std::numbers::pi * 3 * half_width * size * size, 0.02 * 36 * size * size);
    Mesh standing = lying;
    for (Vec3& v : standing.vertices) {
      const Vec3 local = v - at;
      v = at + Vec3(local.x(), -local.z(), local.y());
    }
    const std::vector<PlanPolygon> discs = slice_mesh(standing, at.z() + 0.1 * size);
    ASSERT_EQ(discs.size(), 2u);
    expect_in_order(discs);
    EXPECT_GE(area_m2(discs[0]), area_m2(discs[1]));
    EXPECT_NEAR(total_area(discs), 2 * std::numbers::pi * size * size, 0.03 * 6 * size * size);
  }
}

TEST(Slice, AtCornersIsTheLimitFromAbove) {
  // An octahedron: at the height of its middle all of its four corners there are those of the slice.
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  const std::vector<PlanPolygon> middle = slice_mesh(mesh, 0);
  ASSERT_EQ(middle.size(), 1u);
  EXPECT_EQ(middle[0].outer.size(), 4u);
  EXPECT_EQ(total_area(middle), 2);
  EXPECT_TRUE(slice_mesh(mesh, -1).empty());  // a point has no area
  EXPECT_TRUE(slice_mesh(mesh, 1).empty());
  // Two of them that touch in a corner, and one that hangs in another's slice by its lowest corner.
  Mesh beside = mesh;
  for (Vec3& v : beside.vertices) v += Vec3(2, 0, 0);
  append(mesh, beside);
  for (Vec3& v : beside.vertices) v += Vec3(-2, 0, 1);
  append(mesh, beside);
  const std::vector<PlanPolygon> both = slice_mesh(mesh, 0);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(total_area(both), 4);
  expect_in_order(both);
}

TEST(Slice, HolesAndWhatIsInThemAreNested) {
  const auto turned = [](Mesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
    return mesh;
  };
  Mesh mesh = make_box_mesh({0, 0, 0}, {10, 10, 10});
  append(mesh, turned(make_box_mesh({1, 1, 1}, {5, 9, 9})));
  append(mesh, make_box_mesh({2, 2, 2}, {4, 8, 8}));  // in the cavity
  append(mesh, turned(make_box_mesh({6, 6, 1}, {9, 9, 9})));
  const std::vector<PlanPolygon> slice = slice_mesh(mesh, 5);
  ASSERT_EQ(slice.size(), 2u);
  EXPECT_EQ(slice[0].holes.size(), 2u);
  EXPECT_EQ(slice[1].holes.size(), 0u);
  EXPECT_EQ(total_area(slice), 100 - 32 + 12 - 9);
  expect_in_order(slice);
  // A cavity whose corners all touch the sides of the box: the ring of the box is run through once.
  Mesh touching = make_box_mesh({0, 0, 0}, {2, 2, 2});
  Mesh diamond = make_box_mesh({-1, -1, 0.5}, {1, 1, 1.5});
  for (Vec3& v : diamond.vertices) v = Vec3((v.x() + v.y()) / 2 + 1, (v.y() - v.x()) / 2 + 1, v.z());
  append(touching, turned(diamond));
  const std::vector<PlanPolygon> corners = slice_mesh(touching, 1);
  EXPECT_EQ(total_area(corners), 2);
}

TEST(Slice, HolesAreOfThePolygonRoundThemNotOfThatWhoseBoxTheyAreIn) {
  Mesh mesh = make_box_mesh({-10, -10, 0}, {10, 10, 4});
  for (Vec3& v : mesh.vertices) v = Vec3((v.x() + v.y()) / 2, (v.y() - v.x()) / 2, v.z());  // |x| + |y| <= 10
  Mesh cavity = make_box_mesh({4, 0, 1}, {6, 2, 3});
  for (Triangle& t : cavity.triangles) std::swap(t[0], t[1]);
  append(mesh, cavity);
  Mesh beside;  // beyond x + y = 11, with the cavity in its box
  beside.vertices = {{12, 12, 0}, {-1, 12, 0}, {12, -1, 0}, {12, 12, 1000}};
  beside.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  append(mesh, beside);
  const std::vector<PlanPolygon> slice = slice_mesh(mesh, 2);
  ASSERT_EQ(slice.size(), 2u);
  EXPECT_EQ(slice[0].holes.size(), 1u);
  EXPECT_EQ(slice[1].holes.size(), 0u);
  EXPECT_EQ(area_m2(slice[0]), 200 - 4);
}

/// Places of the slice are places of the mesh, and the other way round, but beside the rings.
TEST(Slice, AgreesWithPointsInTheMesh) {
  Random random(11);
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    for (int round = 0; round < 8; ++round) {
      const auto radius = [&, size = size](double, double) { return size * random.uniform(0.3, 1); };
      const Mesh mesh = testing::make_dome(at, 31, 9, radius).mesh;
      double z = at.z() + size * random.uniform(0, 0.7);
      if (round == 0) z = mesh.vertices[40].z();  // exactly at a corner
      const std::vector<PlanPolygon> slice = slice_mesh(mesh, z);
      expect_in_order(slice);
      std::vector<Vec3> points;
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = at + size * random.point(-1, 1);
        points.emplace_back(p.x(), p.y(), z);
      }
      const std::vector<std::uint8_t> inside = SolidIndex(mesh).contains(points);
      const double rounding = 0x1p-48 * (at.cwiseAbs().maxCoeff() + size);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2d p = points[i].head<2>();
        if (distance_to_rings(slice, p) <= rounding) continue;
        EXPECT_EQ(covers(slice, p), inside[i] == 1) << points[i].transpose();
      }
    }
  }
}

TEST(Slice, CornersLieWithinTheBoundOfTheEdges) {
  Random random(5);
  const Vec3 at(5e5, 5e6, 300);
  const double bound = 0x1p-50 * 5.000002e6;
  using Long = Eigen::Matrix<long double, 2, 1>;
  for (int round = 0; round < 2000; ++round) {
    Mesh mesh;
    for (int i = 0; i < 4; ++i) mesh.vertices.push_back(at + 100 * random.point(-1, 1));
    const Vec3 a = mesh.vertices[1] - mesh.vertices[0], b = mesh.vertices[2] - mesh.vertices[0];
    if (a.cross(b).dot(mesh.vertices[3] - mesh.vertices[0]) > 0) std::swap(mesh.vertices[0], mesh.vertices[1]);
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    const double z = at.z() + random.uniform(-50, 50);
    for (const PlanPolygon& polygon : slice_mesh(mesh, z)) {
      for (const Eigen::Vector2d& corner : polygon.outer) {
        long double nearest = INFINITY;
        for (int i = 0; i < 4; ++i) {
          for (int j = 0; j < i; ++j) {
            const Vec3 &p = mesh.vertices[static_cast<std::size_t>(i)], &q = mesh.vertices[static_cast<std::size_t>(j)];
            if ((p.z() > z) == (q.z() > z)) continue;
            const long double t = (static_cast<long double>(z) - p.z()) / (static_cast<long double>(q.z()) - p.z());
            const Long from = p.head<2>().cast<long double>(), to = q.head<2>().cast<long double>();
            nearest = std::min(nearest, (from + t * (to - from) - corner.cast<long double>()).norm());
          }
        }
        EXPECT_LE(nearest, bound);
      }
    }
  }
}

TEST(Slice, RefusesWhatIsNoSolid) {
  Mesh open = make_box_mesh({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  expect_code([&] { (void)slice_mesh(open, 0.5); }, ErrorCode::mesh_not_closed);
  Mesh turned = make_box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expect_code([&] { (void)slice_mesh(turned, 0.5); }, ErrorCode::mesh_not_oriented);
  expect_code([&] { (void)slice_mesh(make_box_mesh({0, 0, 0}, {1, 1, 1}), NAN); }, ErrorCode::value_out_of_range);
  EXPECT_TRUE(slice_mesh(Mesh(), 0).empty());
}

TEST(Footprint, OfBoxesIsTheirUnion) {
  for (const auto& [size, at] : kScales) {
    SCOPED_TRACE(size);
    Mesh mesh = make_box_mesh(at, at + size * Vec3(2, 2, 1));
    append(mesh, make_box_mesh(at + size * Vec3(1, 1, 2), at + size * Vec3(3, 3, 3)));  // over a corner of it
    const std::vector<PlanPolygon> footprint = footprint_of_mesh(mesh);
    ASSERT_EQ(footprint.size(), 1u);
    expect_in_order(footprint);
    EXPECT_EQ(footprint[0].outer.size(), 8u);
    EXPECT_NEAR(total_area(footprint), 7 * size * size, 12 * size * size * 0x1p-28);
  }
}

TEST(Footprint, HasHolesWhereNothingIsAbove) {
  const std::vector<PlanPolygon> ring = footprint_of_mesh(make_torus({0, 0, 0}, 3, 1, 96, 48));
  ASSERT_EQ(ring.size(), 1u);
  ASSERT_EQ(ring[0].holes.size(), 1u);
  EXPECT_NEAR(total_area(ring), std::numbers::pi * (16 - 4), 0.2);
  EXPECT_TRUE(footprint_of_mesh(Mesh()).empty());
}

/// A place is in the footprint if the line up through it meets the mesh.
TEST(Footprint, AgreesWithPointsInTheMesh) {
  Random random(12);
  for (int round = 0; round < 6; ++round) {
    const Vec3 at = round % 2 ? Vec3(5e5, 5e6, 300) : Vec3::Zero();
    Mesh mesh = testing::make_dome(at, 31, 9, [&](double, double) { return random.uniform(0.3, 1); }).mesh;
    const Eigen::AngleAxisd tilt(random.uniform(0, 3), random.direction());
    for (Vec3& v : mesh.vertices) v = at + tilt * (v - at);
    const std::vector<PlanPolygon> footprint = footprint_of_mesh(mesh);
    expect_in_order(footprint);
    const SolidIndex index(mesh);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = at + random.point(-1, 1);
      if (distance_to_rings(footprint, p.head<2>()) < 0.02) continue;
      std::vector<Vec3> column;
      for (int k = -200; k <= 200; ++k) column.emplace_back(p.x(), p.y(), at.z() + 0.005 * k);
      const std::vector<std::uint8_t> inside = index.contains(column);
      const bool is_under = std::count(inside.begin(), inside.end(), 1) > 0;
      EXPECT_TRUE(covers(footprint, p.head<2>()) || !is_under) << p.transpose();
    }
    // All of it is under something: what its triangles that face up cover.
    double largest = 0;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector2d a = (mesh.vertices[t[1]] - mesh.vertices[t[0]]).head<2>(),
                            b = (mesh.vertices[t[2]] - mesh.vertices[t[0]]).head<2>();
      largest += std::max(0.0, (a.x() * b.y() - a.y() * b.x()) / 2);
    }
    EXPECT_LE(total_area(footprint), largest * (1 + 1e-6));
  }
}

/// Where a volume is cut off at the target's plane, its sides are upright but for rounding: slivers that face up or
/// down.
TEST(Footprint, OfVolumesWithUprightSidesIsWhatFacesUp) {
  const std::uint64_t seed = 31;
  RecordProperty("seed", std::to_string(seed));
  Random random(seed);
  const testing::SceneBuilder scene =
      testing::SceneBuilder().ground("ground", 100).box("tower", {20, -5, 0}, {30, 15, 40});
  const PreparedScene prepared(scene);
  const Target target = testing::target_of({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}});
  for (double range = 20; range <= 100; range += 8) {
    SCOPED_TRACE(range);
    Sensor sensor;
    sensor.max_range_m = range;
    const Mesh mesh = compute_visibility(PreparedTarget(prepared, target, sensor)).mesh;
    const std::vector<PlanPolygon> footprint = footprint_of_mesh(mesh);
    expect_in_order(footprint);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d p = 1.2 * range * random.point(-1, 1).head<2>();
      if (distance_to_rings(footprint, p) < 1e-3) continue;
      const bool faces_up = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        double least = INFINITY;
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector2d a = mesh.vertices[t[k]].head<2>() - p, b = mesh.vertices[t[(k + 1) % 3]].head<2>() - p;
          least = std::min(least, a.x() * b.y() - a.y() * b.x());
        }
        return least > 0;
      });
      EXPECT_EQ(covers(footprint, p), faces_up) << p.transpose();
    }
  }
}

TEST(Footprint, RefusesWhatIsNoSolid) {
  Mesh open = make_box_mesh({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  expect_code([&] { (void)footprint_of_mesh(open); }, ErrorCode::mesh_not_closed);
}

}  // namespace
}  // namespace vantage
