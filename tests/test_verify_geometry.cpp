// The parts of the check, each against something simpler.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "verify/binomial.h"
#include "verify/closed_mesh.h"
#include "verify/limits.h"
#include "verify/occluders.h"
#include "verify/segment.h"
#include "verify/target_view.h"
#include "verify/view_pyramid.h"
#include "verify/viewpoints.h"

namespace vantage::internal::verify {
namespace {

using testing::append;
using testing::make_box_mesh;

const FlatTriangle kFlat({0, 0, 0}, {1, 0, 0}, {0, 1, 0});

Target square(double half, double height = 0) {
  Target target;
  target.parts[0] = {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
  return target;
}

// ---- segments and triangles ----

TEST(VerifySegment, CrossesTheInterior) {
  const Intersection hit = intersect(Segment({0.25, 0.25, 3}, {0.25, 0.25, -1}), kFlat);
  EXPECT_EQ(hit.contact, Contact::crossing);
  EXPECT_DOUBLE_EQ(hit.position, 0.75);
  EXPECT_NEAR(hit.border, 0.25, 1e-12);
  EXPECT_EQ(hit.turn, -1);
  EXPECT_EQ(intersect(Segment({0.25, 0.25, -1}, {0.25, 0.25, 3}), kFlat).turn, 1);
}

TEST(VerifySegment, MissesBesideAboveAndBelow) {
  EXPECT_EQ(intersect(Segment({0.75, 0.75, 3}, {0.75, 0.75, -1}), kFlat).contact, Contact::none);
  EXPECT_EQ(intersect(Segment({0.25, 0.25, 3}, {0.25, 0.25, 1}), kFlat).contact, Contact::none);
  EXPECT_EQ(intersect(Segment({0.25, 0.25, -3}, {0.25, 0.25, -1}), kFlat).contact, Contact::none);
}

TEST(VerifySegment, TouchingIsNotCrossing) {
  EXPECT_EQ(intersect(Segment({0.25, 0.25, 1}, {0.25, 0.25, 0}), kFlat).contact, Contact::unsure);  // ends on it
  EXPECT_EQ(intersect(Segment({0.5, 0, 1}, {0.5, 0, -1}), kFlat).contact, Contact::unsure);         // through an edge
  EXPECT_EQ(intersect(Segment({0, 0, 1}, {0, 0, -1}), kFlat).contact, Contact::unsure);             // through a corner
  EXPECT_EQ(intersect(Segment({-1, 0.25, 0}, {2, 0.25, 0}), kFlat).contact, Contact::unsure);       // in its plane
}

TEST(VerifySegment, ATriangleWithoutAreaIsNeverMet) {
  const FlatTriangle needle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  EXPECT_EQ(intersect(Segment({1, 1, 2}, {1, 1, 0}), needle).contact, Contact::none);
}

TEST(VerifySegment, ANeedleIsMissedBesideIt) {
  // Rounding leaves its plane open, for any segment within its box.
  const FlatTriangle needle({-100, -100, -100}, {100, 100, 100}, {0, 1e-10, 0});
  ASSERT_GT(needle.normal_length, 0);
  const std::uint64_t seed = 21;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in(-90, 90);
  int missed = 0;
  for (int i = 0; i < 10000; ++i) {
    const Segment segment({in(random), in(random), in(random)}, {in(random), in(random), in(random)});
    const Vec3 normal = segment.direction.cross(needle.edge1).normalized();
    const double away = std::abs(normal.dot(segment.from - needle.corner));  // of the two lines
    if (away < 1e-9) continue;
    EXPECT_EQ(intersect(segment, needle).contact, Contact::none) << i << ": " << away << " m";
    ++missed;
  }
  EXPECT_GT(missed, 9000);
  EXPECT_NE(intersect(Segment({1, 1, 3}, {1, 1, -1}), needle).contact, Contact::none);  // through it
  EXPECT_NE(intersect(Segment({5, 5, 5}, {6, 6, 6}), needle).contact, Contact::none);   // along it
}

TEST(VerifySegment, NeverCertainlyWrongNearBorders) {
  // Hits a few roundoffs to either side of an edge, where plain arithmetic errs: the answer may be unsure, never wrong.
  const std::uint64_t seed = 20;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in(-1, 1);
  int unsure = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 shift = 1000 * Vec3(in(random), in(random), in(random));
    const Vec3 a = shift + Vec3(in(random), in(random), in(random)),
               b = shift + Vec3(in(random), in(random), in(random));
    const Vec3 c = shift + Vec3(in(random), in(random), in(random));
    const FlatTriangle left(a, b, c), right(b, a, 2 * (0.5 * (a + b)) - c);  // neighbours across the edge ab
    if (left.normal_length < 1e-3) continue;
    const double share = 0.5 + 0.4 * in(random);
    const Vec3 across = (c - a).normalized();
    const Vec3 point = a + share * (b - a) + 1e-13 * in(random)*across;
    const Vec3 direction = 100 * Vec3(in(random), in(random), in(random));
    const Segment segment(point - direction, point + direction);
    if (std::abs(left.normal.dot(direction)) < left.normal_length) continue;
    const Contact first = intersect(segment, left).contact, second = intersect(segment, right).contact;
    EXPECT_FALSE(first == Contact::crossing && second == Contact::crossing);
    EXPECT_FALSE(first == Contact::none && second == Contact::none);
    unsure += first == Contact::unsure;
  }
  EXPECT_GT(unsure, 0);
}

TEST(VerifySegment, DistanceToATriangle) {
  EXPECT_DOUBLE_EQ(distance({0.25, 0.25, -2}, kFlat), 2);
  EXPECT_DOUBLE_EQ(distance({0.5, -3, 4}, kFlat), 5);            // to an edge
  EXPECT_DOUBLE_EQ(distance({1, 1, 0}, kFlat), std::sqrt(0.5));  // to the long edge
  EXPECT_DOUBLE_EQ(distance({4, -4, 0}, kFlat), 5);              // to a corner
}

// ---- closed meshes ----

TEST(VerifyClosedMesh, KnowsInsideFromOutside) {
  const Vec3 origin(580000, 4785000, 1000);
  Mesh mesh = make_box_mesh(origin - Vec3(1, 2, 3), origin + Vec3(1, 2, 3));
  Mesh hole = make_box_mesh(origin - Vec3::Constant(0.5), origin + Vec3::Constant(0.5));
  for (Triangle& triangle : hole.triangles) std::swap(triangle[0], triangle[1]);
  append(mesh, hole);
  const ClosedMesh solid(mesh, origin, "solid");
  EXPECT_TRUE(solid.topology().closed);
  EXPECT_TRUE(solid.topology().oriented);
  EXPECT_EQ(solid.topology().euler, 4);
  EXPECT_EQ(solid.contains({0.75, 0, 0}), true);
  EXPECT_EQ(solid.contains({0, 0, 0}), false);  // in the hole
  EXPECT_EQ(solid.contains({1.5, 0, 0}), false);
  EXPECT_EQ(solid.contains({1 - 1e-9, 1.9, -2.9}), true);
  EXPECT_EQ(solid.contains({1 + 1e-9, 1.9, -2.9}), false);
  EXPECT_EQ(solid.contains({1, 0.3, 0.3}), std::nullopt);  // on the surface
  EXPECT_NEAR(solid.distance_to_surface({0.75, 0, 0}), 0.25, 1e-9);
  EXPECT_NEAR(solid.distance_to_surface({0, 0, 0.2}), 0.3, 1e-9);
  EXPECT_NEAR(solid.distance_to_surface({1000, 0, 3}), 999, 1e-9);
}

TEST(VerifyClosedMesh, KnowsInsideFromOutsideInTheBoxOfANeedle) {
  // A box of which one edge is a triangle: from corner to corner of the bounds run two needles.
  Mesh mesh = make_box_mesh({-100, -100, -100}, {0, 0, 0});
  append(mesh, Mesh{{{-100, -100, -100}, {100, 100, 100}, {0, 1e-10, 0}, {1e-10, 0, 0}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}});
  const ClosedMesh closed(mesh, Vec3::Zero(), "needle");
  EXPECT_EQ(closed.contains({-90, -10, -30}), true);
  EXPECT_EQ(closed.contains({90, 10, 30}), false);
  EXPECT_EQ(closed.contains({-50, 60, 30}), false);
}

TEST(VerifyClosedMesh, CountsParityWhereTrianglesRunEitherWay) {
  Mesh mesh = make_box_mesh({-1, -1, -1}, {1, 1, 1});
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const ClosedMesh solid(mesh, Vec3::Zero(), "solid");
  EXPECT_TRUE(solid.topology().closed);
  EXPECT_FALSE(solid.topology().oriented);
  EXPECT_EQ(solid.contains({0.1, 0.2, 0.3}), true);
  EXPECT_EQ(solid.contains({0.1, 0.2, 1.3}), false);
}

TEST(VerifyClosedMesh, JoinsVerticesAtOnePosition) {
  const Mesh box = make_box_mesh({-1, -1, -1}, {1, 1, 1});
  Mesh soup;
  for (const Triangle& triangle : box.triangles) {
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : triangle) soup.vertices.push_back(box.vertices[corner]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  const ClosedMesh solid(soup, Vec3::Zero(), "solid");
  EXPECT_TRUE(solid.topology().closed);
  EXPECT_TRUE(solid.topology().oriented);
  EXPECT_EQ(solid.topology().euler, 2);
}

TEST(VerifyClosedMesh, RefusesAnOpenMesh) {
  Mesh mesh = make_box_mesh({-1, -1, -1}, {1, 1, 1});
  mesh.triangles.pop_back();
  testing::expect_error([&] { ClosedMesh(mesh, Vec3::Zero(), "keep-in mesh 'airspace'"); }, ErrorCode::mesh_not_closed,
                        "'airspace', edge");
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_THROW(ClosedMesh(mesh, Vec3::Zero(), "x"), Error);
  EXPECT_THROW(ClosedMesh({}, Vec3::Zero(), "x"), Error);
  mesh = make_box_mesh({-1, -1, -1}, {1, 1, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_THROW(ClosedMesh(mesh, Vec3::Zero(), "x"), Error);
}

TEST(VerifyClosedMesh, AgreesWithASphereAndAPlainLoop) {
  const std::uint64_t seed = 21;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in(-1.2, 1.2);
  const Mesh mesh = testing::make_hemisphere(Vec3::Zero(), 1, 200, 100).mesh;
  const ClosedMesh solid(mesh, Vec3::Zero(), "hemisphere");
  for (int i = 0; i < 3000; ++i) {
    const Vec3 point(in(random), in(random), in(random));
    const bool deep = point.norm() < 0.999 && point.z() > 0, out = point.norm() > 1 || point.z() < 0;
    if (deep || out) {
      ASSERT_EQ(solid.contains(point), deep) << point.transpose();
    }
    if (i % 30 > 0) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const FlatTriangle& triangle : solid.triangles()) nearest = std::min(nearest, distance(point, triangle));
    ASSERT_EQ(solid.distance_to_surface(point), nearest);
  }
}

// ---- target, limits, pyramid ----

TEST(VerifyTarget, LooksUpFromTheGroundWhicheverWayItIsDrawn) {
  Target target = square(2, 5);
  EXPECT_NEAR(TargetView(target).normal().z(), 1, 1e-15);
  std::reverse(target.parts[0].begin(), target.parts[0].end());
  EXPECT_NEAR(TargetView(target).normal().z(), 1, 1e-15);
  target.front = Vec3(0.1, 0, -1);
  target.offset_m = 0.25;
  const TargetView below(target);
  EXPECT_NEAR(below.normal().z(), -1, 1e-15);
  EXPECT_NEAR((below.origin() + below.centre()).z(), 4.75, 1e-15);
  EXPECT_NEAR(below.height({0, 0, -1}), 0.75, 1e-15);
  EXPECT_TRUE(below.over({2.0009, 0, 7}, 1e-3));
  EXPECT_FALSE(below.over({2.0011, 0, 7}, 1e-3));
  EXPECT_NEAR(below.farthest(below.centre()), std::sqrt(8.0), 1e-12);
}

TEST(VerifyTarget, AFacadeLooksToWhereItRunsCounterClockwise) {
  Target target;
  target.parts[0] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}};
  EXPECT_NEAR(TargetView(target).normal().y(), -1, 1e-15);
  std::reverse(target.parts[0].begin(), target.parts[0].end());
  EXPECT_NEAR(TargetView(target).normal().y(), 1, 1e-15);
}

TEST(VerifyTarget, InteriorPointsCoverThePolygonEvenly) {
  Target target;
  target.parts[0] = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {2, 3, 0}, {0, 1, 0}};
  const TargetView view(target);
  Vec3 sum = Vec3::Zero();
  constexpr int kSide = 400;
  for (int i = 0; i < kSide; ++i) {
    for (int k = 0; k < kSide; ++k) {
      const Vec3 point = view.interior((i + 0.5) / kSide, (k + 0.5) / kSide);
      ASSERT_TRUE(view.over(point, 1e-12));
      sum += point + view.origin();
    }
  }
  const Vec3 centroid(2, (4 * 0.5 + 4 * (1 + 2.0 / 3)) / 8, 0);  // a 4 x 1 rectangle under a triangle of height 2
  EXPECT_LT((sum / (kSide * kSide) - centroid).norm(), 1e-3);
}

TEST(VerifyTarget, RefusesWhatIsNoConvexPolygon) {
  Target target = square(1);
  target.parts[0].resize(2);
  EXPECT_THROW(TargetView{target}, Error);
  target = square(1);
  target.parts[0][2] = {-0.5, -0.5, 0};
  EXPECT_THROW(TargetView{target}, Error);  // a dart
  target = square(1);
  target.parts[0][2].z() = 0.1;
  EXPECT_THROW(TargetView{target}, Error);  // not planar
  target = square(1);
  target.front = Vec3(1, 1, 0);
  EXPECT_THROW(TargetView{target}, Error);  // edge-on
  target.parts[0] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  EXPECT_THROW(TargetView{target}, Error);  // no area
}

TEST(VerifyLimits, NamesTheFirstBroken) {
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{0, 10};
  navigation.keep_in = {Box{Vec3(-5, -5, -50), Vec3(0, 5, 50)}, Box{Vec3(0, -5, -50), Vec3(5, 5, 50)}};
  navigation.keep_out = {Box{Vec3(1, 1, 1), Vec3(2, 2, 2)}};
  navigation.meshes = {{make_box_mesh({-4, -4, -4}, {4, 4, 40}), "airspace"}};
  const Vec3 origin(100, 0, 0);
  const Limits limits(navigation, origin);
  const auto broken = [&](const Vec3& scene_point) { return limits.broken_by(scene_point - origin); };
  EXPECT_EQ(broken({0, 0, 5}), std::nullopt);  // on the border of both boxes
  EXPECT_EQ(broken({0, 0, -1}), "altitude min");
  EXPECT_EQ(broken({0, 0, 11}), "altitude max");
  EXPECT_EQ(broken({6, 0, 5}), "keep_in");
  EXPECT_EQ(broken({1.5, 1.5, 1.5}), "keep_out zone 0");
  EXPECT_EQ(broken({1.5, 1.5, 2}), std::nullopt);
  EXPECT_EQ(broken({4.5, 0, 5}), "mesh airspace");
}

TEST(VerifyPyramid, AimsAtTheMiddleOfWhatReachesIn) {
  const TargetView view(square(1));
  const ViewPyramid pyramid({0, 0, 10}, view);
  // A sliver that reaches a micrometre into the pyramid: half way up, where the pyramid is one metre wide.
  const FlatTriangle sliver({0.5 - 1e-6, 0, 5}, {3, -1, 5}, {3, 1, 5});
  const auto aim = pyramid.aim(sliver, 0);
  ASSERT_TRUE(aim);
  EXPECT_NEAR(aim->x(), 1, 2e-6);
  EXPECT_LT(aim->x(), 1);
  EXPECT_NEAR(aim->z(), 0, 1e-12);
  EXPECT_FALSE(pyramid.aim(sliver, 6));
  EXPECT_FALSE(pyramid.aim({{0.5 + 1e-6, 0, 5}, {3, -1, 5}, {3, 1, 5}}, 0));
  EXPECT_FALSE(pyramid.aim({{-9, -9, 11}, {9, -9, 11}, {0, 9, 11}}, 0));  // behind the viewpoint
}

TEST(VerifyOccluders, FindsAShadowThinnerThanAnySample) {
  Scene scene;
  scene.mesh = make_box_mesh({0.1, 0.2, 4}, {0.1 + 1e-6, 0.2 + 1e-6, 5});
  const TargetView view(square(5));
  const Occluders occluders(scene, view, 100);
  std::size_t rays = 0;
  const Vec3 viewpoint = Vec3(0, 0, 9) - view.origin();
  const auto hidden = occluders.find_hidden(viewpoint, rays);
  ASSERT_TRUE(hidden);
  EXPECT_GT(rays, 0u);
  EXPECT_TRUE(occluders.hide(viewpoint, *hidden));
  EXPECT_TRUE(occluders.first_hit(viewpoint, *hidden));
  EXPECT_FALSE(occluders.find_hidden(Vec3(0, 0, 3) - view.origin(), rays));  // from underneath
}

TEST(VerifyOccluders, TheSurfaceUnderTheTargetDoesNotHideIt) {
  const TargetView view(square(5));
  const auto sees = [&](double low, double high, double from, double to) {
    Scene scene;
    scene.mesh = make_box_mesh({from, -1, low}, {to, 1, high});
    const Occluders occluders(scene, view, 100);
    std::size_t rays = 0;
    return !occluders.find_hidden(Vec3(0, 0, 9) - view.origin(), rays);
  };
  EXPECT_TRUE(sees(-1, 0, -50, 50));      // the ground
  EXPECT_TRUE(sees(-1, 0.9e-3, -2, 2));   // less than a millimetre of relief
  EXPECT_FALSE(sees(-1, 1.1e-3, -2, 2));  // more
}

// ---- statistics ----

TEST(VerifyBinomial, BoundsTheShare) {
  EXPECT_NEAR(upper_share_bound(0, 1000), 1 - std::pow(0.05, 1e-3), 1e-15);
  EXPECT_NEAR(upper_share_bound(1, 2), std::sqrt(0.95), 1e-12);       // 1 - p^2 = 0.05
  EXPECT_NEAR(upper_share_bound(9, 10), std::pow(0.95, 0.1), 1e-12);  // 1 - p^10 = 0.05
  EXPECT_EQ(upper_share_bound(0, 0), 1);
  EXPECT_EQ(upper_share_bound(7, 7), 1);
  // 3 of 20: (1-p)^20 + 20 p (1-p)^19 + 190 p^2 (1-p)^18 + 1140 p^3 (1-p)^17 = 0.05.
  const double p = upper_share_bound(3, 20), q = 1 - p;
  EXPECT_NEAR(
      std::pow(q, 20) + 20 * p * std::pow(q, 19) + 190 * p * p * std::pow(q, 18) + 1140 * p * p * p * std::pow(q, 17),
      0.05, 1e-12);
  // A large count: near the normal approximation, and above it.
  const double large = upper_share_bound(50000, 100000);
  EXPECT_NEAR(large, 0.5 + 1.645 * std::sqrt(0.25 / 100000), 2e-5);
}

TEST(VerifyViewpoints, AreUniformInsideAndCoverEveryFacet) {
  const ClosedMesh volume(make_box_mesh({-8, -1, 0}, {8, 1, 0.5}), Vec3::Zero(), "box");
  const TargetView view(square(1));
  constexpr std::size_t kCount = 8000;
  const Viewpoints viewpoints(volume, view, 50, kCount);
  std::size_t inside = 0, left = 0;
  std::vector<int> near_facet(12, 0);
  for (std::size_t i = 0; i < kCount; ++i) {
    Random random(1, i);
    const Viewpoint viewpoint = viewpoints.draw(i, random);
    if (viewpoint.uniform && volume.contains(viewpoint.position) == true) {
      ++inside;
      left += viewpoint.position.x() < -4;
    }
    if (i % 8 < 4) continue;
    for (std::size_t facet = 0; facet < 12; ++facet) {
      near_facet[facet] += distance(viewpoint.position, volume.triangles()[facet]) < 1e-4;
    }
  }
  EXPECT_GT(inside, kCount / 4);
  EXPECT_NEAR(static_cast<double>(left) / static_cast<double>(inside), 0.25, 0.03);
  for (const int count : near_facet) EXPECT_GT(count, 50);
}

}  // namespace
}  // namespace vantage::internal::verify
