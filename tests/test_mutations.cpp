// A wrong result must be able to fail: the engine's pipeline, put together from its parts as in src/exact/engine.cpp
// and broken on purpose, against the independent check.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>

#include "exact/collect.h"
#include "exact/triangulation.h"
#include "solid/csg.h"
#include "support/internals.h"
#include "support/scenes.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using namespace exact;  // NOLINT(google-build-using-namespace): the parts of one pipeline
using testing::SceneBuilder;
using testing::target_of;

constexpr double kRange = 40, kTolerance = 0.01;

/// A plaza with a wall, a house, a pole between two corners of the target and a sign that hangs over its edge.
Scene plaza() {
  return SceneBuilder()
      .ground("ground", 60)
      .box("wall", {8, -6, 0}, {8.5, 7, 5})
      .box("house", {-16, -4, 0}, {-7, 6, 9})
      .box("pole", {-0.1, 4.5, 0}, {0.1, 4.7, 10})
      .polygon("sign", {{2, -7, 3}, {5, -6, 4}, {4, -5, 7}, {1, -6, 6}});
}

Target square() { return target_of({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}}); }

/// What may be broken, and where.
struct Mutation {
  std::function<void(BlockerSet&)> blockers;
  double range = kRange;
};

/// compute_visibility, stage by stage.
Mesh pipeline(const Scene& scene, const Target& goal, const Mutation& mutation = {}) {
  const PreparedScene prepared(scene);
  const TargetFrame frame = make_target_frame(goal);
  const target::LocalTarget target = target::make_local_target(frame.polygon, 1e-9, 0);
  const target::RangeRegion range(frame.polygon, mutation.range);
  OctahedralGrid grid(range, kTolerance);
  BlockerSet blockers;
  DirectionTree found(blockers, range);
  const core::ProgressReporter progress;
  collect_blockers(prepared.data(), frame, target, range, blockers, found, progress);
  if (mutation.blockers) mutation.blockers(blockers);
  DirectionTree tree(blockers, range);
  for (std::uint32_t i = 0; i < blockers.count(); ++i) tree.insert(i);
  const CurveSampling sampling{kTolerance * 0.5, std::sqrt(8 * kRange * kTolerance)};
  const Skeleton skeleton = trace_envelope(blockers, tree, range, sampling, grid, progress);
  Mesh mesh = triangulate_boundary(skeleton, blockers, tree, range, grid, kTolerance, progress).mesh;
  for (Vec3& v : mesh.vertices) v = frame.to_scene(v);
  return mesh;
}

VerifyReport check(const std::string& what, const Mesh& mesh) {
  VerifyOptions options;
  options.tolerance_m = kTolerance;
  VerifyReport report = verify_volume(plaza(), square(), {kRange}, {}, mesh, options);
  EXPECT_TRUE(report.closed && report.oriented);
  std::cout << what << ": " << report.over_claimed << " over-claimed, worst " << report.worst_over_depth_m << " m ("
            << report.worst_over_cause << "), " << report.under_claimed << " under-claimed, of " << report.points
            << " points\n";
  return report;
}

TEST(Mutations, TheUnbrokenPipelineIsRight) {
  const Mesh mesh = pipeline(plaza(), square());
  const VerifyReport report = check("unbroken", mesh);
  EXPECT_EQ(report.over_claimed, 0u);
  EXPECT_EQ(report.under_claimed, 0u);
  EXPECT_EQ(report.euler, 2);
  // And it is the engine: but for the order in which the tree was filled, nothing differs.
  const Volume volume = compute_visibility(PreparedTarget(PreparedScene(plaza()), square(), {kRange}), {kTolerance, 1});
  EXPECT_EQ(volume.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(enclosed_volume(volume.mesh), enclosed_volume(mesh), 1e-6);
}

TEST(Mutations, AnObjectLeftOutIsCaught) {
  const Scene whole = plaza();
  for (const std::string name : {"wall", "house", "pole", "sign"}) {
    Scene scene = whole;
    for (std::size_t i = scene.mesh.triangles.size(); i-- > 0;) {
      if (display_name(scene.objects[scene.object_of[i]]) != name) continue;
      scene.mesh.triangles.erase(scene.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
      scene.object_of.erase(scene.object_of.begin() + static_cast<std::ptrdiff_t>(i));
    }
    const VerifyReport report = check("without the " + name, pipeline(scene, square()));
    EXPECT_GT(report.over_claimed, 0u);
    EXPECT_EQ(report.worst_over_cause, name);
  }
}

TEST(Mutations, PlanesPushedAwayByOnePercentAreCaught) {
  const auto push = [](BlockerSet& blockers) {
    for (Plane& plane : blockers.planes) plane /= 1.01;
  };
  const VerifyReport report = check("planes pushed away by 1 %", pipeline(plaza(), square(), {push}));
  EXPECT_GT(report.over_claimed, 0u);
}

TEST(Mutations, OnePlaneTurnedIsCaught) {
  // The plane through a target edge and a polygon edge, taken through the middle of the target instead: a target of no
  // width.
  const auto turn = [](BlockerSet& blockers) {
    for (Plane& plane : blockers.planes) plane.head<2>() *= 0.5;
  };
  EXPECT_GT(check("planes turned", pipeline(plaza(), square(), {turn})).over_claimed, 0u);
}

TEST(Mutations, ARangeOnePercentTooLongIsCaught) {
  Mutation longer;
  longer.range = 1.01 * kRange;
  const VerifyReport report = check("range 1 % too long", pipeline(plaza(), square(), longer));
  EXPECT_GT(report.over_claimed, 0u);
}

TEST(Mutations, SeeingTheVerticesOnlyIsCaught) {
  // The published method's mistake: the intersection of what each vertex sees. The pole between two of them is missed.
  std::vector<solid::Solid> seen;
  const Target goal = square();
  for (const Vec3& vertex : goal.parts[0]) {
    Target corner = square();
    for (Vec3& v : corner.parts[0]) v = vertex + 1e-3 * (v - vertex);
    const Volume volume = compute_visibility(PreparedTarget(PreparedScene(plaza()), corner, {kRange}), {kTolerance, 0});
    seen.emplace_back(solid::LabelledMesh{volume.mesh, volume.cause_of}, "seen");
  }
  const VerifyReport report = check("vertices only", solid::intersect(seen).to_mesh().mesh);
  EXPECT_GT(report.over_claimed, 0u);
}

TEST(Mutations, ATargetDrawnTooSmallIsCaught) {
  Target small = square();
  for (Vec3& v : small.parts[0]) v *= 0.98;
  const VerifyReport report = check("target 2 % too small", pipeline(plaza(), small));
  EXPECT_GT(report.over_claimed, 0u);
}

}  // namespace
}  // namespace vantage
