// Orbits in volumes: closed forms, dense sampling, and circles drawn at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "flight/closed_curve.h"
#include "flight/orbit_search.h"
#include "flight/segment_distance.h"
#include "flight/solid_depth.h"
#include "support/flight_cases.h"
#include "support/random.h"
#include "support/wording.h"
#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/standpoints.h"

namespace vantage {
namespace {

using internal::flight::ClosedCurve;
using testing::expect_code;
using testing::FlightCase;
using testing::mission_in;
using testing::open_square;
using testing::plain_depth;
using testing::Random;

Orbits found_in(const FlightCase& one, const OrbitOptions& options) {
  return find_orbits(one.mission, one.volume, one.scene, ViewDescriber(one.mission), options);
}

std::map<OrbitKind, Orbit> by_kind(const Orbits& orbits) {
  std::map<OrbitKind, Orbit> result;
  for (const Orbit& orbit : orbits.found) result.emplace(orbit.kind, orbit);
  return result;
}

/// Points of an orbit, by its own numbers.
std::vector<Vec3> around(const Orbit& orbit, int count) {
  const double heading = orbit.heading_deg * std::numbers::pi / 180;
  const Vec3 along(std::sin(heading), std::cos(heading), 0), right(std::cos(heading), -std::sin(heading), 0);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * std::numbers::pi * i / count;
    const double end = std::cos(turn) >= 0 ? orbit.straight_m / 2 : -orbit.straight_m / 2;
    points.push_back(orbit.centre + end * along + orbit.radius_m * (std::cos(turn) * along + std::sin(turn) * right));
    const double share = 2.0 * i / count - 1;
    for (const double side : {-1.0, 1.0}) {
      if (orbit.straight_m > 0) {
        points.push_back(orbit.centre + share * orbit.straight_m / 2 * along + side * orbit.radius_m * right);
      }
    }
  }
  return points;
}

/// Dense: all of it is inside by the query and by the mesh, as deep as it says.
void expect_inside(const FlightCase& one, const Orbits& orbits, int count = 720) {
  for (const Orbit& orbit : orbits.found) {
    SCOPED_TRACE(name_of(orbit.kind));
    const std::vector<Vec3> points = around(orbit, count);
    for (const PointAnswer& answer : one.ask(points)) EXPECT_TRUE(answer.inside);
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& point : points) least = std::min(least, plain_depth(one.volume.mesh, point));
    EXPECT_GE(least, orbit.margin_m);
    EXPECT_LE(least, orbit.margin_m + 0.01 + orbit.length_m / count);  // samples may miss the nearest place
    EXPECT_GE(orbit.margin_m, orbits.margin_m);
  }
}

// Of a square of 4 m and a range of 100 m, by hand: the farthest point of a circle about the square's middle is as far
// from a corner as its radius and sqrt(8) in plan.
TEST(Orbits, OverAnOpenSquareAreThoseOfTheClosedForms) {
  for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(5e5, 5e6, 500)}) {
    Mission mission = open_square(centre, 100);
    mission.sensor.camera = pinhole_of_fov(150, 150, 4000, 4000);
    const double focal = *mission.sensor.camera->focal_px;
    const FlightCase one(mission);
    for (const OrbitCentre where : {OrbitCentre::over_target, OrbitCentre::around_target}) {
      if (where == OrbitCentre::around_target && centre.x() > 0) continue;  // takes longer, and shows nothing more
      const Orbits orbits = found_in(one, {.least_radius_m = 40, .centre = where, .margin_m = 1, .tolerance_m = 0.4});
      EXPECT_EQ(orbits.reason, "");
      expect_inside(one, orbits, 200);
      auto circles = by_kind(orbits);
      ASSERT_EQ(circles.size(), 3U);
      const Orbit& widest = circles[OrbitKind::widest];
      const double radius = std::sqrt(99 * 99 - 1) - std::sqrt(8);
      EXPECT_GE(widest.radius_m, radius - 0.9);
      EXPECT_LE(widest.radius_m, radius + 0.01);
      EXPECT_GE(widest.bound, widest.radius_m);
      EXPECT_LE(widest.bound, widest.radius_m + 0.41);
      const double height = (100 * 100 - std::pow(40 + std::sqrt(8), 2)) / 200;
      const Orbit& deepest = circles[OrbitKind::deepest];
      EXPECT_GE(deepest.margin_m, height - 0.8);
      EXPECT_LE(deepest.margin_m, height + 0.01);
      EXPECT_EQ(deepest.value, deepest.margin_m);
      EXPECT_GE(deepest.bound, deepest.margin_m);
      EXPECT_LE(deepest.bound, deepest.margin_m + 0.5);
      // d * d / (f h) is the least where h is the distance in plan.
      const double far = 40 + std::sqrt(8);
      const Orbit& finest = circles[OrbitKind::finest_pixel];
      EXPECT_NEAR(finest.value, 2 * far / focal, 0.03 * finest.value);
      EXPECT_LE(finest.bound, finest.value);
      EXPECT_NEAR(finest.radius_m, 40, 2);
      EXPECT_NEAR(*finest.pixel_m, finest.value, 1e-3 * finest.value);
      if (where == OrbitCentre::over_target) {
        EXPECT_NEAR((deepest.centre - centre).head<2>().norm(), 0, 1e-6);
        EXPECT_NEAR(deepest.min_distance_m, deepest.max_distance_m, 1e-6);
      }
    }
  }
}

TEST(Orbits, AreNoWorseThanCirclesDrawnAtRandom) {
  Random random(29);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(round);
    Scene scene = testing::random_city(random, 8, 20);
    scene.objects[0].kind = ObjectKind::ground;
    const FlightCase one(mission_in(scene, testing::random_target(random, 5, 3, Vec3(0, 0, 0), Vec3::UnitZ()), 80));
    const OrbitOptions options{.least_radius_m = 15, .margin_m = 0.5, .tolerance_m = 1, .most_boxes = 10000};
    const Orbits orbits = found_in(one, options);
    expect_inside(one, orbits, 100);
    auto circles = by_kind(orbits);
    ASSERT_EQ(circles.size(), 2U);
    const Orbit &widest = circles[OrbitKind::widest], &deepest = circles[OrbitKind::deepest];
    for (const Orbit& orbit : orbits.found) {
      EXPECT_GE(orbit.radius_m, 15);
      EXPECT_LE(orbit.centre.head<2>().norm(), orbit.radius_m + 1e-6);
      EXPECT_EQ(orbit.straight_m, 0);
    }
    const internal::flight::SolidDepth solid(one.volume.mesh);
    const Box box = bounding_box(one.volume.mesh);
    int counted = 0;
    for (int i = 0; i < 2000; ++i) {
      Orbit circle;
      circle.centre = random.in_box(box);
      circle.radius_m = random.uniform(15, 60);
      if (random.chance(0.5)) {  // near the best ones
        const Orbit& near = random.chance(0.5) ? widest : deepest;
        circle.centre = near.centre + random.point(-4, 4);
        circle.radius_m = std::max(15.0, near.radius_m + random.uniform(-4, 4));
      }
      if (circle.centre.head<2>().norm() > circle.radius_m) continue;
      constexpr int kPoints = 400;
      double least = std::numeric_limits<double>::infinity();
      for (const Vec3& point : around(circle, kPoints)) {
        least = std::min(least, solid.depth_m(point - solid.origin()));
        if (least < 0) break;
      }
      least -= std::numbers::pi * circle.radius_m / kPoints;
      EXPECT_LE(least, deepest.bound + 1e-9);
      if (least < 0.5 + 1) continue;
      ++counted;
      EXPECT_LE(circle.radius_m, widest.bound + 1e-9);
    }
    EXPECT_GT(counted, 5);
  }
}

/// A long block with the target in its middle, in a room of so many metres by 180.
Mission long_block(double width) {
  Mission mission = open_square(Vec3(0, 0, 0), 200);
  mission.navigation.keep_in = {Box{Vec3(-90, -width / 2, 5), Vec3(90, width / 2, 40)}};
  mission.navigation.keep_out = {Box{Vec3(-60, -5, -1), Vec3(60, 5, 100)}};
  return mission;
}

TEST(Orbits, AreRacetracksWhereNoCircleFits) {
  const FlightCase one(long_block(70));
  const OrbitOptions options{.least_radius_m = 15, .margin_m = 1, .tolerance_m = 0.5};
  const Orbits orbits = found_in(one, options);
  EXPECT_NE(orbits.reason, "");
  ASSERT_EQ(orbits.found.size(), 1U);
  const Orbit& track = orbits.found[0];
  EXPECT_GE(track.radius_m, 15);
  EXPECT_GT(track.straight_m, 60);
  EXPECT_NEAR(std::abs(std::remainder(track.heading_deg - 90, 180)), 0, 10);
  EXPECT_NEAR(track.length_m, 2 * std::numbers::pi * track.radius_m + 2 * track.straight_m, 1e-6);
  expect_inside(one, orbits);

  OrbitOptions circles = options;
  circles.racetracks = false;
  EXPECT_TRUE(found_in(one, circles).found.empty());
}

TEST(Orbits, OfNoneSayWhy) {
  const FlightCase narrow(long_block(34));
  const Orbits none = found_in(narrow, {.least_radius_m = 15, .margin_m = 3, .tolerance_m = 0.5, .most_boxes = 3000});
  EXPECT_TRUE(none.found.empty());
  EXPECT_NE(none.reason, "");

  const FlightCase small(open_square(Vec3(0, 0, 0), 50));
  EXPECT_NE(found_in(small, {.least_radius_m = 60}).reason, "");
  const Orbits deep = found_in(small, {.least_radius_m = 20, .margin_m = 30});
  EXPECT_TRUE(deep.found.empty());
  EXPECT_NE(deep.reason, "");

  Mission mission = open_square(Vec3(0, 0, 0), 50);
  mission.navigation.altitude = Navigation::Altitude{100, 200};
  const FlightCase empty(mission);
  EXPECT_EQ(found_in(empty, {}).reason, empty.volume.reason);
}

TEST(Orbits, InALayerThinnerThanTheMarginKeepASmallerOne) {
  Mission mission = open_square(Vec3(0, 0, 0), 80);
  mission.navigation.altitude = Navigation::Altitude{10, 11};
  const FlightCase one(mission);
  const Orbits orbits = found_in(one, {.least_radius_m = 30, .most_boxes = 20000});
  EXPECT_NEAR(orbits.margin_m, 0.125, 0.02);
  EXPECT_EQ(orbits.found.size(), 2U);
  expect_inside(one, orbits);
  EXPECT_TRUE(found_in(one, {.least_radius_m = 30, .margin_m = 1, .racetracks = false}).found.empty());
}

// A wall is seen from its front alone: nothing goes round it.
TEST(Orbits, BeforeAWallLieBesideIt) {
  Mission mission = mission_in(testing::SceneBuilder().box("wall", Vec3(-20, 0.1, 0), Vec3(20, 5, 30)),
                               testing::target_of({{-5, 0, 5}, {5, 0, 5}, {5, 0, 15}, {-5, 0, 15}}), 100);
  const FlightCase one(mission);
  ASSERT_EQ(one.volume.outcome, Outcome::computed);
  OrbitOptions options{.least_radius_m = 20, .margin_m = 1, .racetracks = false, .most_boxes = 10000};
  EXPECT_TRUE(found_in(one, options).found.empty());
  options.centre = OrbitCentre::anywhere;
  const Orbits orbits = found_in(one, options);
  EXPECT_EQ(orbits.found.size(), 2U);
  expect_inside(one, orbits);
}

TEST(Orbits, BecomeFlights) {
  const FlightCase one(open_square(Vec3(5e5, 5e6, 0), 80));
  const Orbits orbits = found_in(one, {.least_radius_m = 30, .centre = OrbitCentre::over_target});
  ASSERT_FALSE(orbits.found.empty());
  for (Orbit orbit : orbits.found) {
    for (const bool clockwise : {true, false}) {
      orbit.clockwise = clockwise;
      const Flight flight = flight_of(orbit, 0.05);
      check_flight_points(flight);
      EXPECT_EQ(flight.points.front().position, flight.points.back().position);
      EXPECT_NEAR(flight.points.front().position.y(), orbit.centre.y() + orbit.radius_m, 1e-6);
      EXPECT_LE(length_m(flight), orbit.length_m);
      EXPECT_NEAR(length_m(flight), orbit.length_m, 0.01 * orbit.length_m);
      double turn = 0;
      std::vector<Vec3> middles;
      for (std::size_t i = 0; i < flight.leg_count(); ++i) {
        const Leg leg = flight.leg(i);
        const Vec3 from = leg.from - orbit.centre, to = leg.to - orbit.centre;
        turn += from.x() * to.y() - from.y() * to.x();
        EXPECT_NEAR(from.norm(), orbit.radius_m, 1e-6);
        middles.push_back((leg.from + leg.to) / 2);
        EXPECT_GE((middles.back() - orbit.centre).norm(), orbit.radius_m - flight.chord_error_m - 1e-6);
      }
      EXPECT_EQ(turn < 0, clockwise);
      for (const PointAnswer& answer : one.ask(middles)) EXPECT_TRUE(answer.inside);
    }
  }
  Orbit track = orbits.found[0];
  track.straight_m = 50;
  track.heading_deg = 30;
  const Flight flight = flight_of(track);
  EXPECT_NEAR(length_m(flight), 2 * std::numbers::pi * track.radius_m + 100, 1);
  EXPECT_LE(flight.chord_error_m, track.margin_m);
  track.radius_m = 0;
  expect_code([&] { flight_of(track); }, ErrorCode::value_out_of_range, "orbit");
  expect_code([&] { flight_of(orbits.found[0], 0); }, ErrorCode::value_out_of_range, "chord_error_m");
}

// The margin of curves in a mesh, against many points of them.
TEST(Orbits, OfCurvesTheDepthIsThatOfTheirPoints) {
  Random random(30);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (int round = 0; round < 10; ++round) {
      const Volume dome = testing::make_dome(Vec3::Zero(), 12, 6, [&](double azimuth, double) {
        return scale * (10 + 4 * std::cos(3 * azimuth + round));
      });
      const internal::flight::SolidDepth solid(dome.mesh);
      const internal::flight::CurveDepth depth(solid);
      const ClosedCurve curve{random.point(-3, 3) * scale, random.uniform(0.5, 5) * scale,
                              random.chance(0.5) ? random.uniform(0, 3) * scale : 0, random.uniform(0, 3)};
      double least = std::numeric_limits<double>::infinity();
      constexpr int kPoints = 2000;
      for (const Vec3& point : curve.points(kPoints)) {
        least = std::min(least, plain_depth(dome.mesh, point + solid.origin()));
      }
      const double error = 1e-3 * scale;
      const double told = depth.depth_m(curve, error, 1e-6 * scale);
      if (least < 0) {
        EXPECT_FALSE(told > 0);
      } else if (least > 2 * error) {
        EXPECT_LE(told, least);
        EXPECT_GE(told, least - curve.length_m() / kPoints - error);
      }
    }
  }
}

TEST(Orbits, OfSegmentsTheDistanceIsTheLeastOfTheirPoints) {
  Random random(31);
  for (int round = 0; round < 3000; ++round) {
    const auto drawn = [&] {  // on a coarse grid: parallel, touching and crossing ones come often
      return Vec3(random.integer(-2, 2), random.integer(-2, 2), random.integer(-1, 1));
    };
    const Vec3 p = drawn(), q = drawn(), a = drawn(), b = drawn(), c = drawn();
    const double told = std::sqrt(internal::flight::squared_segment_distance(p, q, a, b, c));
    double least = std::numeric_limits<double>::infinity();
    constexpr int kPoints = 200;
    for (int i = 0; i <= kPoints; ++i) {
      const Vec3 point = p + (q - p) * i / kPoints;
      least = std::min(least, std::sqrt(internal::core::squared_distance_to_triangle(point, a, b, c)));
    }
    EXPECT_LE(told, least + 1e-12);
    EXPECT_GE(told, least - (q - p).norm() / kPoints - 1e-12);
  }
}

TEST(Orbits, RefuseBadOptions) {
  const FlightCase one(open_square(Vec3(0, 0, 0), 20));
  for (const double bad : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    expect_code([&] { found_in(one, {.least_radius_m = bad}); }, ErrorCode::value_out_of_range, "least_radius_m");
  }
  expect_code([&] { found_in(one, {.least_radius_m = 5, .most_radius_m = 4}); }, ErrorCode::value_out_of_range,
              "most_radius_m");
  expect_code([&] { found_in(one, {.margin_m = -1}); }, ErrorCode::value_out_of_range, "margin_m");
  expect_code([&] { found_in(one, {.tolerance_m = 0}); }, ErrorCode::value_out_of_range, "tolerance_m");
}

}  // namespace
}  // namespace vantage
