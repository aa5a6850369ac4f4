// What must hold of every visibility volume, whatever the scene.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "support/blocker_solids.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::farthest_vertex;
using testing::local_box;
using testing::make_box_mesh;
using testing::MeshProbe;
using testing::Random;
using testing::random_city;
using testing::random_target;

constexpr double kRange = 80, kTolerance = 0.1;

Volume compute(const Scene& scene, const Target& target, double range = kRange, double tolerance = kTolerance) {
  Volume volume = compute_visibility(PreparedTarget(PreparedScene(scene), target, Sensor{range}), {tolerance, 0});
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures m = measure(volume.mesh);
  EXPECT_TRUE(m.closed && m.oriented && m.euler == 2 && m.pieces == 1);
  return volume;
}

Target ground_target(Random& random) {
  return random_target(random, random.integer(3, 8), random.uniform(2, 6), Vec3(0, 0, 0.1), Vec3(0, 0, 1));
}

/// The mesh as a solid in a frame of choice.
solid::Solid in_frame(const Volume& volume, const TargetFrame& frame) {
  Volume moved = volume;
  moved.frame = frame;
  return testing::local_solid(moved);
}

/// Inside every range region of a target near the origin, by more than the tolerance.
solid::Solid inner_box(const TargetFrame& frame) { return local_box(frame, 38, 45); }

/// Cubic metres of `inner` outside `outer`, in the box.
double excess(const solid::Solid& inner, const solid::Solid& outer, const solid::Solid& box) {
  return solid::subtract(solid::intersect(inner, box), outer).volume();
}

/// No point of `smaller` is outside `larger`, but for the facets of the range sphere.
void expect_within(const Volume& smaller, const Volume& larger, Random& random) {
  const MeshProbe inner(smaller), outer(larger);
  for (int k = 0; k < 400; ++k) {
    const Vec3 p = inner.draw(random);
    const double slack = 1e-6 * (p - larger.frame.origin).norm();
    if (inner.depth(p) < slack || farthest_vertex(larger.frame, p) > kRange - kTolerance) continue;
    ASSERT_GT(outer.depth(p), -slack) << p.transpose();
  }
}

TEST(ExactProperties, AnotherOccluderNeverGrowsTheVolume) {
  Random random(101);
  double taken = 0;
  for (int draw = 0; draw < 8; ++draw) {
    SCOPED_TRACE(draw);
    const Target target = ground_target(random);
    const Scene fewer = random_city(random, 25, 8);
    Scene more = fewer;
    const Vec3 min(random.integer(8, 20), random.integer(-20, 20), random.integer(0, 2));
    testing::append(more.mesh, make_box_mesh(min, min + random.point(1, 9)));
    more.object_of.resize(more.mesh.triangles.size(), 0);
    const Volume before = compute(fewer, target), after = compute(more, target);
    const solid::Solid box = inner_box(before.frame);
    const solid::Solid large = in_frame(before, before.frame), small = in_frame(after, before.frame);
    EXPECT_LT(excess(small, large, box), 1e-6 * large.volume());
    taken += excess(large, small, box);
    expect_within(after, before, random);
  }
  EXPECT_GT(taken, 0);
}

TEST(ExactProperties, AGreaterTargetNeverGrowsTheVolume) {
  Random random(103);
  for (int draw = 0; draw < 8; ++draw) {
    SCOPED_TRACE(draw);
    const Scene scene = random_city(random, 25, 8);
    const Target great = ground_target(random);
    Target part = great;  // without a corner, or with its corners pulled in
    if (great.parts[0].size() > 3 && draw % 2) {
      part.parts[0].pop_back();
    } else {
      for (Vec3& v : part.parts[0]) v = 0.5 * v + 0.5 * great.parts[0][0];
    }
    const Volume of_great = compute(scene, great), of_part = compute(scene, part);
    const solid::Solid box = inner_box(of_great.frame);
    const solid::Solid small = in_frame(of_great, of_great.frame), large = in_frame(of_part, of_great.frame);
    EXPECT_LT(excess(small, large, box), 1e-6 * large.volume());
    expect_within(of_great, of_part, random);
  }
}

TEST(ExactProperties, SeeingBothHalvesIsSeeingTheWhole) {
  Random random(107);
  for (int draw = 0; draw < 8; ++draw) {
    SCOPED_TRACE(draw);
    const Scene scene = random_city(random, 25, 8);
    Target whole = random_target(random, random.integer(4, 8), random.uniform(2, 6), {0, 0, 0.1}, {0, 0, 1});
    const auto& v = whole.parts[0];
    Target left, right;  // cut from the first vertex to another one, or to the middle of a side
    const std::size_t cut = static_cast<std::size_t>(random.integer(2, static_cast<int>(v.size()) - 2));
    const Vec3 end = draw % 2 ? v[cut] : Vec3(0.5 * (v[cut - 1] + v[cut]));
    left.parts[0].assign(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(cut));
    left.parts[0].push_back(end);
    right.parts[0].push_back(v[0]);
    if (draw % 2 == 0) right.parts[0].push_back(end);
    right.parts[0].insert(right.parts[0].end(), v.begin() + static_cast<std::ptrdiff_t>(cut), v.end());
    const Volume all = compute(scene, whole);
    const solid::Solid box = inner_box(all.frame), expected = in_frame(all, all.frame);
    const solid::Solid both =
        solid::intersect(in_frame(compute(scene, left), all.frame), in_frame(compute(scene, right), all.frame));
    EXPECT_LT(excess(both, expected, box), 1e-6 * expected.volume());
    EXPECT_LT(excess(expected, both, box), 1e-6 * expected.volume());
  }
}

TEST(ExactProperties, RigidMotionChangesNothing) {
  Random random(109);
  for (int draw = 0; draw < 8; ++draw) {
    SCOPED_TRACE(draw);
    const Scene scene = random_city(random, 25, 8);
    Target target = ground_target(random);
    target.front = Vec3(0, 0, 1);
    const Volume base = compute(scene, target);
    const Vec3 axis = draw % 2 ? Vec3(0, 0, 1) : random.direction(), shift = random.point(-500, 500);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 6), axis).toRotationMatrix();
    Scene moved = scene;
    for (Vec3& v : moved.mesh.vertices) v = turn * v + shift;
    Target moved_target = target;
    for (Vec3& v : moved_target.parts[0]) v = turn * v + shift;
    moved_target.front = turn * *target.front;
    const Volume other = compute(moved, moved_target);
    Volume back = other;
    for (Vec3& v : back.mesh.vertices) v = turn.transpose() * (v - shift);
    const solid::Solid box = inner_box(base.frame), here = in_frame(base, base.frame),
                       there = in_frame(back, base.frame);
    EXPECT_LT(excess(here, there, box), 1e-6 * here.volume());
    EXPECT_LT(excess(there, here, box), 1e-6 * here.volume());
    EXPECT_NEAR(enclosed_volume(base.mesh), enclosed_volume(other.mesh), kTolerance * surface_area(base.mesh));
    const MeshProbe one(base), two(other);
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = random.in_box(one.bounds());
      if (farthest_vertex(base.frame, p) > kRange - kTolerance) continue;
      const double d = one.depth(p), slack = 1e-6 * (p - base.frame.origin).norm();
      if (std::abs(d) < slack) continue;
      EXPECT_GT(d * two.depth(turn * p + shift), 0) << p.transpose();
    }
  }
}

/// What is not range sphere is the same to a micrometre. Where rounding differs, facets of the sphere may be cut
/// differently, within the tolerance.
void expect_same_surface(const Volume& one, const Volume& other, const Vec3& shift) {
  EXPECT_NEAR(enclosed_volume(one.mesh), enclosed_volume(other.mesh), kTolerance * surface_area(one.mesh));
  for (const auto& [a, b, by] : {std::tuple{&one, &other, Vec3(-shift)}, {&other, &one, shift}}) {
    const MeshProbe probe(*a);
    for (const Vec3& v : b->mesh.vertices) {
      const bool sphere = farthest_vertex(b->frame, v) > kRange - 1e-6;
      ASSERT_LT(std::abs(probe.depth(v + by)), sphere ? kTolerance : 1e-6) << v.transpose();
    }
  }
}

TEST(ExactProperties, LargeCoordinatesGiveTheSameVolume) {
  Random random(113);
  const Vec3 shift(580000, 4785000, 1000);
  for (int draw = 0; draw < 8; ++draw) {
    SCOPED_TRACE(draw);
    Scene scene = random_city(random, 25, 8);
    Target target = ground_target(random);
    if (draw % 2) {  // sums without rounding errors
      for (Vec3& v : target.parts[0]) v = (v * 1024).array().round() / 1024;
      for (Vec3& v : target.parts[0]) v.z() = 0.125;
    } else {
      for (Vec3& v : scene.mesh.vertices) v *= 0.99 + 1e-3 * std::sqrt(2.0);
    }
    Scene far = scene;
    for (Vec3& v : far.mesh.vertices) v += shift;
    Target far_target = target;
    for (Vec3& v : far_target.parts[0]) v += shift;
    expect_same_surface(compute(scene, target), compute(far, far_target), shift);
  }
}

TEST(ExactProperties, TheSameBitsForAnyNumberOfThreads) {
  Random random(127);
  for (int draw = 0; draw < 5; ++draw) {
    const PreparedScene scene(random_city(random, 120, 8));
    const Target target = ground_target(random);
    Volume first;
    for (const int threads : {1, 2, 4, 0, 1}) {
      const Volume volume = compute_visibility(PreparedTarget(scene, target, {kRange}), {0.01, threads});
      if (first.mesh.empty()) first = volume;
      ASSERT_FALSE(volume.mesh.empty());
      EXPECT_EQ(volume.mesh.vertices, first.mesh.vertices);
      EXPECT_EQ(volume.mesh.triangles, first.mesh.triangles);
      EXPECT_EQ(volume.cause_of, first.cause_of);
    }
  }
}

TEST(ExactProperties, EverySegmentToTheTargetStaysInside) {
  Random random(131);
  for (int draw = 0; draw < 5; ++draw) {
    SCOPED_TRACE(draw);
    const Scene scene = random_city(random, 40, 8);
    const Volume volume = compute(scene, ground_target(random));
    const MeshProbe probe(volume);
    std::vector<Vec3> goals{volume.frame.origin};
    for (const Eigen::Vector2d& t : volume.frame.polygon) goals.push_back(volume.frame.to_scene({t.x(), t.y(), 0}));
    for (int k = 0; k < 60; ++k) {
      const Vec3 p = probe.draw(random);
      if (probe.depth(p) < 1e-6 * (p - goals[0]).norm()) continue;
      for (const Vec3& goal : goals) {
        for (int i = 1; i < 12; ++i) {
          const Vec3 q = p + i / 12.0 * (goal - p);
          if (farthest_vertex(volume.frame, q) > kRange - kTolerance) continue;
          ASSERT_GT(probe.depth(q), -1e-6 * (q - goals[0]).norm()) << p.transpose() << " to " << goal.transpose();
        }
      }
    }
  }
}

/// Distance from a point of the range region to its boundary.
double below_sphere(const Volume& volume, double range, const Vec3& point) {
  return range - farthest_vertex(volume.frame, point);
}

TEST(ExactProperties, RangeFacetsKeepTheTolerance) {
  Random random(137);
  const Scene scene = random_city(random, 40, 8);
  const PreparedScene prepared(scene);
  for (const auto& [range, tolerance] : {std::pair{20.0, 1.0}, {80.0, 1.0}, {80.0, 0.1}, {80.0, 0.01}, {300.0, 0.1}}) {
    for (int draw = 0; draw < 3; ++draw) {
      SCOPED_TRACE(std::to_string(range) + " m, " + std::to_string(tolerance) + " m, draw " + std::to_string(draw));
      const Target target = ground_target(random);
      const Volume volume = compute(draw == 0 ? Scene() : scene, target, range, tolerance);
      EXPECT_EQ(volume.tolerance_m, tolerance);
      for (const Vec3& v : volume.mesh.vertices) {
        ASSERT_GE(below_sphere(volume, range, v), -1e-12 * range);
        ASSERT_GE(volume.frame.to_local(v).z(), -1e-9);
      }
      double worst = 0;
      for (std::size_t i = 0; i < volume.mesh.triangles.size(); ++i) {
        if (volume.causes[volume.cause_of[i]].kind != CauseKind::range) continue;
        const Triangle& t = volume.mesh.triangles[i];
        for (int a = 0; a <= 6; ++a) {
          for (int b = 0; a + b <= 6; ++b) {
            worst = std::max(worst, below_sphere(volume, range,
                                                 (a * volume.mesh.vertices[t[0]] + b * volume.mesh.vertices[t[1]] +
                                                  (6 - a - b) * volume.mesh.vertices[t[2]]) /
                                                     6));
          }
        }
      }
      EXPECT_GT(worst, 0.05 * tolerance);
      EXPECT_LT(worst, tolerance + 1e-8 * range);  // the finished mesh is shrunk by 1e-9
    }
  }
}

TEST(ExactProperties, CausesAreTheObjectsThatHide) {
  // A facet's cause is in the plane that its object spans with the target: a point just beyond the facet is hidden by
  // that object alone as well.
  Random random(139);
  const Scene scene = random_city(random, 40, 8);
  const Target target = ground_target(random);
  const Volume volume = compute(scene, target);
  double area = 0;
  for (const Cause& cause : volume.causes) area += cause.area_m2;
  EXPECT_NEAR(area, surface_area(volume.mesh), 1e-6 * area);
  int checked = 0;
  for (std::size_t c = 0; c < volume.causes.size(); ++c) {
    if (volume.causes[c].kind != CauseKind::scene) continue;
    Scene alone;
    alone.mesh.vertices = scene.mesh.vertices;
    alone.objects = {scene.objects[volume.causes[c].object.value()]};
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
      if (scene.object_of[i] == volume.causes[c].object) alone.mesh.triangles.push_back(scene.mesh.triangles[i]);
    ASSERT_FALSE(alone.mesh.triangles.empty()) << volume.causes[c].name;
    const Volume of_alone = compute(alone, target);
    const MeshProbe probe(of_alone);
    for (std::size_t i = 0; i < volume.mesh.triangles.size(); ++i) {
      if (volume.cause_of[i] != c) continue;
      const Triangle& t = volume.mesh.triangles[i];
      const auto& v = volume.mesh.vertices;
      const Vec3 centre = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
      if (farthest_vertex(volume.frame, centre) > kRange - kTolerance) continue;  // the rim is a polyline
      EXPECT_LT(std::abs(probe.depth(centre)), 1e-6 * (centre - volume.frame.origin).norm()) << volume.causes[c].name;
      ++checked;
    }
  }
  EXPECT_GT(checked, 50);
}

}  // namespace
}  // namespace vantage
