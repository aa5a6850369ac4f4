// A wrong result must be able to fail: the engine's pipeline, put together from its parts as in src/exact/engine.cpp
// and broken on purpose, against the independent check and the proof.
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
#include "support/ray_caster.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/prove.h"
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
  const Envelope envelope{blockers, tree, range, nullptr, kTolerance, progress};
  Mesh mesh = triangulate_boundary({skeleton, nullptr}, envelope, grid)->mesh;
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

ProofReport prove(const Mesh& mesh) {
  ProveOptions options;
  options.maximal = true;
  options.tolerance_m = kTolerance;
  return prove_volume(plaza(), square(), {kRange}, {}, mesh, options);
}

/// Claims too much: by the proof, whose witness a ray confirms.
void expect_refuted(const Mesh& mesh) {
  const Scene scene = plaza();
  const ProofReport proof = prove(mesh);
  ASSERT_EQ(proof.claims[0].verdict, ProofVerdict::wrong);
  ASSERT_TRUE(proof.witness);
  const Vec3 way = proof.witness->target_point - proof.witness->viewpoint;
  const testing::RayCaster rays(scene.mesh, proof.witness->viewpoint);
  EXPECT_LT(rays.first_hit(way.normalized(), way.norm()), way.norm() - 1e-3);
  EXPECT_GT(proof.witness->depth_m, 0);
  EXPECT_EQ(proof.witness->object, display_name(scene.objects[scene.object_of[proof.witness->triangle]]));
}

/// Claims too little: what it claims is proved, and that nothing is missing is not.
void expect_not_maximal(const Mesh& mesh) {
  const ProofReport proof = prove(mesh);
  EXPECT_EQ(proof.verdict(), ProofVerdict::proved);
  EXPECT_FALSE(proof.maximal->open.empty());
  EXPECT_LT(proof.maximal->proved_share, 0.99);
}

TEST(Mutations, TheUnbrokenPipelineIsRight) {
  const Mesh mesh = pipeline(plaza(), square());
  const ProofReport proof = prove(mesh);
  EXPECT_EQ(proof.verdict(), ProofVerdict::proved);
  EXPECT_EQ(proof.maximal->proved_share, 1);
  EXPECT_TRUE(proof.maximal->conditions_hold());
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
    const Mesh mesh = pipeline(scene, square());
    const VerifyReport report = check("without the " + name, mesh);
    EXPECT_GT(report.over_claimed, 0u);
    EXPECT_EQ(report.worst_over_cause, name);
    expect_refuted(mesh);
  }
}

TEST(Mutations, PlanesPushedAwayByOnePercentAreCaught) {
  const auto push = [](BlockerSet& blockers) {
    for (Plane& plane : blockers.planes) plane /= 1.01;
  };
  const Mesh mesh = pipeline(plaza(), square(), {push});
  const VerifyReport report = check("planes pushed away by 1 %", mesh);
  EXPECT_GT(report.over_claimed, 0u);
  expect_refuted(mesh);
}

TEST(Mutations, OnePlaneTurnedIsCaught) {
  // The plane through a target edge and a polygon edge, taken through the middle of the target instead: a target of no
  // width.
  const auto turn = [](BlockerSet& blockers) {
    for (Plane& plane : blockers.planes) plane.head<2>() *= 0.5;
  };
  const Mesh mesh = pipeline(plaza(), square(), {turn});
  const VerifyReport report = check("planes turned", mesh);
  EXPECT_GT(report.over_claimed, 0u);
  expect_refuted(mesh);
}

TEST(Mutations, ARangeOnePercentTooLongIsCaught) {
  Mutation longer;
  longer.range = 1.01 * kRange;
  const Mesh mesh = pipeline(plaza(), square(), longer);
  const VerifyReport report = check("range 1 % too long", mesh);
  EXPECT_GT(report.over_claimed, 0u);
  EXPECT_EQ(prove(mesh).claims[1].verdict, ProofVerdict::wrong);
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
  const Mesh mesh = solid::intersect(seen).to_mesh().mesh;
  const VerifyReport report = check("vertices only", mesh);
  EXPECT_GT(report.over_claimed, 0u);
  expect_refuted(mesh);
}

TEST(Mutations, ATargetDrawnTooSmallIsCaught) {
  Target small = square();
  for (Vec3& v : small.parts[0]) v *= 0.98;
  const Mesh mesh = pipeline(plaza(), small);
  const VerifyReport report = check("target 2 % too small", mesh);
  EXPECT_GT(report.over_claimed, 0u);
  expect_refuted(mesh);
}

TEST(Mutations, AnObjectThatIsNotThereIsNoticed) {
  Scene scene = plaza();
  testing::append(scene.mesh, testing::make_box_mesh({10, -20, 0}, {12, -18, 6}));
  scene.object_of.resize(scene.mesh.triangles.size(), scene.object_of.front());
  expect_not_maximal(pipeline(scene, square()));
}

TEST(Mutations, PlanesPulledNearByOnePercentAreNoticed) {
  const auto pull = [](BlockerSet& blockers) {
    for (Plane& plane : blockers.planes) plane *= 1.01;
  };
  expect_not_maximal(pipeline(plaza(), square(), {pull}));
}

TEST(Mutations, ARangeOnePercentTooShortIsNoticed) {
  Mutation shorter;
  shorter.range = 0.99 * kRange;
  expect_not_maximal(pipeline(plaza(), square(), shorter));
}

TEST(Mutations, ATargetDrawnTooLargeIsNoticed) {
  Target large = square();
  for (Vec3& v : large.parts[0]) v *= 1.02;
  expect_not_maximal(pipeline(plaza(), large));
}

}  // namespace
}  // namespace vantage
