#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/progress_reporter.h"
#include "core/solid_check.h"
#include "core/triangle_contact.h"
#include "core/triangle_tree.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

using vantage::testing::append;
using vantage::testing::make_box_mesh;
using vantage::testing::make_hemisphere;
using vantage::testing::Random;

bool is_solid(const Mesh& mesh) {
  try {
    checked_solid(mesh, "airspace.ply");
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    return false;
  }
}

void expect_refused(const Mesh& mesh, ErrorCode code) {
  vantage::testing::expect_error([&] { checked_solid(mesh, "airspace.ply"); }, code, "airspace.ply");
}

Mesh two_boxes(const Vec3& min, const Vec3& max) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(2, 2, 2));
  append(mesh, make_box_mesh(min, max));
  return mesh;
}

void flip(Mesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// The same triangles, each with corners of its own, as an STL file has them.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  return soup;
}

void transform(Mesh& mesh, const Eigen::Matrix3d& rotation, const Vec3& offset) {
  for (Vec3& v : mesh.vertices) v = rotation * v + offset;
}

TEST(SolidCheck, AcceptsSolids) {
  EXPECT_TRUE(is_solid(make_box_mesh(Vec3(0, 0, 0), Vec3(1, 2, 3))));
  EXPECT_TRUE(is_solid(make_hemisphere(Vec3(580000, 4785000, 1000), 100).mesh));
  EXPECT_TRUE(is_solid(two_boxes(Vec3(3, 0, 0), Vec3(4, 1, 1))));
}

TEST(SolidCheck, WeldsEqualPositions) {
  const Mesh box = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 2, 3));
  Mesh soup = soup_of(box);
  soup.triangles.push_back({0, 0, 1});
  const Mesh welded = checked_solid(soup, "airspace.stl");
  EXPECT_EQ(welded.vertices.size(), 8u);
  EXPECT_EQ(welded.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(enclosed_volume(welded), 6);
}

TEST(SolidCheck, SaysHowManyEdgesAreOpenAndWhere) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.pop_back();
  const Error error = vantage::testing::error_of([&] { checked_solid(mesh, "airspace.ply"); });
  EXPECT_EQ(error.code(), ErrorCode::mesh_not_closed);
  EXPECT_NE(error.where().find("(1, 0, 0) to (1, 0, 1)"), std::string::npos) << error.where();
  mesh.triangles.clear();
  expect_refused(mesh, ErrorCode::mesh_empty);
}

TEST(SolidCheck, SaysWhereTrianglesTurnDifferentWays) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  expect_refused(mesh, ErrorCode::mesh_not_oriented);
}

TEST(SolidCheck, RefusesInnerFaces) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.push_back({0, 3, 7});
  mesh.triangles.push_back({0, 7, 4});
  EXPECT_FALSE(is_solid(mesh));
}

TEST(SolidCheck, RefusesBadNumbers) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.vertices[3].z() = INFINITY;
  expect_refused(mesh, ErrorCode::coordinate_not_finite);
  mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles[3][1] = 8;
  expect_refused(mesh, ErrorCode::index_out_of_range);
  mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 0));
  EXPECT_FALSE(is_solid(mesh));  // flat
}

TEST(SolidCheck, RefusesInsideOut) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  flip(mesh);
  expect_refused(mesh, ErrorCode::mesh_inside_out);
  Mesh small = make_box_mesh(Vec3(3, 0, 0), Vec3(3.5, 0.5, 0.5));
  flip(small);
  Mesh mixed = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  append(mixed, small);
  expect_refused(mixed, ErrorCode::mesh_inside_out);
}

TEST(SolidCheck, AcceptsCavitiesAndRefusesNestedSolids) {
  Mesh inner = make_box_mesh(Vec3(0.5, 0.5, 0.5), Vec3(1.5, 1.5, 1.5));
  Mesh nested = two_boxes(Vec3(0.5, 0.5, 0.5), Vec3(1.5, 1.5, 1.5));
  expect_refused(nested, ErrorCode::mesh_intersects_itself);
  flip(inner);
  Mesh hollow = make_box_mesh(Vec3(0, 0, 0), Vec3(2, 2, 2));
  append(hollow, inner);
  EXPECT_TRUE(is_solid(hollow));
}

TEST(SolidCheck, RefusesPartsThatPassThroughEachOther) {
  expect_refused(two_boxes(Vec3(1, 0.5, 0.5), Vec3(3, 1.5, 1.75)), ErrorCode::mesh_intersects_itself);
}

TEST(SolidCheck, RefusesDegenerateOverlaps) {
  // Flush on all sides but one; flush on some; the same box twice; edges that run exactly through corners and
  // diagonals.
  EXPECT_FALSE(is_solid(two_boxes(Vec3(1, 0, 0), Vec3(3, 2, 2))));
  EXPECT_FALSE(is_solid(two_boxes(Vec3(1, 0, 0), Vec3(3, 2, 1))));
  EXPECT_FALSE(is_solid(two_boxes(Vec3(0, 0, 0), Vec3(2, 2, 2))));
  EXPECT_FALSE(is_solid(two_boxes(Vec3(0, 0, 0), Vec3(1, 1, 1))));
  EXPECT_FALSE(is_solid(two_boxes(Vec3(1, 1, 1), Vec3(3, 3, 3))));
  EXPECT_FALSE(is_solid(two_boxes(Vec3(0.5, 0.5, -1), Vec3(1.5, 1.5, 3))));
  // A tower whose ring of edges lies exactly in the top of the box that it stands in: no triangle passes through
  // another.
  Mesh tower = make_box_mesh(Vec3(0.5, 0.5, 0.5), Vec3(1.5, 1.5, 2));
  Mesh upper = make_box_mesh(Vec3(0.5, 0.5, 2), Vec3(1.5, 1.5, 3));
  tower.triangles.erase(tower.triangles.begin() + 2, tower.triangles.begin() + 4);  // its top
  upper.triangles.erase(upper.triangles.begin(), upper.triangles.begin() + 2);      // its bottom
  append(tower, upper);
  EXPECT_TRUE(is_solid(soup_of(tower)));
  append(tower, make_box_mesh(Vec3(0, 0, 0), Vec3(2, 2, 2)));
  expect_refused(soup_of(tower), ErrorCode::mesh_intersects_itself);
}

TEST(SolidCheck, AcceptsPartsThatTouch) {
  EXPECT_TRUE(is_solid(two_boxes(Vec3(2, 0, 0), Vec3(4, 2, 2))));      // face to face
  EXPECT_TRUE(is_solid(two_boxes(Vec3(2, 0.5, 0.5), Vec3(4, 1, 1))));  // face within a face
  EXPECT_TRUE(is_solid(two_boxes(Vec3(2, 2, 0), Vec3(4, 4, 2))));      // edge to edge
  EXPECT_TRUE(is_solid(two_boxes(Vec3(2, 2, 1), Vec3(4, 4, 5))));      // part of an edge
  EXPECT_TRUE(is_solid(two_boxes(Vec3(2, 2, 2), Vec3(4, 4, 4))));      // corner to corner
}

TEST(SolidCheck, FacetsThatPassEachOtherByDoNotCross) {
  // Two of a volume, all but parallel and 0.1 mm apart, less than the touching distance: there corners of each count as
  // in the plane of the other. Each with a point behind it.
  const auto with_apex = [](const Vec3& a, const Vec3& b, const Vec3& c, double side) {
    const Vec3 apex = (a + b + c) / 3 - side * (b - a).cross(c - a).normalized();
    return side > 0 ? Mesh{{a, b, c, apex}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}}
                    : Mesh{{a, b, c, apex}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  };
  Mesh mesh = with_apex({42.81496849, 3.94295094, 43.20660073}, {43.57096166, 2.98966011, 42.60739977},
                        {44.47537542, 8.87794017, 37.4230532}, 1);
  append(mesh, with_apex({43.59360311, 2.10810867, 43.13461707}, {43.5908172, 3.00243665, 42.5679659},
                         {43.13018076, 2.48246799, 43.61795076}, -1));
  append(mesh, make_box_mesh(Vec3(-80, -80, 0), Vec3(-79, -79, 1)));
  append(mesh, make_box_mesh(Vec3(60, 60, 0), Vec3(61, 61, 1)));
  EXPECT_TRUE(is_solid(mesh));
}

TEST(SolidCheck, RoundingOfFlushWallsIsNoOverlap) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 50; ++i) {
    const Vec3 axis(uniform(random), uniform(random), uniform(random));
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(3 * uniform(random), axis.normalized()).toRotationMatrix();
    Mesh touching = two_boxes(Vec3(2, 0.3, 0.4), Vec3(4, 1, 1.1));
    transform(touching, rotation, Vec3(uniform(random), uniform(random), uniform(random)));
    for (Vec3& v : touching.vertices) v = v.cast<float>().cast<double>();
    EXPECT_TRUE(is_solid(touching)) << "seed 7, case " << i;
    Mesh overlapping = two_boxes(Vec3(1.999, 0.3, 0.4), Vec3(4, 1, 1.1));
    transform(overlapping, rotation, Vec3(580000, 4785000, 1000));
    EXPECT_FALSE(is_solid(overlapping)) << "seed 7, case " << i;
  }
}

TEST(SolidCheck, RandomRotatedBoxesAgreeWithSeparatingAxes) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int meet = 0, apart = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 axis(uniform(random), uniform(random), uniform(random));
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(3 * uniform(random), axis.normalized()).toRotationMatrix();
    const Vec3 offset = 3 * Vec3(uniform(random), uniform(random), uniform(random));
    Mesh a = make_box_mesh(Vec3(-1, -1, -1), Vec3(1, 1, 1)), b = a;
    transform(b, rotation, offset);
    // Two convex bodies are apart when one of their face normals or products of edge directions separates them.
    double gap = -INFINITY;
    const auto try_axis = [&](const Vec3& direction) {
      if (direction.norm() < 1e-9) return;
      const Vec3 d = direction.normalized();
      double a_max = -INFINITY, b_min = INFINITY;
      for (const Vec3& v : a.vertices) a_max = std::max(a_max, d.dot(v));
      for (const Vec3& v : b.vertices) b_min = std::min(b_min, d.dot(v));
      gap = std::max(gap, b_min - a_max);
    };
    for (int j = 0; j < 3; ++j) {
      for (const double sign : {1.0, -1.0}) {
        try_axis(sign * Vec3::Unit(j));
        try_axis(sign * rotation.col(j));
        for (int k = 0; k < 3; ++k) try_axis(sign * Vec3::Unit(j).cross(rotation.col(k)));
      }
    }
    if (std::abs(gap) < 1e-5) continue;
    (gap > 0 ? apart : meet) += 1;
    append(a, b);
    EXPECT_EQ(is_solid(a), gap > 0) << "seed " << seed << ", case " << i << ", gap " << gap;
  }
  EXPECT_GT(meet, 50);
  EXPECT_GT(apart, 50);
}

TEST(SolidCheck, FindsAFoldThatPassesThroughTheOtherSide) {
  Mesh mesh = make_hemisphere(Vec3(0, 0, 0), 10, 32, 16).mesh;
  EXPECT_TRUE(is_solid(mesh));
  mesh.vertices[mesh.vertices.size() - 2].z() = -3;  // the pole, pulled through the floor
  EXPECT_FALSE(is_solid(mesh));
}

TEST(SolidCheck, CanBeStopped) {
  const Mesh mesh = make_hemisphere(Vec3(0, 0, 0), 10, 100, 50).mesh;
  const auto story = testing::check_progress(
      [&](const Progress& progress) { checked_solid(mesh, "airspace.ply", core::ProgressReporter(progress)); });
  EXPECT_GT(story.calls, mesh.triangles.size() / 256);
}

TEST(TriangleContact, KindsOfContact) {
  const std::array<Vec3, 3> floor = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto contact = [&](const Vec3& a, const Vec3& b, const Vec3& c, int shared = 0) {
    const std::array<Vec3, 3> other = {a, b, c};
    const Contact forth = contact_of(floor, other, shared, 1e-6);
    EXPECT_EQ(contact_of(other, floor, shared, 1e-6), forth);
    return forth;
  };
  EXPECT_EQ(contact(Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(2, 1, 1)), Contact::crossing);
  EXPECT_EQ(contact(Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 1)), Contact::touching);      // stands on an edge
  EXPECT_EQ(contact(Vec3(1, 1, 0), Vec3(2, 1, 1), Vec3(1, 1, 1)), Contact::none);          // stands on a corner
  EXPECT_EQ(contact(Vec3(1, 1, -1e-7), Vec3(1, 1, 1), Vec3(2, 1, 1)), Contact::none);      // not deep enough
  EXPECT_EQ(contact(Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)), Contact::touching);      // in one plane
  EXPECT_EQ(contact(Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(4, 4, 0), 2), Contact::none);       // neighbours in one plane
  EXPECT_EQ(contact(Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 0, 4), 2), Contact::none);       // neighbours at a wall
  EXPECT_EQ(contact(Vec3(0, 0, 0), Vec3(-4, 0, 0), Vec3(0, 0, 4), 1), Contact::none);      // they share a corner
  EXPECT_EQ(contact(Vec3(0, 0, 0), Vec3(3, 3, 1), Vec3(3, 3, -1), 1), Contact::crossing);  // and cross beyond it
  EXPECT_EQ(contact(Vec3(5, 5, -1), Vec3(5, 5, 1), Vec3(9, 9, 0)), Contact::none);         // apart
  EXPECT_EQ(contact(Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)), Contact::none);          // parallel
  EXPECT_EQ(contact(Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 0)), Contact::none);         // a needle
}

TEST(TriangleTree, WindingNumbersOfADome) {
  const Mesh mesh = make_hemisphere(Vec3(0, 0, 0), 10, 64, 32).mesh;
  const TriangleTree tree(mesh);
  const unsigned seed = 5;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-11, 11);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(uniform(random), uniform(random), uniform(random));
    if (std::abs(p.norm() - 10) < 0.1 || std::abs(p.z()) < 1e-6) continue;
    EXPECT_EQ(tree.winding_number(p), p.z() > 0 && p.norm() < 10 ? 1 : 0) << "seed " << seed << ", case " << i;
  }
  EXPECT_EQ(tree.winding_number(Vec3(0, 0, 5)), 1);  // on the axis, above a vertex of the floor
}

/// Of upright boxes, comparing coordinates tells: also on faces, edges and corners and a few roundings off them, where
/// no ray is clear.
TEST(TriangleTree, DecidesOnTheSurfaceAndBesideIt) {
  Random random(51);
  int on_surface = 0, inside = 0;
  for (int i = 0; i < 200; ++i) {
    const double scale = std::pow(10.0, random.integer(-3, 4));
    const Vec3 low = scale * random.point(-1, 1);
    const Vec3 high = low + scale * random.point(0.1, 2);
    const Mesh mesh = make_box_mesh(low, high);
    const TriangleTree tree(mesh);
    for (int k = 0; k < 50; ++k) {
      Vec3 point;
      for (int axis = 0; axis < 3; ++axis) {
        double& at = point[axis] = random.uniform(low[axis], high[axis]);
        if (random.integer(0, 2) == 0) continue;
        at = random.integer(0, 1) == 0 ? low[axis] : high[axis];
        for (int steps = random.integer(-2, 2); steps != 0; steps -= steps > 0 ? 1 : -1) {
          at = std::nextafter(at, steps > 0 ? 1e9 : -1e9);
        }
      }
      const bool is_in = (point.array() > low.array()).all() && (point.array() < high.array()).all();
      const bool is_out = (point.array() < low.array()).any() || (point.array() > high.array()).any();
      EXPECT_EQ(tree.winding_number(point), is_in ? 1 : 0) << "box " << i << ", point " << k;
      on_surface += !is_in && !is_out;
      inside += is_in;
    }
  }
  EXPECT_GT(on_surface, 1000);
  EXPECT_GT(inside, 1000);
}

}  // namespace
}  // namespace vantage::internal::core
