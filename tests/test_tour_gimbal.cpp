// Tours keep the rate of the gimbal: what is planned passes the check of flights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "flight/gimbal.h"
#include "flight/tour/tour_schedule.h"
#include "support/flight_cases.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/mission_tour.h"

namespace vantage::testing {
namespace {

/// Squares on a plane, apart, and a few boxes between them.
Mission drawn_squares(Random& random, TourVehicle::Kind kind) {
  SceneBuilder scene;
  scene.ground("ground", 400, -0.5);
  for (int i = 0; i < 3; ++i) {
    const Vec3 middle(random.uniform(-150, 150), random.uniform(-60, -30), -0.5);
    scene.box("box " + std::to_string(i), middle - Vec3(4, 4, 0), middle + Vec3(4, 4, random.uniform(5, 20)));
  }
  const bool is_wing = kind == TourVehicle::Kind::fixed_wing;
  const int count = is_wing ? random.integer(1, 3) : 3;
  std::vector<std::vector<Target>> views;
  for (int i = 0; i < count; ++i) {
    // A multirotor passes over the middle one on its way.
    const Vec3 at = is_wing ? Vec3(random.uniform(-150, 150), 60.0 * i + random.uniform(0, 20), 0)
                            : Vec3(150.0 * (i - 1), random.uniform(-5, 5), 0);
    Target target = target_of({at + Vec3(-2, -2, 0), at + Vec3(2, -2, 0), at + Vec3(2, 2, 0), at + Vec3(-2, 2, 0)});
    target.name = "square " + std::to_string(i);
    views.push_back({target});
  }
  Mission mission = mission_in(scene, views[0][0], is_wing ? random.uniform(60, 120) : random.uniform(60, 75));
  if (count > 1) {
    mission.views = views;
    mission.as_written.combine = Combine::each;
  }
  mission.navigation.altitude = {{.min_m = 10, .max_m = 100}};
  TourSettings tour;
  tour.vehicle.kind = kind;
  tour.vehicle.speed_m_s = random.uniform(10, 22);
  tour.vehicle.turn_radius_m = random.uniform(15, 40);
  tour.dwell_s = is_wing ? random.uniform(0.5, 2.5) : random.uniform(2, 3);
  tour.gimbal_rate_deg_s = random.uniform(8, 25);
  tour.clearance_m = 3;
  tour.time_limit_s = 1;
  mission.as_written.tour = tour;
  return mission;
}

struct Outcome {
  int planned = 0, refused = 0, would_fail = 0;
};

void fly(std::uint64_t seed, TourVehicle::Kind kind, Outcome& outcome) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  Mission mission = drawn_squares(random, kind);
  try {
    const MissionTour tour = plan_mission_tour(mission, {.threads = 1, .with_bound = false});
    if (!tour.is_complete()) return;
    const FlightCheck check = check_flight(mission, tour.tour.flight);
    ++outcome.planned;
    for (const std::string& failure : check.failures) ADD_FAILURE() << failure;
  } catch (const Error& error) {
    ASSERT_EQ(error.code(), ErrorCode::limits_empty) << message_of(error);
    ++outcome.refused;
  }
  // Is the rate a limit at all?
  const double rate = mission.as_written.tour->gimbal_rate_deg_s;
  mission.as_written.tour->gimbal_rate_deg_s = 36'000;
  const MissionTour fast = plan_mission_tour(mission, {.threads = 1, .with_bound = false});
  if (!fast.is_complete()) return;
  if (!check_flight(mission, fast.tour.flight, {.gimbal_rate_deg_s = rate}).passes()) ++outcome.would_fail;
}

TEST(TourGimbal, FixedWingsTurnTheCameraSlowlyEnough) {
  Outcome outcome;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) fly(seed, TourVehicle::Kind::fixed_wing, outcome);
  EXPECT_GE(outcome.planned, 5);
  EXPECT_GE(outcome.would_fail, 2);
}

TEST(TourGimbal, MultirotorsDoSoInPassing) {
  Outcome outcome;
  for (std::uint64_t seed = 101; seed <= 112; ++seed) fly(seed, TourVehicle::Kind::multirotor, outcome);
  EXPECT_EQ(outcome.refused, 0);
  EXPECT_GE(outcome.planned, 10);
  EXPECT_GE(outcome.would_fail, 1);
}

TEST(TourGimbal, WhatPassesTooFastIsRefusedByName) {
  Random random(7);
  Mission mission = drawn_squares(random, TourVehicle::Kind::fixed_wing);
  mission.as_written.tour->gimbal_rate_deg_s = 0.5;
  try {
    plan_mission_tour(mission, {.threads = 1, .with_bound = false});
    ADD_FAILURE() << "a camera that hardly turns follows nothing";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limits_empty);
    EXPECT_NE(error.where().find(mission.target.name.substr(0, 6)), std::string::npos) << error.where();
  }
}

TEST(TourGimbal, TurnsNearALegAreNoFaster) {
  Random random(8);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 along = random.uniform(1, 20) * random.direction(), from = random.uniform(3, 30) * random.direction();
    const double reach = random.uniform(0.001, 1);
    const double aside = random.chance(0.5) ? 0 : random.uniform(0, 0.5);
    const double most = internal::flight::fastest_turn_deg_s({from, from + along}, Vec3::Zero(), 10, {reach, aside});
    // Somewhere near, or as near to the point as may be.
    const double share = std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    Vec3 beside = reach * random.uniform(0, 1) * random.direction();
    if (random.chance(0.5)) beside = -reach * (from + share * along).normalized();
    // In another direction, about the place where it is nearest.
    Vec3 turned = along.normalized() + aside * random.direction();
    if ((turned.normalized() - along.normalized()).norm() > aside) turned = along;
    const Vec3 at = from + share * along + beside, ahead = 1e-6 * turned.normalized();
    const double turn = internal::flight::fastest_turn_deg_s({at, at + ahead}, Vec3::Zero(), 10);
    ASSERT_LE(turn, most * (1 + 1e-6)) << i;
  }
}

TEST(TourGimbal, StretchesInPassingAreThoseThatAreSlow) {
  namespace tour = internal::flight::tour;
  Random random(9);
  std::size_t slow = 0, fast = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> points;
    for (int k = random.integer(2, 5); k > 0; --k) {
      points.emplace_back(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(5, 40));
    }
    const tour::Polyline way(points);
    TourTarget target;
    target.look_at = Vec3::Zero();
    TourRequest request;
    request.settings.gimbal_rate_deg_s = random.uniform(5, 60);
    const std::vector<tour::Stretch> all = {{0.1 * way.length_m(), 0.6 * way.length_m()}};
    const std::vector<tour::Stretch> found = tour::stretches_followed(all, way, target, request);
    for (int k = 0; k < 100; ++k) {
      constexpr double kStep = 1e-4;  // metres
      const double station = random.uniform(0, way.length_m() - kStep);
      const Vec3 a = way.at(station), b = way.at(station + kStep);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
      const double rate = angle / (kStep / request.settings.vehicle.speed_m_s);
      const bool is_in = std::any_of(found.begin(), found.end(), [&](const tour::Stretch& one) {
        return one.begin_m <= station && station + kStep <= one.end_m;
      });
      if (is_in) {
        ++slow;
        ASSERT_GE(station, all[0].begin_m);
        ASSERT_LE(station, all[0].end_m);
        ASSERT_LE(rate, request.settings.gimbal_rate_deg_s) << i;
      } else if (station > all[0].begin_m + 0.01 && station < all[0].end_m - 0.01) {
        fast += rate > request.settings.gimbal_rate_deg_s ? 1 : 0;
        ASSERT_GE(rate, 0.97 * request.settings.gimbal_rate_deg_s) << i;
      }
    }
  }
  EXPECT_GT(slow, 1000U);
  EXPECT_GT(fast, 200U);
}

}  // namespace
}  // namespace vantage::testing
