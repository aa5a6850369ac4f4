// Algorithm 1 on scenes made by hand, with depth images made the obvious way.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "spheres/visibility.h"
#include "support/brute_depth.h"
#include "support/mesh_probe.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::BruteDepth;
using testing::SceneBuilder;
using testing::target_of;

constexpr double kRange = 50;

/// An edge of 10 m along x.
Target triangle() { return target_of({{-5, 0, 0}, {5, 0, 0}, {0, 8, 0}}); }

SpheresOptions coarse(int cubemap = 24) {
  SpheresOptions options;
  options.cubemap = cubemap;
  return options;
}

/// Fine enough to show a gap of two metres 20 m up, without the texels that a bound adds on either side.
SpheresOptions sharp() {
  SpheresOptions options = coarse(64);
  options.sphere = SpheresOptions::Sphere::centers;
  return options;
}

struct RunOfSpheres {
  Volume volume;
  SpheresReport report;
  std::vector<SphereStage> stages;  // meshes moved to `meshes`
  std::vector<Mesh> meshes;
  int images = 0, requests = 0;
};

RunOfSpheres run(const Scene& scene, const Target& target, const SpheresOptions& options, bool with_stages = false,
                 double range = kRange) {
  RunOfSpheres result;
  BruteDepth renderer(scene.mesh);
  StageSink sink;
  if (with_stages) {
    sink = [&](const SphereStage& stage) {
      result.stages.push_back(stage);
      result.meshes.push_back(stage.mesh ? *stage.mesh : Mesh());
    };
  }
  result.volume = spheres::compute_visibility(PreparedTarget(PreparedScene(scene), target, {range}), options, renderer,
                                              &result.report, sink, {});
  result.images = renderer.images;
  result.requests = renderer.requests;
  return result;
}

void expect_sound(const Volume& volume) {
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures m = measure(volume.mesh);
  EXPECT_TRUE(m.closed && m.oriented);
  EXPECT_GT(m.volume_m3, 0);
  ASSERT_EQ(volume.cause_of.size(), volume.mesh.triangles.size());
  double area = 0;
  for (const Cause& cause : volume.causes) area += cause.area_m2;
  EXPECT_NEAR(area, m.area_m2, 1e-6 * area);
}

/// Random points of the volume see the target's vertices and what was asked for besides.
void expect_seen(const Scene& scene, const Volume& volume, const std::vector<Vec3>& viewpoints, int count) {
  const testing::MeshProbe probe(volume);
  testing::Random random(11);
  for (int k = 0; k < count; ++k) {
    const Vec3 point = probe.draw(random);
    EXPECT_GT((point - volume.frame.origin).dot(volume.frame.normal), 0);
    for (const Vec3& from : viewpoints) {
      EXPECT_LE((point - from).norm(), kRange);
      EXPECT_GE(testing::first_hit(scene.mesh, from, point - from), 1) << point.transpose();
    }
  }
}

std::vector<Vec3> corners_of(const Volume& volume) {
  std::vector<Vec3> corners;
  for (const auto& t : volume.frame.polygon) corners.push_back(volume.frame.to_scene({t.x(), t.y(), 0}));
  return corners;
}

TEST(Spheres, OpenGroundNeedsNoSplit) {
  SceneBuilder scene;
  scene.ground("ground", 200);
  const RunOfSpheres result = run(scene, triangle(), coarse());
  expect_sound(result.volume);
  EXPECT_EQ(result.report.spheres, 3U);
  EXPECT_EQ(result.report.pairs, 3U);
  EXPECT_EQ(result.report.splits, 0U);
  EXPECT_EQ(result.report.unresolved_pairs, 0U);
  EXPECT_EQ(result.requests, 1);
  EXPECT_EQ(result.images, 3);
  const Volume exact = compute_visibility(PreparedTarget(PreparedScene(scene), triangle(), {kRange}));
  const double truth = enclosed_volume(exact.mesh), found = enclosed_volume(result.volume.mesh);
  EXPECT_LT(found, truth);
  EXPECT_GT(found, 0.97 * truth);
  expect_seen(scene, result.volume, corners_of(result.volume), 200);
}

TEST(Spheres, CausesAreTheSceneTheRangeAndTheTargetsPlane) {
  SceneBuilder scene;
  scene.ground("ground", 200, -5).box("block", {15, -5, -5}, {20, 5, 12});
  SpheresOptions options = coarse();
  options.sphere = SpheresOptions::Sphere::centers;
  const RunOfSpheres result = run(scene, triangle(), options);
  expect_sound(result.volume);
  std::vector<std::string> names;
  for (const Cause& cause : result.volume.causes) names.push_back(cause.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"max_range", "scene", "target plane"}));
}

// The shadows of a bar across the edge part behind it, and leave a gap that is open at the bar's ends: a handle.
SceneBuilder bar_across() {
  SceneBuilder scene;
  scene.ground("ground", 200, -1).box("bar", {-1, -12, 20}, {1, 12, 21});
  return scene;
}

TEST(Spheres, ABarAcrossAnEdgeMakesTheTestFireUntilTheShadowsMeet) {
  const SceneBuilder scene = bar_across();
  const RunOfSpheres result = run(scene, triangle(), sharp());
  expect_sound(result.volume);
  EXPECT_GE(result.report.splits, 1U);
  EXPECT_EQ(result.report.unresolved_pairs, 0U);
  EXPECT_EQ(result.report.spheres, 3 + result.report.splits);

  SpheresOptions none = sharp();
  none.max_splits = 0;
  const RunOfSpheres unsplit = run(scene, triangle(), none);
  EXPECT_EQ(unsplit.report.pairs, 0U);  // nobody would learn of them
  EXPECT_EQ(unsplit.report.splits, 0U);
  EXPECT_GT(enclosed_volume(unsplit.volume.mesh), 1.001 * enclosed_volume(result.volume.mesh));
  EXPECT_GE(run(scene, triangle(), none, true).report.unresolved_pairs, 1U);

  SpheresOptions long_edges = sharp();
  long_edges.min_edge_m = 5.1;  // no half of 10 m is that long
  const RunOfSpheres stopped = run(scene, triangle(), long_edges);
  EXPECT_EQ(stopped.report.splits, 0U);
  EXPECT_GE(stopped.report.unresolved_pairs, 1U);
}

// The gap of a bar that is longer than the range is wide is a piece of its own: twice a sphere is none.
TEST(Spheres, TwoPiecesAreNoSphere) {
  SceneBuilder scene;
  scene.ground("ground", 200, -1).box("bar", {-1, -300, 20}, {1, 300, 21});
  const RunOfSpheres result = run(scene, target_of({{-5, 0, 0}, {5, 0, 0}, {5, 1, 0}, {-5, 1, 0}}), sharp(), true);
  expect_sound(result.volume);
  const auto pair = std::find_if(result.stages.begin(), result.stages.end(), [](const SphereStage& stage) {
    return stage.kind == SphereStage::Kind::pair && stage.component_euler.size() > 1;
  });
  ASSERT_NE(pair, result.stages.end());
  EXPECT_EQ(pair->euler, 2 * static_cast<long>(pair->component_euler.size()));
  EXPECT_GT(result.report.splits, 0U);
}

// What the test cannot see (docs/spheres.md): the shadows of a bar along the edge overlap, and no split is made though
// the bar hides what is between them from no vertex.
TEST(Spheres, ABarAlongAnEdgeDoesNotMakeItFire) {
  SceneBuilder scene;
  scene.ground("ground", 200, -1).box("bar", {-12, -1, 20}, {12, 1, 21});
  const RunOfSpheres result = run(scene, target_of({{-5, 0, 0}, {5, 0, 0}, {5, 0.5, 0}, {-5, 0.5, 0}}), sharp());
  expect_sound(result.volume);
  EXPECT_EQ(result.report.splits, 0U);
  EXPECT_EQ(result.report.pairs, 4U);
}

TEST(Spheres, AlwaysHalvesEveryEdgeAsOftenAsAsked) {
  SceneBuilder scene;
  scene.ground("ground", 200);
  SpheresOptions options = coarse(8);
  options.split = SpheresOptions::Split::always;
  options.max_splits = 2;
  const RunOfSpheres result = run(scene, triangle(), options);
  expect_sound(result.volume);
  EXPECT_EQ(result.report.splits, 9U);
  EXPECT_EQ(result.report.spheres, 12U);
  EXPECT_EQ(result.report.pairs, 0U);
  // Each sphere can only take away; here the corners' take all, and what is left is summed over other facets.
  options.max_splits = 0;
  const double of_corners = enclosed_volume(run(scene, triangle(), options).volume.mesh);
  EXPECT_LE(enclosed_volume(result.volume.mesh), of_corners * (1 + 1e-12));
}

TEST(Spheres, StagesTellTheStoryInOrder) {
  const SceneBuilder scene = bar_across();
  const RunOfSpheres result = run(scene, triangle(), coarse(16), true);
  ASSERT_GE(result.stages.size(), 8U);
  std::size_t spheres = 0, pairs = 0, splits = 0;
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    const SphereStage& stage = result.stages[i];
    const MeshMeasures m = measure(result.meshes[i]);
    if (stage.kind == SphereStage::Kind::split) {
      EXPECT_EQ(stage.mesh, nullptr);
      ASSERT_EQ(stage.points.size(), 3U);
      EXPECT_LT((stage.points[0] + stage.points[1] - 2 * stage.points[2]).norm(), 1e-9);
      ++splits;
      continue;
    }
    EXPECT_TRUE(m.closed && m.oriented) << stage.name;
    EXPECT_EQ(m.euler, stage.euler) << stage.name;
    EXPECT_EQ(m.pieces, stage.component_euler.size()) << stage.name;
    EXPECT_NEAR(m.volume_m3, stage.volume_m3, 1e-9 * m.volume_m3) << stage.name;
    if (stage.kind == SphereStage::Kind::sphere) {
      EXPECT_EQ(stage.name, "sphere " + std::to_string(spheres++));
      EXPECT_EQ(stage.euler, 2);
      EXPECT_EQ(stage.points.size(), 1U);
    }
    if (stage.kind == SphereStage::Kind::pair) {
      EXPECT_EQ(stage.points.size(), 2U);
      ++pairs;
    }
  }
  EXPECT_EQ(spheres, result.report.spheres);
  EXPECT_EQ(pairs, result.report.pairs);
  EXPECT_EQ(splits, result.report.splits);
  EXPECT_EQ(result.stages[0].name, "sphere 0");
  EXPECT_EQ(result.stages[3].name, "pair 0-1");
  EXPECT_EQ(result.stages.back().name, "result");
  EXPECT_NEAR(result.stages.back().volume_m3, enclosed_volume(result.volume.mesh), 1e-6);
  // Watching changes nothing but the order of the booleans.
  const double unwatched = enclosed_volume(run(scene, triangle(), coarse(16)).volume.mesh);
  EXPECT_NEAR(enclosed_volume(result.volume.mesh), unwatched, 1e-6 * unwatched);
}

TEST(Spheres, TheResultIsTheSameEachTimeAndOnAnyNumberOfThreads) {
  testing::Random random(21);
  const Scene scene = testing::random_city(random, 6, 8);
  Mesh first;
  for (const int threads : {1, 1, 4}) {
    parallel::with_threads(threads, [&] {
      const RunOfSpheres result = run(scene, triangle(), coarse(12));
      if (first.empty()) first = result.volume.mesh;
      EXPECT_TRUE(result.volume.mesh.vertices == first.vertices);
      EXPECT_TRUE(result.volume.mesh.triangles == first.triangles);
    });
  }
}

// In a city, upright, tilted and lying targets; both forms of grid; closed, and inner bounds.
TEST(Spheres, ConservativeVolumesLieInWhatTheVerticesSee) {
  testing::Random random(22);
  for (int round = 0; round < 8; ++round) {
    const Scene scene = testing::random_city(random, 6, 8);
    const Vec3 normal = round % 4 == 0 ? Vec3(Vec3::UnitZ()) : (Vec3::UnitZ() + 0.9 * random.direction()).normalized();
    const Target target = testing::random_target(random, random.integer(3, 6), 3, {0, 0, 3.5}, normal);
    SpheresOptions options = coarse(random.integer(9, 14));
    if (round % 2 == 1) options.resolution = {12, 7};
    options.max_splits = 1;
    const RunOfSpheres result = run(scene, target, options);
    if (result.volume.outcome != Outcome::computed) continue;
    expect_sound(result.volume);
    expect_seen(scene, result.volume, corners_of(result.volume), 60);
    const Volume exact = compute_visibility(PreparedTarget(PreparedScene(scene), target, {kRange}));
    EXPECT_EQ(result.volume.lift_m.at(0), std::max(exact.lift_m.at(0), 1e-6));
  }
}

TEST(Spheres, OutcomesAreToldNotThrown) {
  SceneBuilder scene;
  scene.ground("ground", 200);
  const RunOfSpheres far = run(scene, triangle(), coarse(4), false, 4);
  EXPECT_EQ(far.volume.outcome, Outcome::out_of_range);
  EXPECT_TRUE(far.volume.mesh.empty());

  Target down = target_of({{-5, 0, 0.05}, {5, 0, 0.05}, {0, 8, 0.05}});
  down.front = Vec3(0, 0, -1);
  const RunOfSpheres blocked = run(scene, down, coarse(9));
  EXPECT_EQ(blocked.volume.outcome, Outcome::blocked_at_once);
  EXPECT_NE(blocked.volume.reason.find("vertex "), std::string::npos) << blocked.volume.reason;
  EXPECT_TRUE(blocked.volume.mesh.empty() && blocked.volume.cause_of.empty());

  SceneBuilder under_a_roof;
  under_a_roof.ground("ground", 200).box("roof", {-100, -100, 1}, {100, 100, 2});
  const RunOfSpheres unseen = run(under_a_roof, triangle(), coarse(2));
  EXPECT_EQ(unseen.volume.outcome, Outcome::blocked_at_once);
  EXPECT_NE(unseen.volume.reason.find("visibility spheres"), std::string::npos) << unseen.volume.reason;
  EXPECT_FALSE(unseen.volume.hint.empty());
}

TEST(Spheres, RefusesOptionsOutOfRange) {
  SceneBuilder scene;
  scene.ground("ground", 200);
  const auto refused = [&](const std::string& what, const auto& change) {
    SpheresOptions options;
    change(options);
    const Error error =
        testing::expect_error([&] { run(scene, triangle(), options); }, ErrorCode::value_out_of_range, "spheres");
    EXPECT_NE(error.problem().find(what), std::string::npos) << error.problem();
  };
  refused("cubemap", [](SpheresOptions& o) { o.cubemap = 0; });
  refused("cubemap", [](SpheresOptions& o) { o.cubemap = 100000; });
  refused("resolution", [](SpheresOptions& o) { o.resolution = {0, 80}; });
  refused("resolution", [](SpheresOptions& o) { o.resolution = {160, 1}; });
  refused("resolution", [](SpheresOptions& o) { o.resolution = {100000, 80}; });
  refused("resolution", [](SpheresOptions& o) { o.resolution = {2147483647, 2147483647}; });
  refused("max_splits", [](SpheresOptions& o) { o.max_splits = -1; });
  refused("max_splits", [](SpheresOptions& o) { o.max_splits = 17; });
  refused("min_edge", [](SpheresOptions& o) { o.min_edge_m = 0; });
  refused("min_edge", [](SpheresOptions& o) { o.min_edge_m = NAN; });
  refused("merge", [](SpheresOptions& o) { o.merge = -1e-9; });
  refused("merge", [](SpheresOptions& o) { o.merge = 0.06; });
  refused("merge", [](SpheresOptions& o) { o.merge = NAN; });
  // Within the limits, but some 800 million facets: no machine of today holds that.
  SpheresOptions large;
  large.cubemap = 8192;
  testing::expect_code([&] { run(scene, triangle(), large); }, ErrorCode::out_of_memory, "spheres");
}

TEST(Spheres, RefusesTargetsAsTheExactEngineDoes) {
  SceneBuilder scene;
  scene.ground("ground", 200).box("block", {-1, 1, -1}, {1, 3, 5});
  const Error exact =
      testing::expect_error([&] { compute_visibility(PreparedTarget(PreparedScene(scene), triangle(), {kRange})); },
                            ErrorCode::target_pierced);
  EXPECT_EQ(exact.object(), 1U) << "the block";
  EXPECT_STREQ(testing::error_of([&] { run(scene, triangle(), coarse(4)); }).what(), exact.what());
  const Error no_range =
      testing::expect_error([&] { compute_visibility(PreparedTarget(PreparedScene(scene), triangle(), {-1})); },
                            ErrorCode::value_out_of_range);
  EXPECT_STREQ(testing::error_of([&] { run(scene, triangle(), coarse(4), false, -1); }).what(), no_range.what());
}

TEST(Spheres, PointsAreRaisedAndRefusedAsTheExactEngineDoes) {
  SceneBuilder slope;
  const Vec3 up = Vec3(-0.3, -0.1, 1).normalized();
  slope.polygon("slope", {{-100, -100, -40}, {100, -100, 20}, {100, 100, 40}, {-100, 100, -20}});
  const Target under = target_of({{3.3, 7.7, 1.759}});  // by a millimetre
  const Volume exact = compute_visibility(PreparedTarget(PreparedScene(slope), under, {kRange}));
  const RunOfSpheres found = run(slope, under, coarse(10));
  expect_sound(found.volume);
  EXPECT_GT(found.volume.lift_m.at(0), 1e-3);
  EXPECT_EQ(found.volume.lift_m.at(0), exact.lift_m.at(0));
  for (const Vec3& v : found.volume.mesh.vertices) EXPECT_GT(v.dot(up), 0);

  SceneBuilder block;
  block.ground("ground", 200).box("block", {10, -5, 0}, {20, 5, 10});
  Target along_ground = target_of({{0, 0, 0}});
  along_ground.front = Vec3(0, 1, 0);
  for (const Target& target : {target_of({{10, 0, 5}}), target_of({{9.999, 0, 5}}), along_ground}) {
    const Error refusal = testing::expect_error(
        [&] { compute_visibility(PreparedTarget(PreparedScene(block), target, {kRange})); }, ErrorCode::target_pierced);
    EXPECT_STREQ(testing::error_of([&] { run(block, target, coarse(4)); }).what(), refusal.what());
  }
}

TEST(Spheres, TheToleranceBoundsHowFarRangeFacetsLieInside) {
  SceneBuilder scene;
  scene.ground("ground", 200);
  const Target target = target_of({{1, 2, 20}});
  for (const double merge : {0.0, 0.01, 0.05}) {
    SpheresOptions options = coarse(40);
    options.merge = merge;
    const Volume volume = run(scene, target, options).volume;
    const Mesh& mesh = volume.mesh;
    double deepest = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (volume.causes[volume.cause_of[t]].kind != CauseKind::range) continue;
      const Triangle& corners = mesh.triangles[t];
      const Vec3 middle = (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3;
      deepest = std::max(deepest, kRange - (middle - volume.frame.origin).norm());
    }
    EXPECT_GT(deepest, 0);
    EXPECT_LE(deepest, volume.tolerance_m) << merge;
  }
}

TEST(Spheres, ASphereFromInsideASolidIsItsInside) {
  SceneBuilder scene;
  scene.box("room", {-2, -2, -2}, {2, 2, 2});
  BruteDepth renderer(scene.scene().mesh);
  SpheresOptions options = coarse(10);
  options.sphere = SpheresOptions::Sphere::centers;
  const Mesh inside = spheres::visibility_sphere({0.3, 0.2, 0.1}, kRange, options, renderer, {});
  EXPECT_NEAR(enclosed_volume(inside), 64, 4);
  options.sphere = SpheresOptions::Sphere::conservative;
  const Mesh on_wall = spheres::visibility_sphere({2, 0, 0}, kRange, options, renderer, {});
  const MeshMeasures m = measure(on_wall);
  EXPECT_TRUE(m.closed && m.oriented);
  EXPECT_EQ(m.euler, 2);
}

TEST(Spheres, StopsWhenTold) {
  const SceneBuilder scene = bar_across();
  BruteDepth renderer(scene.scene().mesh);
  const auto story = testing::check_progress([&](const Progress& progress) {
    spheres::compute_visibility(PreparedTarget(PreparedScene(scene), triangle(), {kRange}), coarse(12), renderer,
                                nullptr, {}, progress);
  });
  EXPECT_EQ(story.stages.front(), "making spheres");
  EXPECT_EQ(story.last_fraction.at("intersecting spheres"), 1);
}

}  // namespace
}  // namespace vantage
