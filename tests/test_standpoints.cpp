// The best places of a volume: closed forms, and a grid of all positions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/flight_cases.h"
#include "support/random.h"
#include "support/wording.h"
#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/standpoints.h"

namespace vantage {
namespace {

using testing::expect_code;
using testing::FlightCase;
using testing::mission_in;
using testing::open_square;
using testing::plain_depth;
using testing::plain_distance;
using testing::Random;

Standpoints found_in(const FlightCase& one, const StandpointOptions& options = {}) {
  return find_standpoints(one.mission, one.volume, one.scene, ViewDescriber(one.mission), options);
}

std::map<StandpointKind, Standpoint> by_kind(const Standpoints& standpoints) {
  std::map<StandpointKind, Standpoint> result;
  for (const Standpoint& point : standpoints.found) result.emplace(point.kind, point);
  return result;
}

/// Inside by the mesh and by the query, and as deep as it says.
void expect_inside(const FlightCase& one, const Standpoints& standpoints) {
  for (const Standpoint& point : standpoints.found) {
    SCOPED_TRACE(name_of(point.kind));
    EXPECT_TRUE(one.ask({point.view.position})[0].inside);
    const double depth = plain_depth(one.volume.mesh, point.view.position);
    EXPECT_GE(depth, point.margin_m);
    EXPECT_NEAR(depth, point.margin_m, 1e-7);
    EXPECT_GE(depth, standpoints.margin_m);
  }
}

// Of a square of 4 m and a range of 50 m, by hand: the ball in the volume touches the plane, and the ranges of all four
// corners. Straight above, d = sqrt(h * h + 8) is the distance of a corner.
TEST(Standpoints, OfAnOpenSquareAreThoseOfTheClosedForms) {
  for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(5e5, 5e6, 500)}) {
    Mission mission = open_square(centre, 50);
    mission.sensor.camera = pinhole_of_fov(178, 178, 4000, 4000);  // takes in all of it from anywhere near
    const double focal = *mission.sensor.camera->focal_px;
    const FlightCase one(mission);
    const Standpoints standpoints = found_in(one, {.margin_m = 1, .tolerance_m = 0.05});
    EXPECT_EQ(standpoints.reason, "");
    expect_inside(one, standpoints);
    auto points = by_kind(standpoints);
    ASSERT_EQ(points.size(), 5U);

    const Standpoint& deepest = points[StandpointKind::deepest];
    EXPECT_NEAR(deepest.value, 24.92, 0.25);  // the range's facets lie 0.2 m inside
    EXPECT_GE(deepest.bound, deepest.value);
    EXPECT_NEAR((deepest.view.position - centre - Vec3(0, 0, 24.92)).norm(), 0, 1);
    const Standpoint& nearest = points[StandpointKind::nearest];
    EXPECT_NEAR(nearest.value, 1, 0.11);
    EXPECT_LE(nearest.bound, nearest.value);
    const Standpoint& finest = points[StandpointKind::finest_pixel];
    EXPECT_NEAR(finest.value, 2 * std::sqrt(8) / focal, 0.006 * finest.value);
    EXPECT_EQ(finest.view.pixel_m, finest.value);
    const Standpoint& best = points[StandpointKind::best_incidence];
    EXPECT_NEAR(best.value, std::atan(std::sqrt(8) / (std::sqrt(49 * 49 - 8))) * 180 / std::numbers::pi, 0.15);
    EXPECT_LE(best.bound, best.value);
    const Standpoint& farthest = points[StandpointKind::farthest];
    EXPECT_LT(farthest.view.position.x(), centre.x() - 40);
    EXPECT_EQ(farthest.view.obstacle, "far block");
    EXPECT_NEAR(*farthest.view.obstacle_distance_m, plain_distance(mission.scene().mesh, farthest.view.position), 1e-6);
  }
}

TEST(Standpoints, AreNoWorseThanAnyPositionOfAGrid) {
  Random random(28);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(round);
    Scene scene = testing::random_city(random, 12, 8);
    scene.objects[0].kind = ObjectKind::ground;
    Mission mission = mission_in(scene, testing::random_target(random, 5, 3, Vec3(0, 0, 0), Vec3::UnitZ()), 60);
    mission.sensor.camera = pinhole_of_fov(60, 45, 4000, 3000);
    const FlightCase one(mission);
    const ViewDescriber describer(mission);
    const StandpointOptions options{.margin_m = 0.5, .tolerance_m = 0.1};
    const Standpoints standpoints = found_in(one, options);
    expect_inside(one, standpoints);
    auto points = by_kind(standpoints);
    ASSERT_EQ(points.size(), 5U);

    const Box box = bounding_box(one.volume.mesh);
    constexpr int kAlong = 9;
    for (int i = 0; i < kAlong * kAlong * kAlong; ++i) {
      const Vec3 share((i % kAlong + 0.5) / kAlong, (i / kAlong % kAlong + 0.5) / kAlong,
                       (i / (kAlong * kAlong) + 0.5) / kAlong);
      const Vec3 place = box.min + share.cwiseProduct(box.max - box.min);
      const double depth = plain_depth(one.volume.mesh, place);
      EXPECT_LE(depth, points[StandpointKind::deepest].bound + 1e-9);
      if (depth < options.margin_m + options.tolerance_m + 1e-9) continue;
      const ViewDescription view = describer.describe(place);
      EXPECT_GE(view.distance_m, points[StandpointKind::nearest].bound - 1e-9);
      EXPECT_GE(*view.pixel_m, points[StandpointKind::finest_pixel].bound * (1 - 1e-9));
      EXPECT_GE(*view.incidence_deg, points[StandpointKind::best_incidence].bound - 1e-9);
      EXPECT_LE(*view.obstacle_distance_m, points[StandpointKind::farthest].bound + 1e-9);
    }
    EXPECT_LE(points[StandpointKind::deepest].bound - points[StandpointKind::deepest].value, 0.1 + 1e-6);
    EXPECT_LE(points[StandpointKind::nearest].value - points[StandpointKind::nearest].bound, 0.1 + 1e-9);
    EXPECT_LE(points[StandpointKind::farthest].bound - points[StandpointKind::farthest].value, 0.1 + 1e-9);
  }
}

// The camera looks where the target is: north of it, above, and straight up.
TEST(Standpoints, AreDescribedWithTheirAim) {
  Mission mission = open_square(Vec3(0, 0, 0), 50);
  const ViewDescriber describer(mission);
  const ViewDescription from_south = describer.describe(Vec3(0, -10, 10));
  EXPECT_NEAR(from_south.yaw_deg, 0, 1e-9);
  EXPECT_NEAR(from_south.pitch_deg, -45, 1e-9);
  EXPECT_TRUE(from_south.is_centred);
  EXPECT_NEAR(from_south.distance_m, std::sqrt(200.0), 1e-9);
  EXPECT_NEAR(describer.describe(Vec3(-10, 0, 10)).yaw_deg, 90, 1e-9);
  EXPECT_NEAR(describer.describe(Vec3(10, 0, 10)).yaw_deg, 270, 1e-9);
  EXPECT_NEAR(describer.describe(Vec3(0, 0, 10)).pitch_deg, -90, 1e-9);
  EXPECT_FALSE(from_south.longitude_deg || from_south.above_sea_m || from_south.pixel_m);
  expect_code([&] { describer.describe(Vec3(0, 0, NAN)); }, ErrorCode::coordinate_not_finite);

  mission.sensor.mount = {.yaw_deg = 0, .min_pitch_deg = -90, .max_pitch_deg = -60};
  const ViewDescription fixed = ViewDescriber(mission, describer).describe(Vec3(-10, 0, 10));
  EXPECT_FALSE(fixed.is_centred);
  EXPECT_NEAR(fixed.yaw_deg, 0, 1e-9);
  EXPECT_NEAR(fixed.pitch_deg, -60, 1e-9);
}

TEST(Standpoints, HaveAPlaceOnTheEarthAndHeights) {
  testing::SceneBuilder builder;
  builder.ground("ground", 100, 3);
  Scene scene = builder;
  scene.objects[0].kind = ObjectKind::ground;
  scene.georeference = Georeference{48.137, 11.575, "EGM96 geoid", ""};
  const Mission mission =
      mission_in(scene, testing::target_of({{-2, -2, 3.5}, {2, -2, 3.5}, {2, 2, 3.5}, {-2, 2, 3.5}}), 50);
  const ViewDescription view = ViewDescriber(mission).describe(Vec3(0, 0, 20));
  EXPECT_NEAR(*view.latitude_deg, 48.137, 1e-9);
  EXPECT_NEAR(*view.longitude_deg, 11.575, 1e-9);
  EXPECT_NEAR(*view.above_ground_m, 17, 1e-9);
  EXPECT_NEAR(*view.above_sea_m, 20, 1e-9);
  EXPECT_FALSE(ViewDescriber(mission).describe(Vec3(1000, 0, 20)).above_ground_m);
}

TEST(Standpoints, OfSeveralPiecesAreInTheBestOfThem) {
  Mission mission = open_square(Vec3(0, 0, 0), 60);
  mission.navigation.keep_in = {Box{Vec3(-30, -5, 5), Vec3(-20, 5, 12)}, Box{Vec3(15, -10, 5), Vec3(35, 10, 25)}};
  const FlightCase one(mission);
  ASSERT_EQ(measure(one.volume.mesh).pieces, 2U);
  const Standpoints standpoints = found_in(one);
  expect_inside(one, standpoints);
  auto points = by_kind(standpoints);
  EXPECT_NEAR(points[StandpointKind::deepest].value, 10, 0.11);
  EXPECT_GT(points[StandpointKind::deepest].view.position.x(), 0);
  EXPECT_NEAR(points[StandpointKind::nearest].value, std::hypot(16, 6), 0.3);
  EXPECT_LT(points[StandpointKind::farthest].view.position.x(), 0);
}

TEST(Standpoints, OfAThinVolumeKeepASmallerMargin) {
  Mission mission = open_square(Vec3(0, 0, 0), 60);
  mission.navigation.altitude = Navigation::Altitude{10, 10.4};
  const FlightCase one(mission);
  const Standpoints thin = found_in(one);
  EXPECT_EQ(thin.reason, "");
  EXPECT_NEAR(thin.margin_m, 0.05, 0.01);
  expect_inside(one, thin);
  const Standpoints none = found_in(one, {.margin_m = 1});
  EXPECT_TRUE(none.found.empty());
  EXPECT_NE(none.reason, "");
}

TEST(Standpoints, OfNoVolumeSayWhy) {
  Mission mission = open_square(Vec3(0, 0, 0), 60);
  mission.navigation.altitude = Navigation::Altitude{100, 200};
  const FlightCase one(mission);
  const Standpoints none = found_in(one);
  EXPECT_TRUE(none.found.empty());
  EXPECT_EQ(none.reason, one.volume.reason);
}

TEST(Standpoints, SayWhatIsNotMeasured) {
  Mission mission = mission_in(testing::SceneBuilder().box("block", Vec3(90, 0, 0), Vec3(99, 9, 9)),
                               Target::point(Vec3(0, 0, 5)), 20);
  const FlightCase one(mission);
  const Standpoints standpoints = found_in(one);
  EXPECT_EQ(standpoints.notes.size(), 2U);
  EXPECT_EQ(standpoints.found.size(), 3U);
  expect_inside(one, standpoints);
}

TEST(Standpoints, RefuseBadOptions) {
  const FlightCase one(open_square(Vec3(0, 0, 0), 20));
  for (const double bad : {-1.0, std::numeric_limits<double>::infinity()}) {
    expect_code([&] { found_in(one, {.margin_m = bad}); }, ErrorCode::value_out_of_range, "margin_m");
    expect_code([&] { found_in(one, {.tolerance_m = bad}); }, ErrorCode::value_out_of_range, "tolerance_m");
  }
  Mission each = one.mission;
  each.as_written.combine = Combine::each;
  each.views = {{each.target}, {each.target}};
  expect_code([&] { ViewDescriber{each}; }, ErrorCode::not_applicable);
}

}  // namespace
}  // namespace vantage
