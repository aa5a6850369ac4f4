// The check from end to end, on small scenes whose volume is known by construction.
#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/oracle.h"
#include "support/progress_check.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/verify.h"

namespace vantage {
namespace {

using testing::append;
using testing::expect_code;
using testing::make_box_mesh;

/// A frustum between two rectangles, outward; bit 0, 1, 2 of a vertex's number: x, y, z high.
Mesh make_frustum(const Vec3& low_min, const Vec3& low_max, const Vec3& high_min, const Vec3& high_max) {
  Mesh mesh = make_box_mesh(low_min, high_max);
  for (int i = 0; i < 8; ++i) {
    const Vec3 &min = i & 4 ? high_min : low_min, &max = i & 4 ? high_max : low_max;
    mesh.vertices[i] = {i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(), min.z()};
  }
  return mesh;
}

/// The box minus a frustum whose upper rectangle lies in the box's top: a pit. Genus 0.
Mesh box_with_pit(const Mesh& box, const Mesh& frustum) {
  Mesh mesh;
  mesh.vertices = box.vertices;
  mesh.vertices.insert(mesh.vertices.end(), frustum.vertices.begin(), frustum.vertices.end());
  const auto is_top = [](const Triangle& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; };
  for (const Triangle& t : box.triangles) {
    if (!is_top(t)) mesh.triangles.push_back(t);
  }
  for (const Triangle& t : frustum.triangles) {
    if (!is_top(t)) mesh.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  for (const auto& [a, b] :
       {std::pair{4u, 5u}, {5u, 7u}, {7u, 6u}, {6u, 4u}}) {  // the rim, counter-clockwise from above
    mesh.triangles.push_back({a, b, b + 8});
    mesh.triangles.push_back({a, b + 8, a + 8});
  }
  return mesh;
}

/// A plate over the ground, a square target on the ground, and a keep-in box. What the plate hides is a frustum: a
/// point `rise` above the plate at height h is o + s (o - t) with s = rise / h.
struct Example {
  Scene scene;
  Target target;
  Sensor sensor{100};
  Navigation navigation;
  Mesh truth;

  VerifyReport verify(const Mesh& volume, const VerifyOptions& options = {}) const {
    return verify_volume(scene, target, sensor, navigation, volume, options);
  }
};

Example plate_example(const Vec3& shift = Vec3::Zero()) {
  Example example;
  const double plate = 5, top = 10, s = (top - plate) / plate;
  const double x0 = 2, x1 = 4, y0 = -1, y1 = 1;  // of the plate; the target reaches from -1 to 1
  example.scene.mesh.vertices = {{x0, y0, plate}, {x1, y0, plate}, {x1, y1, plate}, {x0, y1, plate},
                                 {-50, -50, 0},   {50, -50, 0},    {50, 50, 0},     {-50, 50, 0}};
  example.scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  example.scene.object_of = {0, 0, 1, 1};
  example.scene.objects = named({"plate", "ground"});
  example.target.parts[0] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  example.navigation.keep_in = {Box{Vec3(-10, -10, 1), Vec3(10, 10, 10)}};
  const Mesh hidden = make_frustum({x0, y0, plate}, {x1, y1, plate}, {x0 + s * (x0 - 1), y0 + s * (y0 - 1), top},
                                   {x1 + s * (x1 + 1), y1 + s * (y1 + 1), top});
  example.truth = box_with_pit(make_box_mesh({-10, -10, 1}, {10, 10, 10}), hidden);
  for (Vec3& vertex : example.scene.mesh.vertices) vertex += shift;
  for (Vec3& vertex : example.target.parts[0]) vertex += shift;
  for (Vec3& vertex : example.truth.vertices) vertex += shift;
  const Box kept = example.navigation.keep_in[0].box();
  example.navigation.keep_in[0] = Box{kept.min + shift, kept.max + shift};
  return example;
}

void expect_right(const VerifyReport& report) {
  EXPECT_EQ(report.over_claimed, 0u) << report.worst_over_depth_m << " m at " << report.worst_over_point.transpose()
                                     << ": " << report.worst_over_cause;
  EXPECT_EQ(report.under_claimed, 0u) << report.worst_under_depth_m << " m at " << report.worst_under_point.transpose();
}

TEST(Verify, PassesAVolumeThatIsRight) {
  const Example example = plate_example();
  const VerifyReport report = example.verify(example.truth);
  expect_right(report);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.oriented);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.points, 20000u);
  EXPECT_GT(report.inside, 5000u);
  EXPECT_LT(report.inside, 20000u);
  EXPECT_GT(report.rays, report.inside * 64);
  EXPECT_GE(report.bound_points, 5000u);
  EXPECT_NEAR(report.over_claim_bound, 1 - std::pow(0.05, 1.0 / static_cast<double>(report.bound_points)), 1e-12);
  EXPECT_TRUE(report.worst_over_cause.empty());
}

TEST(Verify, LargeCoordinatesMakeNoDifference) {
  const Vec3 shift(580000, 4785000, 1000);
  const Example near = plate_example(), far = plate_example(shift);
  expect_right(far.verify(far.truth));
  Mesh uncut = make_box_mesh(shift + Vec3(-10, -10, 1), shift + Vec3(10, 10, 10));
  const VerifyReport wrong = far.verify(uncut);
  const VerifyReport same = near.verify(make_box_mesh({-10, -10, 1}, {10, 10, 10}));
  EXPECT_EQ(wrong.over_claimed, same.over_claimed);
  EXPECT_NEAR(wrong.worst_over_depth_m, same.worst_over_depth_m, 1e-6);
}

TEST(Verify, CatchesAShadowThatWasNotCut) {
  const Example example = plate_example();
  const VerifyReport report = example.verify(make_box_mesh({-10, -10, 1}, {10, 10, 10}));
  EXPECT_GT(report.over_claimed, 100u);
  EXPECT_EQ(report.under_claimed, 0u);
  EXPECT_EQ(report.worst_over_cause, "plate");
  EXPECT_GT(report.worst_over_depth_m, 1);
  EXPECT_EQ(report.euler, 2);
  // Of 20 x 20 x 9 m3 the frustum takes 5/3 (4 + 36 + 12) m3.
  const double share = 5.0 / 3 * 52 / 3600;
  EXPECT_GT(report.over_claim_bound, share);
  EXPECT_LT(report.over_claim_bound, 2 * share);
}

TEST(Verify, BelievesNoRoundingThatNumbersCannotHave) {
  const Example example = plate_example();
  const VerifyReport report = example.verify(make_box_mesh({-10, -10, 1}, {10, 10, 10}), {.rounding_m = 230});
  EXPECT_GT(report.over_claimed, 100u);
  EXPECT_LT(report.rounding_m, 1e-5);
}

TEST(Verify, CatchesAShadowCutAHairTooSmall) {
  Example example = plate_example();
  Mesh volume = example.truth;
  for (std::size_t i = 8; i < 12; ++i) volume.vertices[i].z() += 1e-3;  // the pit's floor
  const VerifyReport high = example.verify(volume);
  EXPECT_GT(high.over_claimed, 0u);
  EXPECT_LT(high.worst_over_depth_m, 1.1e-3);
  for (std::size_t i = 8; i < 12; ++i) {  // lower, and wider, than what is hidden
    volume.vertices[i] = example.truth.vertices[i] + Vec3(i & 1 ? 1e-3 : -1e-3, i & 2 ? 1e-3 : -1e-3, -1e-3);
  }
  const VerifyReport low = example.verify(volume);
  EXPECT_EQ(low.over_claimed, 0u);
  EXPECT_GT(low.under_claimed, 0u);
  EXPECT_LT(low.worst_under_depth_m, 2e-3);
}

TEST(Verify, CatchesAVolumeThatIsInflatedShrunkOrMirrored) {
  const Example example = plate_example();
  const auto mapped = [&](const Vec3& factors) {
    Mesh volume = example.truth;
    for (Vec3& vertex : volume.vertices) vertex = vertex.cwiseProduct(factors);
    if (factors.prod() < 0) {
      for (Triangle& triangle : volume.triangles) std::swap(triangle[0], triangle[1]);
    }
    return example.verify(volume);
  };
  const VerifyReport inflated = mapped(Vec3::Constant(1.01));
  EXPECT_GT(inflated.over_claimed, 0u);
  EXPECT_EQ(inflated.worst_over_cause, "keep_in");
  const VerifyReport shrunk = mapped(Vec3(0.99, 0.99, 1));
  EXPECT_EQ(shrunk.worst_over_cause, "plate");  // the pit's side towards the target moved over what the plate hides
  EXPECT_GT(shrunk.under_claimed, 0u);
  const VerifyReport mirrored = mapped(Vec3(-1, 1, 1));
  EXPECT_EQ(mirrored.worst_over_cause, "plate");
  EXPECT_GT(mirrored.over_claimed, 100u);
  EXPECT_GT(mirrored.under_claimed, 100u);
}

TEST(Verify, CatchesAThinPoleBetweenTwoVertices) {
  Example example = plate_example();
  example.target.parts[0] = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  example.scene.mesh = make_box_mesh({-0.01, -7.01, 0}, {0.01, -6.99, 8});
  example.scene.object_of.assign(12, 0);
  example.scene.objects = named({"pole"});
  const Mesh box = make_box_mesh({-10, -10, 1}, {10, 10, 10});
  VerifyOptions options;
  const VerifyReport report = example.verify(box, options);
  EXPECT_GT(report.over_claimed, 100u);
  EXPECT_EQ(report.worst_over_cause, "pole");
  // Every viewpoint that the pole matters to is found, not only where a sample happens to fall behind it: the count is
  // the same whatever the samples.
  options.target_samples = 0;
  EXPECT_EQ(example.verify(box, options).over_claimed, report.over_claimed);
}

TEST(Verify, ChecksTheRange) {
  Example example = plate_example();
  example.navigation = {};
  example.scene.mesh.triangles.clear();
  const double corner = std::sqrt(11.0 * 11 + 11 * 11 + 10 * 10);  // from the box's upper corner to the far vertex
  const Mesh box = make_box_mesh({-10, -10, 1}, {10, 10, 10});
  example.sensor.max_range_m = corner;
  VerifyReport report = example.verify(box);
  EXPECT_EQ(report.over_claimed, 0u);
  EXPECT_GT(report.under_claimed, 0u);  // the ball reaches farther than its inscribed box
  example.sensor.max_range_m = 0.95 * corner;
  report = example.verify(box);
  EXPECT_GT(report.over_claimed, 0u);
  EXPECT_EQ(report.worst_over_cause, "max_range");
}

TEST(Verify, ForgivesRangeFacetsInsideTheSphere) {
  // A hemisphere of flat facets about a small target: inside the sphere by up to a few centimetres.
  Example example = plate_example();
  example.navigation = {};
  example.scene.mesh.triangles.clear();
  for (Vec3& vertex : example.target.parts[0]) vertex *= 1e-4;
  example.sensor.max_range_m = 20;
  const Mesh dome = testing::make_hemisphere(Vec3::Zero(), 20 - 2e-4, 96, 24).mesh;
  VerifyOptions options;
  options.tolerance_m = 0.1;
  expect_right(example.verify(dome, options));
  options.tolerance_m = 0.01;
  const VerifyReport report = example.verify(dome, options);
  EXPECT_EQ(report.over_claimed, 0u);
  EXPECT_GT(report.under_claimed, 0u);
  EXPECT_LT(report.worst_under_depth_m, 0.1);
}

TEST(Verify, CatchesWhatLiesBehindTheTarget) {
  Example example = plate_example();
  example.navigation = {};
  example.scene.mesh.triangles.clear();
  const VerifyReport report = example.verify(make_box_mesh({-10, -10, -3}, {10, 10, 10}));
  EXPECT_GT(report.over_claimed, 0u);
  EXPECT_EQ(report.worst_over_cause, "target plane");
}

TEST(Verify, TheSurfaceUnderTheTargetDoesNotCount) {
  Example example = plate_example();
  Mesh bump = make_box_mesh({-0.5, -0.5, -1}, {0.5, 0.5, 0.9e-3});
  append(example.scene.mesh, bump);
  expect_right(example.verify(example.truth));
  append(example.scene.mesh, make_box_mesh({-0.5, -0.5, -1}, {0.5, 0.5, 1.1e-3}));
  EXPECT_GT(example.verify(example.truth).over_claimed, 1000u);
}

TEST(Verify, ATargetInPartsMustBeSeenInAllOfThem) {
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(580000, 4785000, 1000)}) {
    const Example whole = plate_example(shift);
    Target halves = whole.target;  // the target reaches from -1 to 1
    halves.parts.push_back(halves.parts[0]);
    for (const int i : {1, 2}) halves.parts[0][i].x() = shift.x() + 0.25;
    for (const int i : {0, 3}) halves.parts[1][i].x() = shift.x() + 0.25;
    const auto verify = [&](const Target& target, const Mesh& volume) {
      return verify_volume(whole.scene, target, whole.sensor, whole.navigation, volume);
    };
    expect_right(verify(halves, whole.truth));
    const VerifyReport half = verify(halves.part(0), whole.truth);
    EXPECT_EQ(half.over_claimed, 0u);
    EXPECT_GT(half.under_claimed, 10u) << "of one part alone more is seen";
    const VerifyReport uncut = verify(halves, make_box_mesh(shift + Vec3(-10, -10, 1), shift + Vec3(10, 10, 10)));
    EXPECT_GT(uncut.over_claimed, 100u);
    EXPECT_EQ(uncut.worst_over_cause, "plate");
  }
  // A second part that stands upright, and sees only what lies to the south of it.
  const Example example = plate_example();
  Target both = example.target;
  both.parts.push_back({{-1, 1, 0}, {1, 1, 0}, {1, 1, 2}, {-1, 1, 2}});
  both.front = Vec3(0, -1, 1);
  Navigation low;
  low.keep_in = {Box{Vec3(-10, -10, 1), Vec3(10, 10, 4)}};  // under the plate nothing is hidden
  expect_right(verify_volume(example.scene, both, example.sensor, low, make_box_mesh({-10, -10, 1}, {10, 1, 4})));
  const VerifyReport north =
      verify_volume(example.scene, both, example.sensor, low, make_box_mesh({-10, -10, 1}, {10, 10, 4}));
  EXPECT_GT(north.over_claimed, 100u);
  EXPECT_EQ(north.worst_over_cause, "target plane");
  Target none = example.target;
  none.parts.clear();
  EXPECT_THROW(verify_volume(example.scene, none, example.sensor, {}, example.truth), Error);
  VerifyOptions two_lifts;
  two_lifts.lift_m = {0, 0};
  EXPECT_THROW(verify_volume(example.scene, example.target, example.sensor, {}, example.truth, two_lifts), Error);
}

TEST(Verify, DoesNotDependOnThreads) {
  const Example example = plate_example();
  const Mesh box = make_box_mesh({-10, -10, 1}, {10, 10, 10});
  VerifyOptions options;
  options.points = 4000;
  VerifyReport one, all;
  parallel::with_threads(1, [&] { one = example.verify(box, options); });
  parallel::with_threads(2, [&] { all = example.verify(box, options); });
  EXPECT_EQ(one.inside, all.inside);
  EXPECT_EQ(one.rays, all.rays);
  EXPECT_EQ(one.over_claimed, all.over_claimed);
  EXPECT_EQ(one.under_claimed, all.under_claimed);
  EXPECT_EQ(one.worst_over_depth_m, all.worst_over_depth_m);
  EXPECT_EQ(one.worst_over_point, all.worst_over_point);
  EXPECT_EQ(one.over_claim_bound, all.over_claim_bound);
  options.seed = 2;
  EXPECT_NE(example.verify(box, options).rays, one.rays);
}

TEST(Verify, AgreesWithAPlainLoop) {
  // Claimed by nobody or by everybody: over- and under-claims together are what the plain loop says, viewpoint for
  // viewpoint.
  const Example example = plate_example();
  const Mesh box = make_box_mesh({-10, -10, 1}, {10, 10, 10});
  VerifyOptions options;
  options.points = 1;
  const std::uint64_t seed = 500;
  std::cout << "seeds from " << seed << "\n";
  int hidden = 0;
  for (options.seed = seed; options.seed < seed + 300; ++options.seed) {
    const VerifyReport report = example.verify(box, options);
    if (report.over_claimed == 0) continue;
    ++hidden;
    EXPECT_FALSE(testing::sees_all(example.scene, example.target.parts[0], report.worst_over_point, 2000));
  }
  EXPECT_GT(hidden, 0);
}

TEST(Verify, ReportsProgressAndStops) {
  const Example example = plate_example();
  VerifyOptions options;
  options.points = 2000;
  const auto story = testing::check_progress([&](const Progress& progress) {
    verify_volume(example.scene, example.target, example.sensor, example.navigation, example.truth, options, progress);
  });
  // A thread that finds another one asking goes on: on a busy machine there are far fewer questions than viewpoints.
  EXPECT_GT(story.calls, 100U);
  EXPECT_GT(story.last_fraction.at("verify"), 0.9);
}

TEST(Verify, ReportsAMeshWithHoles) {
  Example example = plate_example();
  example.truth.triangles.pop_back();
  const VerifyReport report = example.verify(example.truth);
  EXPECT_FALSE(report.closed);
  EXPECT_FALSE(report.is_right());
  EXPECT_EQ(report.open_edges.count, 3U);
  EXPECT_EQ(report.open_edges.count, find_open_edges(example.truth).count);
  EXPECT_EQ(report.points, 0U);
}

/// They claim nothing: two that cancel each other, of one line, and one that two of its corners lie in one place of.
TEST(Verify, FacetsOfNoExtentAreToldAndNotWrong) {
  Example example = plate_example();
  Mesh mesh = example.truth;
  const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, -0.5}, {0, 0, 1}, {0, 0, 2}, mesh.vertices[0]});
  mesh.triangles.insert(mesh.triangles.end(),
                        {{next, next + 1, next + 2}, {next, next + 2, next + 1}, {0, next + 3, 1}});
  const VerifyReport report = example.verify(mesh);
  EXPECT_EQ(report.flat_facets, 3U);
  EXPECT_TRUE(report.is_right());
  EXPECT_EQ(example.verify(example.truth).flat_facets, 0U);
  for (Vec3& vertex : mesh.vertices) vertex *= 1.01;
  EXPECT_FALSE(example.verify(mesh).is_right());
}

/// Of a needle no point is tried: nothing is known of it then.
TEST(Verify, AVolumeWithoutAPointInsideIsNotRight) {
  Example example = plate_example();
  const VerifyReport report = example.verify(make_box_mesh({0, 0, 20}, {1e-20, 1e-20, 30}));
  EXPECT_TRUE(report.is_solid());
  EXPECT_EQ(report.inside, 0U);
  EXPECT_FALSE(report.is_right());
}

/// However far away the target is, what is out of range may be no deeper inside than what is in range.
TEST(Verify, ATargetFarOutOfRange) {
  Example example = plate_example();
  example.target = Target::point({1e9, 0, 0});
  example.navigation = {};
  const VerifyReport report = example.verify(make_box_mesh({-1, -1, 20}, {1, 1, 30}));
  EXPECT_GT(report.over_claimed, 0U);
  EXPECT_EQ(report.worst_over_cause, "max_range");
}

/// Products of such coordinates are no numbers.
TEST(Verify, RefusesCoordinatesThatAreTooFar) {
  const Example example = plate_example();
  for (const double far : {1.1e9, 1e155, 1e300}) {
    Example scene = example, target = example, offset = example;
    scene.scene.mesh.vertices[0].x() = far;
    target.target = Target::point({far, 0, 0});
    offset.target.offset_m = far;
    for (const Example& one : {scene, target, offset}) {
      expect_code([&] { one.verify(one.truth); }, ErrorCode::coordinate_too_large);
    }
    const Mesh volume = make_box_mesh({-1, -1, 20}, {1, 1, far});
    expect_code([&] { example.verify(volume); }, ErrorCode::coordinate_too_large);
  }
}

/// A box to stay out of may reach as far as doubles do.
TEST(Verify, AWideBoxToStayOutOf) {
  for (const double far : {1e3, 1e155, 1e308}) {
    Example example = plate_example();
    example.navigation.keep_out = {Box{{-far, -far, -far}, {far, far, far}}};
    EXPECT_EQ(example.verify(example.truth).worst_over_cause, "keep_out zone 0") << far;
  }
}

/// A height that is as good as none takes nothing from the other one.
TEST(Verify, AFarHeightAboveGround) {
  for (const double far : {1e3, 1e18, 1e300}) {
    Example example = plate_example();
    example.navigation = {};
    example.navigation.above_ground = AboveGround{1000, 1000 + far, {}};
    EXPECT_EQ(example.verify(example.truth).worst_over_cause, "agl min") << far;
    example.navigation.above_ground = AboveGround{-far, -1, {}};
    EXPECT_EQ(example.verify(example.truth).worst_over_cause, "agl max") << far;
  }
}

TEST(Verify, RefusesBadInput) {
  const Example example = plate_example();
  const auto refused = [&](const std::function<void(Example&, VerifyOptions&)>& change) {
    Example bad = example;
    VerifyOptions options;
    options.points = 8;
    change(bad, options);
    return testing::code_of([&] { bad.verify(bad.truth, options); });
  };
  EXPECT_EQ(refused([](Example&, VerifyOptions&) {}), std::nullopt);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) { e.truth = {}; }), ErrorCode::mesh_empty);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) { e.sensor.max_range_m = 0; }), ErrorCode::value_out_of_range);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) { e.sensor.max_range_m = std::nan(""); }),
            ErrorCode::value_out_of_range);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) { e.target.parts[0].resize(2); }), ErrorCode::target_vertex_count);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) {
              e.navigation.altitude = Navigation::Altitude{5, 1};
            }),
            ErrorCode::limits_reversed);
  EXPECT_EQ(refused([](Example& e, VerifyOptions&) { e.scene.mesh.triangles[0][1] = 99; }),
            ErrorCode::index_out_of_range);
  EXPECT_EQ(refused([](Example&, VerifyOptions& o) { o.depth_tolerance = -1; }), ErrorCode::value_out_of_range);
  EXPECT_EQ(refused([](Example&, VerifyOptions& o) { o.target_samples = -1; }), ErrorCode::value_out_of_range);
  EXPECT_EQ(refused([](Example&, VerifyOptions& o) { o.points = 0; }), ErrorCode::value_out_of_range);
}

}  // namespace
}  // namespace vantage
