// Outer volumes hold every position that sees the target.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using testing::expect_code;
using testing::Random;
using testing::random_city;
using testing::random_target;

Mission mission_in(Scene scene, Target target, double range_m) {
  Mission mission;
  auto loaded = std::make_shared<LoadedScene>();
  loaded->scene = std::move(scene);
  mission.loaded = loaded;
  mission.target = std::move(target);
  mission.sensor.max_range_m = range_m;
  return mission;
}

/// Places on both sides of a volume's surface, at all scales, and anywhere in its box.
std::vector<Vec3> places_about(const Volume& volume, Random& random, int count) {
  std::vector<Vec3> places;
  const Box box = bounding_box(volume.mesh);
  const Vec3 centre = volume.frame.origin;
  const int last = static_cast<int>(volume.mesh.triangles.size()) - 1;
  for (int i = 0; i < count; ++i) {
    places.push_back(random.in_box(box));
    const Triangle& t = volume.mesh.triangles[static_cast<std::size_t>(random.integer(0, last))];
    double a = random.uniform(0, 1), b = random.uniform(0, 1);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const auto& v = volume.mesh.vertices;
    const Vec3 at = v[t[0]] + a * (v[t[1]] - v[t[0]]) + b * (v[t[2]] - v[t[0]]);
    const double off = std::pow(10.0, random.uniform(-9, -2)) * (random.chance(0.5) ? 1 : -1);
    places.push_back(centre + (1 + off) * (at - centre));
  }
  return places;
}

/// Of the places that the exact query allows, how many lie outside of a mesh.
struct Escaped {
  int inside = 0, outside = 0;
};
Escaped escaped(const Mission& mission, const Mesh& mesh, const std::vector<Vec3>& places) {
  const PreparedScene scene(mission.scene());
  const std::vector<PointAnswer> answers = query_points(prepare_target(mission, scene), mission.navigation, places);
  const std::vector<double> depths = SolidIndex(mesh).depths_m(places);
  Escaped count;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!answers[i].inside) continue;
    ++count.inside;
    if (depths[i] < 0) ++count.outside;
  }
  return count;
}

/// Looks at many places, and expects that the mesh of the same computation, not moved out, lacks some of them: so the
/// places are hard ones.
void expect_holds_all(const Mission& mission, Random& random) {
  const OuterVolume outer = outer_volume(mission);
  ASSERT_FALSE(outer.volume.empty());
  Mission coarse = mission;
  coarse.as_written.exact.tolerance_m = 1e-3 * mission.sensor.max_range_m;
  const std::vector<Vec3> places = places_about(run_mission(mission).volume, random, 4000);
  const Escaped from_outer = escaped(mission, outer.volume.mesh, places);
  EXPECT_GT(from_outer.inside, 2000);
  EXPECT_EQ(from_outer.outside, 0);
  EXPECT_GT(escaped(mission, run_mission(coarse).volume.mesh, places).outside, 20);
}

TEST(OuterVolume, HoldsAllPositionsInCities) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    Random random(seed);
    Mission mission = mission_in(random_city(random, 30, 12), {}, 80);
    mission.target = random_target(random, 5, random.uniform(1, 8), Vec3(0, 0, 0.5), Vec3(0, 0, 1));
    expect_holds_all(mission, random);
  }
}

TEST(OuterVolume, HoldsAllPositionsWithinLimits) {
  Random random(21);
  Mission mission = mission_in(random_city(random, 30, 12), {}, 80);
  mission.target = random_target(random, 4, 5, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
  mission.navigation.altitude = {4, 50};
  mission.navigation.keep_in = {Box{{-60, -60, 0}, {60, 40, 60}}};
  mission.navigation.keep_out = {Box{{-9, -30, 20}, {20, 40, 40}}};
  mission.navigation.clearance = Clearance{2, obstacles_of(mission.scene(), {0})};
  expect_holds_all(mission, random);
  EXPECT_EQ(outer_volume(mission).ignored, std::vector<std::string>{"clearance"});
  // It is cut: not only the sight bounds it.
  const Box box = bounding_box(outer_volume(mission).volume.mesh);
  EXPECT_NEAR(box.min.z(), 3.99, 1e-6);
  EXPECT_NEAR(box.max.z(), 50.01, 1e-6);
}

TEST(OuterVolume, HoldsAllPositionsWithinAnIncidence) {
  Random random(25);
  Mission mission = mission_in(random_city(random, 30, 12), {}, 80);
  mission.target = random_target(random, 5, 6, Vec3(0, 0, 2), Vec3(0.2, -0.1, 1));
  mission.sensor.incidence_deg = 60;
  expect_holds_all(mission, random);
  const OuterVolume outer = outer_volume(mission);
  EXPECT_TRUE(outer.ignored.empty());
  // It is cut to little more than the cones.
  const TargetFrame frame = prepare_target(mission, PreparedScene(mission.scene())).frame();
  const Box box = bounding_box(outer.volume.mesh);
  std::vector<Vec3> places;
  for (int i = 0; i < 1500; ++i) places.push_back(random.in_box(box));
  const std::vector<double> depths = SolidIndex(outer.volume.mesh).depths_m(places);
  int inside = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (depths[i] < 0) continue;
    ++inside;
    const Vec3 local = frame.to_local(places[i]);
    for (const Eigen::Vector2d& corner : frame.polygon) {
      const double aside = (local.head<2>() - corner).norm();
      EXPECT_LE(aside, 1.002 * std::tan(60 * std::numbers::pi / 180) * (local.z() + 0.02));
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(OuterVolume, HoldsAllPositionsOfALargeTarget) {
  // Its corners are so far from its centre that facets of the range must move out by more than they are coarse.
  Random random(31);
  Mission mission = mission_in(random_city(random, 20, 50), {}, 52);
  mission.target = random_target(random, 6, 48, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
  expect_holds_all(mission, random);
}

TEST(OuterVolume, HoldsAllPositionsForSeveralParts) {
  Random random(41);
  Mission mission = mission_in(random_city(random, 30, 14), {}, 80);
  mission.target = random_target(random, 4, 4, Vec3(-5, 0, 0.5), Vec3(0, 0, 1));
  mission.target.parts.push_back(random_target(random, 3, 3, Vec3(6, 2, 0.5), Vec3(0.1, 0, 1)).parts[0]);
  expect_holds_all(mission, random);
}

TEST(OuterVolume, OfAShareIsAllInRange) {
  Random random(51);
  Mission mission = mission_in(random_city(random, 30, 12), {}, 60);
  mission.target = random_target(random, 4, 5, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
  mission.sensor.visible = VisibleShare{0.5, 8};
  const OuterVolume outer = outer_volume(mission);
  EXPECT_EQ(outer.ignored, std::vector<std::string>{"visible"});
  const std::vector<Vec3> places = places_about(outer.volume, random, 2000);
  EXPECT_EQ(escaped(mission, outer.volume.mesh, places).outside, 0);
  EXPECT_GT(escaped(mission, outer.volume.mesh, places).inside, 500);
}

TEST(OuterVolume, IsEmptyOutOfRange) {
  Random random(61);
  Mission mission = mission_in(random_city(random, 5, 12), {}, 3);
  mission.target = random_target(random, 4, 5, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
  EXPECT_TRUE(outer_volume(mission).volume.empty());
}

TEST(OuterVolume, RefusesWrongNumbers) {
  const Mission mission = mission_in({}, Target::polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_code([&] { outer_volume(mission, {}, {.tolerance_m = nan}); }, ErrorCode::value_out_of_range, "tolerance_m");
  expect_code([&] { outer_volume(mission, {}, {.limit_margin_m = 0}); }, ErrorCode::value_out_of_range,
              "limit_margin_m");
}

TEST(ProveMaximal, AloneFindsTheSameWitnesses) {
  Random random(71);
  Mission mission = mission_in(random_city(random, 30, 12), {}, 80);
  mission.target = random_target(random, 5, 3, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
  const Volume volume = run_mission(mission).volume;
  ProveOptions options{.lift_m = volume.lift_m, .maximal = true};
  const MaximalProof part =
      *prove_volume(mission.scene(), mission.target, mission.sensor, {}, volume.mesh, options).maximal;
  const MaximalProof alone = prove_maximal(mission.scene(), mission.target, mission.sensor, {}, volume.mesh, options);
  EXPECT_EQ(alone.open, part.open);
  EXPECT_EQ(alone.proved_share, part.proved_share);
  EXPECT_EQ(alone.conditions_hold(), part.conditions_hold());
  options.other_side_m = 0;
  expect_code([&] { prove_maximal(mission.scene(), mission.target, mission.sensor, {}, volume.mesh, options); },
              ErrorCode::not_applicable, "other_side_m");
}

}  // namespace
}  // namespace vantage
