// LegDistances against all triangles, one by one, and where the distance is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/triangle_distance.h"
#include "support/internals.h"
#include "support/legs.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::kLegWorlds;
using testing::LegWorld;
using testing::place_on;
using testing::Random;
using testing::SceneBuilder;

double distance_from(const Scene& scene, const Vec3& point, const std::vector<std::uint32_t>& without = {}) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (std::ranges::count(without, scene.object_of[t])) continue;
    const auto& [a, b, c] = scene.mesh.triangles[t];
    const auto& v = scene.mesh.vertices;
    least = std::min(least, core::squared_distance_to_triangle(point, v[a], v[b], v[c]));
  }
  return std::sqrt(least);
}

TEST(LegDistances, AgreesWithEveryTriangle) {
  Random random(20250313);
  std::size_t met = 0, apart = 0;
  for (const LegWorld& world : kLegWorlds) {
    SCOPED_TRACE(world.scale);
    const Scene scene = world.scene(testing::random_city(random, 25, 5));
    const LegDistances all((PreparedScene(scene)));
    const LegDistances buildings((PreparedScene(scene)), {.without_objects = {0}});
    for (int i = 0; i < 40; ++i) {
      const auto place = [&] { return world.at(random.in_box({{-110, -110, -5}, {110, 110, 60}})); };
      const Leg leg{place(), place()};
      const double length = (leg.to - leg.from).norm();
      for (const LegDistances* distances : {&all, &buildings}) {
        const std::vector<std::uint32_t> without =
            distances == &all ? std::vector<std::uint32_t>{} : std::vector<std::uint32_t>{0};
        const LegDistance nearest = distances->nearest(leg);
        const double slack = 1e-9 * std::min(1.0, world.scale) + 40 * world.rounding();
        EXPECT_NEAR((place_on(leg, nearest.share) - nearest.point).norm(), nearest.distance_m, slack);
        EXPECT_NEAR(distance_from(scene, place_on(leg, nearest.share), without), nearest.distance_m, slack);
        // No point of the leg is nearer.
        constexpr int kSteps = 200;
        double sampled = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= kSteps; ++k) {
          sampled = std::min(sampled, distance_from(scene, place_on(leg, k / double{kSteps}), without));
        }
        EXPECT_LE(nearest.distance_m, sampled);
        EXPECT_GE(nearest.distance_m, sampled - length / kSteps);
        (nearest.distance_m == 0 ? met : apart)++;
        EXPECT_FALSE(distances == &buildings && nearest.name == "ground");
      }
    }
  }
  EXPECT_GT(met, 20u);
  EXPECT_GT(apart, 50u);
}

TEST(LegDistances, KnowsDistancesAndPlaces) {
  const Scene scene = SceneBuilder().box("box", {10, -5, 0}, {20, 5, 8}).ground("ground", 100);
  const LegDistances distances((PreparedScene(scene)));
  const auto expect = [&](const Leg& leg, double distance, double share, const std::string& name) {
    const LegDistance nearest = distances.nearest(leg);
    EXPECT_NEAR(nearest.distance_m, distance, 1e-9);
    EXPECT_LE(nearest.distance_m, distance);
    EXPECT_NEAR(nearest.share, share, 1e-9);
    EXPECT_EQ(nearest.name, name);
  };
  expect({{0, 0, 7}, {0, 0, 7}}, 7, 0, "ground");
  expect({{5, 0, 30}, {5, 0, 8}}, 5, 1, "box");
  expect({{0, 9, 11}, {40, 9, 11}}, 5, 0.25, "box");         // beside the upper edge: the first of many places
  expect({{15, 0, 20}, {15, 0, 6}}, 0, 12.0 / 14, "box");    // into the roof
  expect({{9, 4, 9}, {9, 4, 9}}, std::sqrt(2.0), 0, "box");  // off the edge
  expect({{9, 6, 9}, {9, 6, 9}}, std::sqrt(3.0), 0, "box");  // off a corner
  expect({{14, -5, 8}, {16, 5, 8}}, 0, 0, "box");            // in a plane of the roof
  expect({{10, -9, 8}, {10, 9, 8}}, 0, 4.0 / 18, "box");     // along an edge
}

TEST(LegDistances, KeepsToTheCutOff) {
  Scene scene = SceneBuilder().box("box", {10, -5, 0}, {20, 5, 8}).ground("ground", 100);
  scene.objects[1].kind = ObjectKind::ground;
  const PreparedScene prepared(scene);
  const Leg leg{{0, 0, 9}, {5, 0, 9}};
  const LegDistance near = LegDistances(prepared, {.without_ground = true}).nearest(leg);
  EXPECT_NEAR(near.distance_m, std::hypot(5, 1), 1e-9);
  EXPECT_NEAR((near.point - Vec3(10, 0, 8)).norm(), 0, 1e-9);
  EXPECT_EQ(near.object, 0u);
  EXPECT_EQ(LegDistances(prepared, {.cutoff_m = 6, .without_ground = true}).nearest(leg).name, "box");
  const LegDistance none = LegDistances(prepared, {.cutoff_m = 5, .without_ground = true}).nearest(leg);
  EXPECT_EQ(none.distance_m, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(none.name.empty());
  EXPECT_EQ(LegDistances(prepared, {.cutoff_m = 9, .without_objects = {0}}).nearest(leg).name, "ground") << "at it";
  EXPECT_EQ(LegDistances(PreparedScene(Scene{})).nearest(leg).distance_m, std::numeric_limits<double>::infinity());
  const std::vector<LegDistance> many = LegDistances(prepared).nearest(std::vector<Leg>{leg, leg});
  EXPECT_EQ(many[0].distance_m, many[1].distance_m);
}

TEST(LegDistances, CountWhatHangsOverhead) {
  Scene scene = SceneBuilder().box("box", {10, -5, 0}, {20, 5, 8});
  scene.overhead = {{{"volt", "way/12"}, testing::make_box_mesh({30, -50, 0}, {31, 50, 40})}};
  const PreparedScene prepared(scene);
  const Leg between{{25, 0, 20}, {26, 0, 20}}, through{{9, 0, 20}, {60, 0, 20}};
  const LegDistance nearest = LegDistances(prepared).nearest(between);
  EXPECT_EQ(nearest.name, "way/12 volt");
  EXPECT_EQ(nearest.object, 1U);
  EXPECT_NEAR(nearest.distance_m, 4, 1e-9);
  EXPECT_EQ(LegDistances(prepared, {.without_objects = {0}}).nearest(through).distance_m, 0);
  EXPECT_EQ(LegDistances(prepared, {.without_overhead = true}).nearest(between).name, "box");
  EXPECT_EQ(LegDistances(prepared).nearest({{21, 0, 4}, {21, 0, 4}}).name, "box");
}

TEST(LegDistances, RefusesWhatIsNoOption) {
  const PreparedScene scene(SceneBuilder().ground("ground", 10));
  testing::expect_error([&] { LegDistances(scene, {.cutoff_m = -1}); }, ErrorCode::value_out_of_range);
  testing::expect_error([&] { LegDistances(scene, {.without_objects = {1}}); }, ErrorCode::index_out_of_range);
  testing::expect_error(
      [&] {
        LegDistances(scene).nearest({{0, 0, NAN}, {0, 0, 1}});
      },
      ErrorCode::coordinate_not_finite);
}

}  // namespace
}  // namespace vantage
