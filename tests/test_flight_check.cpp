// What is told of a flight: against what is known by hand, and against points a centimetre apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "flight/flight_timeline.h"
#include "flight/gimbal.h"
#include "support/flight_cases.h"
#include "support/plan_texts.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/query.h"
#include "vantage/standpoints.h"

namespace vantage::testing {
namespace {

constexpr double kHalf = 2;  // of the target's sides

Target checked_square(const Vec3& centre = Vec3::Zero()) {
  return target_of({centre + Vec3(-kHalf, -kHalf, 0), centre + Vec3(kHalf, -kHalf, 0), centre + Vec3(kHalf, kHalf, 0),
                    centre + Vec3(-kHalf, kHalf, 0)});
}

/// The first object is the ground.
Scene with_ground(Scene scene) {
  scene.objects.front().kind = ObjectKind::ground;
  return scene;
}

/// A square on the ground, and a wall north of it, 10 m long and 10 m high.
Mission behind_a_wall(double range_m = 100) {
  SceneBuilder scene;
  scene.ground("ground", 200, -0.5).box("wall", {-5, 6, -0.5}, {5, 7, 10});
  return mission_in(with_ground(scene), checked_square(), range_m);
}

Flight flight_along(const std::vector<Vec3>& positions, double speed_m_s = std::numeric_limits<double>::quiet_NaN()) {
  Flight flight;
  for (const Vec3& position : positions) {
    flight.points.push_back({position, 0, speed_m_s, ""});
  }
  return flight;
}

TEST(FlightCheck, TellsWhatIsSeenAndWhatHidesIt) {
  // Along x, 20 m up, 20 m north of the wall's north side: its top edge at y = 6 to 7, z = 10 is in the way.
  const Mission mission = behind_a_wall();
  const FlightCheck check = check_flight(mission, flight_along({{-60, 27, 20}, {60, 27, 20}}, 5));
  ASSERT_EQ(check.targets.size(), 1U);
  const TargetCheck& target = check.targets[0];
  EXPECT_EQ(check.length_m, 120);
  EXPECT_EQ(check.duration_s, 24);
  // Seen from (x, 27, 20), the corner (2, 2, 0) is behind the wall's top edge at y = 7 where the line to it is at z <
  // 10 there: z = 20 (7 - 2) / 25 = 4. The last line that the wall's end at x = 5 hides ends at the corner (-2, 2): at
  // y = 6, a share 4 / 25 from the corner, x = -2 + (x + 2) 4 / 25 = 5.
  const double last = -2 + 7 * 25 / 4.0;
  ASSERT_EQ(target.seen.size(), 2U);
  EXPECT_NEAR(target.seen[0].end_m, 60 - last, 1e-6);
  EXPECT_NEAR(target.seen[1].begin_m, 60 + last, 1e-6);
  EXPECT_NEAR(target.seen[1].begin_s, (60 + last) / 5, 1e-6);
  EXPECT_NEAR((target.seen[1].begin - Vec3(last, 27, 20)).norm(), 0, 1e-6);
  ASSERT_EQ(target.not_seen.size(), 1U);
  EXPECT_EQ(target.not_seen[0].kind, NotSeen::Kind::hidden);
  EXPECT_EQ(target.not_seen[0].name, "wall");
  EXPECT_NEAR(target.not_seen[0].length_m(), 2 * last, 1e-6);
  EXPECT_TRUE(check.passes());
  EXPECT_EQ(check.nearest.object, "wall");
  EXPECT_NEAR(check.nearest.distance_m, std::hypot(20, 10), 1e-9);
  EXPECT_EQ(target.longest, 0U);
  ASSERT_TRUE(target.gimbal);
  EXPECT_NEAR(target.gimbal->begin_yaw_deg, std::atan2(60, -27) * 180 / std::numbers::pi, 1e-9);
  EXPECT_LT(target.gimbal->max_pitch_deg, 0);
}

TEST(FlightCheck, JoinsWhatIsSeenAcrossPointsAndCountsStays) {
  Flight flight = flight_along({{-30, -20, 20}, {0, -20, 20}, {0, -20, 20}, {30, -20, 20}}, 10);
  flight.points[1].hold_s = 4;
  flight.points[2].hold_s = 3;
  flight.points[3].hold_s = 2;
  const FlightCheck check = check_flight(behind_a_wall(), flight);
  ASSERT_EQ(check.targets[0].seen.size(), 1U);
  const FlightSpan& seen = check.targets[0].seen[0];
  EXPECT_EQ(seen.begin_m, 0);
  EXPECT_EQ(seen.end_m, 60);
  EXPECT_EQ(seen.begin_s, 0);
  EXPECT_DOUBLE_EQ(seen.end_s, 15);
  EXPECT_DOUBLE_EQ(check.duration_s, 15);
  EXPECT_EQ(check.arrival_s, (std::vector<double>{0, 3, 7, 13}));
}

// A way that the vehicle may not fly is judged, and nothing on it counts as seen.
TEST(FlightCheck, SeesNothingFromOtherWays) {
  Flight flight = flight_along({{-30, -20, 20}, {-20, -20, 20}, {-20, 6.5, 12}, {-20, -20, 20}, {-10, -20, 20}}, 10);
  const FlightCheckOptions options{.clearance_m = 20};
  EXPECT_EQ(check_flight(behind_a_wall(), flight).targets[0].seen.size(), 1U);
  const double nearest = check_flight(behind_a_wall(), flight).nearest.distance_m;
  flight.points[2].is_other_way = flight.points[3].is_other_way = true;
  const FlightCheck check = check_flight(behind_a_wall(), flight, options);
  ASSERT_EQ(check.targets[0].seen.size(), 2U);
  EXPECT_EQ(check.targets[0].seen[0].end_m, 10);
  EXPECT_EQ(check.targets[0].seen[1].end_m, 20);
  EXPECT_EQ(check.length_m, 20);
  EXPECT_EQ(check.duration_s, 2);
  EXPECT_EQ(check.nearest.distance_m, nearest);
  EXPECT_EQ(check.nearest.at_m, 10);
  EXPECT_FALSE(check.passes());
}

// Also without a clearance: the vehicle would fly into it.
TEST(FlightCheck, NoFlightMeetsTheScene) {
  const Mission mission = behind_a_wall();
  const auto failures = [&](const std::vector<Vec3>& positions, double tube_m = 0) {
    return check_flight(mission, flight_along(positions, 5), {.tube_radius_m = tube_m}).failures;
  };
  const std::vector<Vec3> through = {{0, -20, 5}, {0, 26, 5}}, beside = {{-20, -4, 12}, {20, -4, 12}};
  expect_wording(plan_texts::joined(failures(through), "\n"));
  EXPECT_EQ(failures(beside), std::vector<std::string>());
  EXPECT_EQ(failures(beside, 9), std::vector<std::string>());
  EXPECT_EQ(failures(beside, 11).size(), 1U);
}

/// A copy whose object 1 has no floor: no triangle at its lowest z.
Scene without_floor(Scene scene) {
  double lowest = std::numeric_limits<double>::infinity();
  const auto highest_of = [&](std::size_t t) {
    double z = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t vertex : scene.mesh.triangles[t]) z = std::max(z, scene.mesh.vertices[vertex].z());
    return z;
  };
  for (std::size_t t = 0; t < scene.object_of.size(); ++t) {
    if (scene.object_of[t] == 1) lowest = std::min(lowest, highest_of(t));
  }
  for (std::size_t t = scene.object_of.size(); t-- > 0;) {
    if (scene.object_of[t] != 1 || highest_of(t) > lowest) continue;
    scene.mesh.triangles.erase(scene.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    scene.object_of.erase(scene.object_of.begin() + static_cast<std::ptrdiff_t>(t));
  }
  return scene;
}

// From end to end, far from its faces or beside them, from the ground up or from below it.
TEST(FlightCheck, NoFlightIsInsideASolid) {
  SceneBuilder block, sunk, welded, hollow;
  block.ground("ground", 200, 0).box("block", {-30, -30, 0}, {30, 30, 60});
  sunk.ground("ground", 200, 0).box("block", {-30, -30, -1}, {30, 30, 60});
  Mesh around = make_box_mesh({-200, -200, 0}, {200, 200, 1});  // the ground ends at the block
  around.vertices = {{-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0},
                     {-30, -30, 0},   {30, -30, 0},   {30, 30, 0},   {-30, 30, 0}};
  around.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  welded.add("ground", around).box("block", {-30, -30, 0}, {30, 30, 60});
  const std::vector<std::vector<Vec3>> flights = {
      {{-9, 0, 30}, {9, 0, 30}}, {{9, 0, 0.5}, {9, 0, 30}}, {{29.9995, 0, 30}, {0, 0, 30}}, {{9, 0, -0.9}, {9, 0, 30}}};
  for (const SceneBuilder* builder : {&block, &sunk, &welded}) {
    for (const bool has_floor : {true, false}) {
      const Scene scene = with_ground(builder->scene());
      const Mission inside = mission_in(has_floor ? scene : without_floor(scene), checked_square({0, 0, 20}), 100);
      for (const std::vector<Vec3>& flight : flights) {
        const FlightCheck check = check_flight(inside, flight_along(flight), {.clearance_m = 0});
        EXPECT_EQ(check.failures.size(), 1U) << has_floor << flight[0].transpose();
        EXPECT_EQ(check.nearest.distance_m, 0);
        EXPECT_EQ(check.nearest.object, "block");
      }
    }
  }
  Scene bare;
  bare.mesh = make_box_mesh({-30, -30, 0}, {30, 30, 60});
  const FlightCheck in_bare =
      check_flight(mission_in(bare, checked_square({0, 0, 20}), 100), flight_along({{-9, 0, 30}, {9, 0, 30}}));
  EXPECT_EQ(in_bare.failures.size(), 1U);
  EXPECT_EQ(in_bare.nearest.object, "scene");
  // A hall with walls of 2 m is free inside, and so is a pit whose faces are turned downward.
  Mesh hall = make_box_mesh({-50, -50, 0}, {50, 50, 60}), room = make_box_mesh({-48, -48, 1}, {48, 48, 58});
  for (Triangle& triangle : room.triangles) std::swap(triangle[1], triangle[2]);
  append(hall, room);
  hollow.add("hall", hall);
  Mesh pit = make_box_mesh({-40, -40, -60}, {40, 40, 60});
  std::erase_if(pit.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t vertex) { return pit.vertices[vertex].z() > 0; });
  });
  SceneBuilder open;
  open.add("pit", pit);
  for (const SceneBuilder* builder : {&hollow, &open}) {
    const Mission free = mission_in(builder->scene(), checked_square({0, 0, 20}), 100);
    EXPECT_EQ(check_flight(free, flight_along(flights[0])).failures, std::vector<std::string>());
  }
}

TEST(FlightCheck, NoFlightIsBelowTheGround) {
  Mission mission = behind_a_wall();  // the ground is at -0.5
  const auto failures = [&](const std::vector<Vec3>& positions) {
    return check_flight(mission, flight_along(positions, 5)).failures;
  };
  const std::vector<Vec3> under = {{-20, 0, 20}, {-10, 0, -9.5}, {10, 0, -9.5}, {20, 0, 20}};
  const std::vector<Vec3> level = {{-20, -5, -0.6}, {20, -5, -0.6}};
  const std::vector<Vec3> flown = {
      {0, -20, -0.9}, {0, -20, 9}, {0, -10, 9}, {0, -10, -0.5}};  // the ground is not exact
  expect_wording(plan_texts::joined(failures(under), "\n") + "\n" + plan_texts::joined(failures(level), "\n"));
  EXPECT_EQ(failures(flown), std::vector<std::string>());
  // For kilometres, or down to a valley: where it takes off and lands it is near the ground's level alone.
  for (const std::vector<Vec3>& flat :
       {std::vector<Vec3>{{-150, 0, -1.4}, {150, 0, 0}}, {{0, -20, 5}, {0, -20, -0.3}, {0, 150, -1.4}}}) {
    const FlightCheck check = check_flight(mission, flight_along(flat, 5));
    ASSERT_EQ(check.broken.size(), 1U);
    EXPECT_EQ(check.broken[0].name, "ground");
    EXPECT_LE(check.broken[0].worst, 0.9 + 1e-9);
  }
  mission.navigation.above_ground = AboveGround{-100, 400, *ground_of(mission.scene())};
  EXPECT_EQ(failures(under).size(), 1U);
  // Heights are above another ground: that of the scene counts all the same.
  mission.as_written.ground = GroundSource{-50.0, ""};
  mission.navigation.above_ground->ground = Ground{-50};
  EXPECT_EQ(failures(under).size(), 1U);
}

// A ridge that is thinner than any step is met where 1 m would be borne, too.
TEST(FlightCheck, NoRidgeIsPassedWhereAFlightTakesOff) {
  for (const double half_width : {1e-3, 0.1, 1.0}) {
    Mesh ridge;
    for (const auto& [x, z] :
         {std::pair(-200.0, 0.0), {-10 - half_width, 0}, {-10, 20}, {-10 + half_width, 0}, {200, 0}}) {
      ridge.vertices.insert(ridge.vertices.end(), {{x, -200, z}, {x, 200, z}});
    }
    for (std::uint32_t i = 0; i < 8; i += 2) {
      ridge.triangles.insert(ridge.triangles.end(), {{i, i + 2, i + 3}, {i, i + 3, i + 1}});
    }
    const Mission mission =
        mission_in(with_ground(SceneBuilder().add("ground", ridge)), checked_square({0, 0, 30}), 99);
    const FlightCheck check = check_flight(mission, flight_along({{-20, 0, -0.5}, {20, 0, 0.6}, {0, 0, 60}}));
    ASSERT_EQ(check.broken.size(), 1U) << half_width;
    EXPECT_EQ(check.broken[0].name, "ground");
  }
}

// What all heights are above may be touched where a flight begins: all of the scene, or a raster.
TEST(FlightCheck, MayTakeOffFromWhatIsTheGround) {
  SceneBuilder terrain;
  terrain.ground("terrain", 200, 0);
  const std::vector<Vec3> flown = {{50, 0, -0.5}, {50, 0, 30}, {20, 0, 30}}, below = {{50, 0, -9}, {20, 0, -9}};
  for (const bool is_raster : {true, false}) {
    Scene scene = terrain;
    if (is_raster) scene.objects[0].kind = ObjectKind::surface;
    Mission mission = mission_in(scene, checked_square({0, 0, 5}), 100);
    EXPECT_EQ(check_flight(mission, flight_along(flown)).passes(), is_raster);
    if (!is_raster) mission.as_written.ground = GroundSource{std::nullopt, "all"};
    EXPECT_EQ(check_flight(mission, flight_along(flown)).failures, std::vector<std::string>());
    EXPECT_FALSE(check_flight(mission, flight_along(flown), {.clearance_m = 1}).passes());
    EXPECT_FALSE(check_flight(mission, flight_along(below)).passes());
  }
}

TEST(FlightCheck, OfOnePointIsAStay) {
  Flight flight = flight_along({{0, -20, 20}});
  flight.points[0].hold_s = 7;
  const FlightCheck check = check_flight(behind_a_wall(), flight, {.dwell_s = 7});
  EXPECT_TRUE(check.passes()) << check.failures.front();
  EXPECT_EQ(check.targets[0].seen.at(0).duration_s(), 7);
  EXPECT_FALSE(check_flight(behind_a_wall(), flight, {.dwell_s = 7.5}).passes());
}

TEST(FlightCheck, SaysWhatIsAskedForAndDoesNotHold) {
  Mission mission = behind_a_wall();
  mission.navigation.altitude = {{.min_m = 15, .max_m = 50}};
  const Flight flight = flight_along({{-30, -20, 20}, {0, 30, 12}, {30, -20, 20}}, 10);
  const FlightCheck check = check_flight(mission, flight, {.dwell_s = 6, .clearance_m = 30, .gimbal_rate_deg_s = 1});
  ASSERT_EQ(check.broken.size(), 1U);
  EXPECT_EQ(check.broken[0].name, "altitude min");
  EXPECT_NEAR(check.broken[0].worst, 3, 1e-9);
  EXPECT_NEAR((check.broken[0].worst_at - Vec3(0, 30, 12)).norm(), 0, 1e-6);
  EXPECT_EQ(check.broken[0].spans.size(), 1U);
  ASSERT_EQ(check.failures.size(), 3U);
  EXPECT_NE(check.failures[0].find("6 s are"), std::string::npos) << check.failures[0];
  EXPECT_NE(check.failures[1].find("altitude min is broken by 3 m"), std::string::npos) << check.failures[1];
  EXPECT_NE(check.failures[2].find("wall is"), std::string::npos) << check.failures[2];
  const FlightCheck nowhere = check_flight(mission, flight_along({{0, 30, -0.2}, {0, 40, -0.2}}, 1));
  ASSERT_FALSE(nowhere.failures.empty());
  EXPECT_EQ(nowhere.failures[0], "target is nowhere seen whole");
}

TEST(FlightCheck, TakesWhatTheTourAsks) {
  Mission mission = behind_a_wall();
  TourSettings tour;
  tour.vehicle.speed_m_s = 4;
  tour.dwell_s = 100;
  tour.clearance_m = 3;
  tour.gimbal_rate_deg_s = 90;
  mission.as_written.tour = tour;
  const Flight flight = flight_along({{-30, -20, 20}, {30, -20, 20}});
  const FlightCheck check = check_flight(mission, flight);
  EXPECT_EQ(check.duration_s, 15);
  ASSERT_EQ(check.failures.size(), 1U);
  EXPECT_TRUE(check_flight(mission, flight, {.dwell_s = 15}).passes());
  EXPECT_FALSE(check_flight(mission, flight, {.dwell_s = 15, .clearance_m = 500}).passes());
}

TEST(FlightCheck, WithoutASpeedTellsLengthsAlone) {
  const Flight flight = flight_along({{-30, -20, 20}, {30, -20, 20}});
  const FlightCheck check = check_flight(behind_a_wall(), flight);
  EXPECT_TRUE(std::isnan(check.duration_s));
  EXPECT_TRUE(check.targets[0].longest);
  EXPECT_TRUE(std::isnan(check.targets[0].gimbal->rate_deg_s));
  EXPECT_THROW(check_flight(behind_a_wall(), flight, {.dwell_s = 1}), Error);
  EXPECT_TRUE(check_flight(behind_a_wall(), flight, {.speed_m_s = 5, .dwell_s = 12}).passes());
}

TEST(FlightCheck, RefusesOptionsThatMeanNothing) {
  const Mission mission = behind_a_wall();
  const Flight flight = flight_along({{-30, -20, 20}, {30, -20, 20}}, 5);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const FlightCheckOptions& options : {FlightCheckOptions{.tube_radius_m = -1},
                                            {.tube_radius_m = kNaN},
                                            {.speed_m_s = 0.0},
                                            {.dwell_s = -1.0},
                                            {.clearance_m = kNaN},
                                            {.gimbal_rate_deg_s = 0.0}}) {
    EXPECT_THROW(check_flight(mission, flight, options), Error);
  }
  EXPECT_THROW(check_flight(mission, Flight{}), Error);
}

TEST(FlightCheck, OfSeveralTargetsTellsEachByItself) {
  Mission mission = behind_a_wall();
  const Target far = [] {
    Target target = checked_square({300, 0, 0});
    target.name = "far";
    return target;
  }();
  mission.as_written.combine = Combine::each;
  mission.views = {{mission.target}, {far}};
  const FlightCheck check = check_flight(mission, flight_along({{-30, -20, 20}, {300, -20, 20}}, 5));
  ASSERT_EQ(check.targets.size(), 2U);
  EXPECT_EQ(check.targets[1].name, "far");
  EXPECT_LT(check.targets[0].seen.at(0).end_m, check.targets[1].seen.at(0).begin_m);
  EXPECT_TRUE(check.passes());
}

/// Whether the flight's spans hold a place along it, and how near it is to one of their ends.
std::pair<bool, double> where_in(const std::vector<FlightSpan>& spans, double at_m) {
  bool is_in = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (const FlightSpan& span : spans) {
    is_in = is_in || (span.begin_m <= at_m && at_m <= span.end_m);
    nearest = std::min({nearest, std::abs(span.begin_m - at_m), std::abs(span.end_m - at_m)});
  }
  return {is_in, nearest};
}

/// Boxes round a square, with a camera's limits.
Mission drawn_mission(Random& random) {
  SceneBuilder scene;
  scene.ground("ground", 300, -0.5);
  for (int i = 0; i < 12; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), radius = random.uniform(12, 40);
    const Vec3 middle(radius * std::cos(angle), radius * std::sin(angle), -0.5);
    const Vec3 half(random.uniform(0.5, 5), random.uniform(0.5, 5), 0);
    scene.box("box " + std::to_string(i), middle - half, middle + half + Vec3(0, 0, random.uniform(2, 20)));
  }
  Mission mission = mission_in(with_ground(scene), checked_square(), random.uniform(30, 70));
  if (random.chance(0.5)) mission.sensor.incidence_deg = random.uniform(30, 80);
  if (random.chance(0.5)) mission.sensor.min_range_m = random.uniform(5, 25);
  if (random.chance(0.5)) mission.sensor.sun = SunLimit{random.direction(), random.uniform(5, 40)};
  return mission;
}

Flight drawn_flight(Random& random) {
  std::vector<Vec3> positions;
  const int count = random.integer(2, 6);
  for (int i = 0; i < count; ++i) {
    positions.emplace_back(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(1, 50));
  }
  return flight_along(positions, 7);
}

TEST(FlightCheck, AgreesWithPointsACentimetreApart) {
  Random random(20261126);
  std::size_t samples = 0, seen = 0;
  for (int trial = 0; trial < 25; ++trial) {
    const Mission mission = drawn_mission(random);
    const Flight flight = drawn_flight(random);
    const FlightCheck check = check_flight(mission, flight);
    constexpr double kStep = 0.01;
    const internal::flight::FlightTimeline along(flight, 7);
    std::vector<Vec3> points;
    std::vector<double> places;
    for (std::size_t leg = 0; leg < flight.leg_count(); ++leg) {
      const double length = (flight.leg(leg).to - flight.leg(leg).from).norm();
      for (double at = random.uniform(0, kStep); at < length; at += kStep * random.uniform(5, 15)) {
        points.push_back(along.position(leg, at / length));
        places.push_back(along.at_m(leg, at / length));
      }
    }
    const PreparedScene scene(mission.scene());
    PointQuery query(PreparedTarget(scene, mission.target, mission.sensor));
    const std::vector<PointAnswer> answers = query.answer(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [is_in, to_end] = where_in(check.targets[0].seen, places[i]);
      if (to_end < kStep) continue;
      ++samples;
      seen += is_in ? 1 : 0;
      ASSERT_EQ(is_in, answers[i].inside) << "trial " << trial << ", " << places[i] << " m along";
    }
  }
  EXPECT_GT(samples, 20'000U);
  EXPECT_GT(seen, 1000U);
}

TEST(FlightCheck, WithATubeHoldsForAllOfIt) {
  Random random(4711);
  std::size_t checked = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Mission mission = drawn_mission(random);
    const Flight flight = drawn_flight(random);
    const double radius = random.uniform(0.1, 3);
    const FlightCheck check = check_flight(mission, flight, {.tube_radius_m = radius});
    std::vector<Vec3> points;
    for (const FlightSpan& span : check.targets[0].seen) {
      for (int i = 0; i < 200; ++i) {
        const double at = random.uniform(span.begin_m, span.end_m);
        std::size_t leg = 0;
        while (check.point_at_m[leg + 1] < at) ++leg;
        const double length = check.point_at_m[leg + 1] - check.point_at_m[leg];
        const Leg on = flight.leg(leg);
        const Vec3 place = on.from + (at - check.point_at_m[leg]) / length * (on.to - on.from);
        points.push_back(place + 0.999 * radius * random.uniform(0, 1) * random.direction());
      }
    }
    const PreparedScene scene(mission.scene());
    PointQuery query(PreparedTarget(scene, mission.target, mission.sensor));
    for (const PointAnswer& answer : query.answer(points)) {
      ASSERT_TRUE(answer.inside) << "trial " << trial;
      ++checked;
    }
  }
  EXPECT_GT(checked, 500U);
}

/// 25 m north of a flight along x, within a volume that asks for no range: what nothing holds counts from 20 m farther.
Mission beside_what_is_not_built() {
  Scene scene = with_ground(SceneBuilder().ground("ground", 200, -0.5));
  scene.ledger.push_back({{"mast"}, "", "nothing tells how wide it is", Box{{-1, 25, 0}, {1, 27, 30}}});
  auto room = std::make_shared<TargetVolume>();
  room->mesh = make_box_mesh({-50, -40, 1}, {50, 40, 60});
  Target target;
  target.parts.clear();
  target.volume = room;
  return mission_in(scene, target, std::numeric_limits<double>::infinity());
}

TEST(FlightCheck, WithoutARangeWhatIsNotBuiltCountsWithinTheClearance) {
  const Mission mission = beside_what_is_not_built();
  Flight flight = flight_along({{-30, 0, 20}, {30, 0, 20}});
  const auto notes = [&](const FlightCheckOptions& options) { return check_flight(mission, flight, options).notes; };
  EXPECT_TRUE(notes({.clearance_m = 4}).empty());
  ASSERT_EQ(notes({.clearance_m = 6}).size(), 1U);
  expect_wording(notes({.clearance_m = 6})[0]);
  EXPECT_EQ(notes({.tube_radius_m = 2, .clearance_m = 4}).size(), 1U);
  flight.chord_error_m = 2;
  EXPECT_EQ(notes({.clearance_m = 4}).size(), 1U);
  Mission limited = mission;
  limited.navigation.clearance = Clearance{6, obstacles_of(mission.scene())};
  EXPECT_EQ(check_flight(limited, flight_along({{-30, 0, 20}, {30, 0, 20}})).notes.size(), 1U);
}

TEST(FlightCheck, ClearanceIsKeptFromLinesOverhead) {
  Scene scene = with_ground(SceneBuilder().ground("ground", 200, -0.5).box("wall", {-5, 60, -0.5}, {5, 61, 10}));
  scene.overhead = {{{"volt", "way/12"}, make_box_mesh({20, -50, -0.5}, {20, 50, 45})}};
  const Mission mission = mission_in(scene, checked_square(), 100);
  const FlightCheck check = check_flight(mission, flight_along({{-30, 0, 20}, {18, 0, 20}}), {.clearance_m = 3});
  EXPECT_EQ(check.nearest.object, "way/12 volt");
  EXPECT_NEAR(check.nearest.distance_m, 2, 1e-6);
  ASSERT_EQ(check.failures.size(), 1U);
  expect_wording(check.failures[0]);
  const ViewDescription view = ViewDescriber(mission).describe({17, 0, 20});
  EXPECT_EQ(view.obstacle, "way/12 volt");
  EXPECT_NEAR(view.obstacle_distance_m.value_or(0), 3, 1e-9);
}

TEST(FlightCheck, HasTheNotesOfTheMission) {
  Mission mission = behind_a_wall();
  mission.notes.push_back({WarningCode::zones_left_out, "a zone was left out"});
  const FlightCheck check = check_flight(mission, flight_along({{-60, 27, 20}, {60, 27, 20}}, 5));
  EXPECT_EQ(check.notes, std::vector<std::string>{mission.notes[0].text});
  EXPECT_EQ(nlohmann::json::parse(json_text(check))["notes"].get<std::vector<std::string>>(), check.notes);
}

TEST(FlightCheckText, IsJsonThatSaysWhatIsNotKnown) {
  const FlightCheck check = check_flight(behind_a_wall(), flight_along({{-60, 27, 20}, {60, 27, 20}}));
  const auto json = nlohmann::json::parse(json_text(check));
  EXPECT_TRUE(json["duration_s"].is_null());
  EXPECT_EQ(json["length_m"], 120);
  EXPECT_EQ(json["targets"][0]["seen"].size(), 2U);
  EXPECT_EQ(json["targets"][0]["parts"][0][1]["x_m"], kHalf);
  EXPECT_EQ(json["points"][1]["position"]["x_m"], 60);
  EXPECT_TRUE(json["points"][1]["departure_s"].is_null());
  EXPECT_EQ(json["targets"][0]["not_seen"][0]["name"], "wall");
  EXPECT_EQ(json["nearest"]["object"], "wall");
  EXPECT_FALSE(json["nearest"]["position"].contains("lon_deg"));
  Georeference place;
  place.latitude_deg = 48;
  place.longitude_deg = 11;
  const auto placed = nlohmann::json::parse(json_text(check, &place));
  EXPECT_NEAR(placed["nearest"]["position"]["lat_deg"].get<double>(), 48 + 27 / 111'200.0, 1e-5);
}

TEST(FlightCheckText, IsATableWithARowForEachStretch) {
  Mission mission = behind_a_wall();
  mission.target.name = "a \"square\", small";
  const std::string table = csv_text(check_flight(mission, flight_along({{-60, 27, 20}, {60, 27, 20}}, 5)));
  std::istringstream lines(table);
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[1].rfind("\"a \"\"square\"\", small\",seen,,0,", 0), 0U) << rows[1];
  EXPECT_NE(rows[3].find(",hidden,wall,"), std::string::npos) << rows[3];
}

TEST(FlightGimbal, FindsTheSteepestPitchAndTheFastestTurn) {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    const Leg leg{random.point(-10, 10), random.point(-10, 10)};
    const Vec3 to = random.point(-10, 10);
    const auto range = internal::flight::pitch_range(leg, to);
    const double fastest = internal::flight::fastest_turn_deg_s(leg, to, 3);
    double low = 90, high = -90, turn = 0;
    constexpr int kSteps = 2000;
    const double length = (leg.to - leg.from).norm();
    for (int i = 0; i <= kSteps; ++i) {
      const Vec3 at = leg.from + i / static_cast<double>(kSteps) * (leg.to - leg.from);
      const double pitch = internal::flight::aim_at(at, to).pitch_deg;
      low = std::min(low, pitch);
      high = std::max(high, pitch);
      const Vec3 d = (to - at).normalized(), moved = (to - at - 1e-6 * (leg.to - leg.from)).normalized();
      turn = std::max(turn, (moved - d).norm() * 180 / std::numbers::pi / (1e-6 * length / 3));
    }
    EXPECT_GE(low, range.min_deg - 1e-9);
    EXPECT_LE(high, range.max_deg + 1e-9);
    EXPECT_NEAR(low, range.min_deg, 0.5);
    EXPECT_NEAR(high, range.max_deg, 0.5);
    EXPECT_NEAR(turn, fastest, 0.02 * fastest + 0.01);
  }
}

TEST(FlightGimbal, KnowsWhereItNeedNotTurnFast) {
  Random random(10);
  int fast = 0, slow = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double size = std::pow(10.0, random.integer(-3, 4));
    const Leg leg{size * random.point(-10, 10), size * random.point(-10, 10)};
    const Vec3 to = size * random.point(-10, 10);
    const double rate = random.uniform(1, 60), speed = size * random.uniform(0.5, 10);
    const std::vector<LegInterval> found = internal::flight::slow_turns(leg, to, speed, rate);
    for (int i = 0; i < 200; ++i) {
      const double share = random.uniform(0, 1);
      const Vec3 at = leg.from + share * (leg.to - leg.from);
      const double turn = internal::flight::fastest_turn_deg_s({at, at + 1e-9 * (leg.to - at)}, to, speed);
      if (std::abs(turn - rate) < 1e-5 * rate) continue;
      const bool is_slow = std::any_of(found.begin(), found.end(), [&](const LegInterval& interval) {
        return share >= interval.begin && share <= interval.end;
      });
      EXPECT_EQ(is_slow, turn < rate) << "trial " << trial << ", " << turn << " of " << rate;
      (is_slow ? slow : fast) += 1;
    }
  }
  EXPECT_GT(fast, 5000);
  EXPECT_GT(slow, 5000);
  // Straight through the point the turn is a jump.
  EXPECT_EQ(internal::flight::slow_turns({{-1, 0, 0}, {1, 0, 0}}, {0, 0, 0}, 1, 1).size(), 2U);
}

/// Whoever flies beside the leg, or not quite along it, turns no faster where it is said to be slow; and hardly more is
/// left out than must be.
TEST(FlightGimbal, KnowsWhereItNeedNotTurnFastBesideALeg) {
  Random random(11);
  int slow = 0, fast = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Leg leg{random.point(-10, 10), random.point(-10, 10)};
    const Vec3 to = random.point(-10, 10);
    const double rate = random.uniform(5, 90), speed = random.uniform(0.5, 5);
    const internal::flight::Deviation off = {random.uniform(0, 1), random.chance(0.5) ? 0 : random.uniform(0, 0.3)};
    const std::vector<LegInterval> found = internal::flight::slow_turns(leg, to, speed, rate, off);
    for (int i = 0; i < 200; ++i) {
      const double share = random.uniform(0, 1);
      const Vec3 at = leg.from + share * (leg.to - leg.from), along = (leg.to - leg.from).normalized();
      const bool is_slow = std::any_of(found.begin(), found.end(), [&](const LegInterval& interval) {
        return share >= interval.begin && share <= interval.end;
      });
      if (!is_slow) {
        const double most =
            internal::flight::fastest_turn_deg_s({at - 1e-9 * along, at + 1e-9 * along}, to, speed, off);
        EXPECT_GE(most, rate * (1 - 1e-6)) << "trial " << trial;
        ++fast;
        continue;
      }
      ++slow;
      const Vec3 beside = at + off.reach_m * random.uniform(0, 1) * random.direction();
      const Vec3 turned = (along + off.aside * random.direction()).normalized();
      if ((turned - along).norm() > off.aside) continue;
      EXPECT_LE(internal::flight::fastest_turn_deg_s({beside, beside + 1e-7 * turned}, to, speed), rate * (1 + 1e-5))
          << "trial " << trial;
    }
  }
  EXPECT_GT(slow, 5000);
  EXPECT_GT(fast, 5000);
}

/// A curve turns from its chord: in the middle of the chord it is in another place, at the ends in another direction.
TEST(FlightGimbal, ACurveIsOffItsChord) {
  Random random(12);
  for (int trial = 0; trial < 300; ++trial) {
    const double radius = random.uniform(5, 50), half = random.uniform(0.01, 0.5), speed = 10;
    const auto at = [&](double angle) { return Vec3(radius * std::sin(angle), radius * std::cos(angle), 0); };
    const Leg chord{at(-half), at(half)};
    const double error = radius * (1 - std::cos(half)) * (1 + 1e-9);
    const Vec3 to = 2 * radius * random.direction();
    const double most =
        internal::flight::fastest_turn_deg_s(chord, to, speed, internal::flight::off_chord(chord, error, error));
    const auto pitch = internal::flight::pitch_range(chord, to, error);
    for (int i = 0; i <= 20; ++i) {
      const double angle = half * (i / 10.0 - 1);
      const Vec3 ahead = {std::cos(angle), -std::sin(angle), 0};
      EXPECT_LE(internal::flight::fastest_turn_deg_s({at(angle), at(angle) + 1e-7 * ahead}, to, speed),
                most * (1 + 1e-5));
      const double here = internal::flight::aim_at(at(angle), to).pitch_deg;
      EXPECT_GE(here, pitch.min_deg - 1e-6);
      EXPECT_LE(here, pitch.max_deg + 1e-6);
    }
  }
}

/// What passes by fast may be followed while it hovers, or far away.
TEST(FlightCheck, TheCameraNeedsToFollowForTheDwellAlone) {
  const Mission mission = behind_a_wall();
  Flight flight = flight_along({{-30, -20, 20}, {0, -5, 10}, {30, -20, 20}}, 10);
  const FlightCheck passing = check_flight(mission, flight, {.dwell_s = 3, .gimbal_rate_deg_s = 10});
  ASSERT_EQ(passing.failures.size(), 1U);
  EXPECT_NE(passing.failures[0].find("most 10 deg"), std::string::npos) << passing.failures[0];
  flight.points[1].hold_s = 3;
  const FlightCheck hovering = check_flight(mission, flight, {.dwell_s = 3, .gimbal_rate_deg_s = 10});
  EXPECT_TRUE(hovering.passes()) << hovering.failures.front();
  ASSERT_TRUE(hovering.targets[0].followed);
  EXPECT_GE(hovering.targets[0].followed->duration_s(), 3);
  EXPECT_GT(hovering.targets[0].gimbal->rate_deg_s, 10);
  EXPECT_FALSE(check_flight(mission, flight, {.dwell_s = 6, .gimbal_rate_deg_s = 10}).passes());
  EXPECT_THROW(check_flight(mission, flight_along({{-30, -20, 20}, {30, -20, 20}}), {.gimbal_rate_deg_s = 10}), Error);
}

TEST(FlightCheck, WithoutASpeedTellsThePitchOfAllLegs) {
  const Flight flight = flight_along({{-30, -20, 20}, {-10, -20, 20}, {0, -6, 20}});
  const FlightCheck check = check_flight(behind_a_wall(), flight);
  ASSERT_EQ(check.targets[0].seen.size(), 1U);
  ASSERT_TRUE(check.targets[0].gimbal);
  const double steepest = internal::flight::aim_at({0, -6, 20}, check.targets[0].centre).pitch_deg;
  EXPECT_NEAR(check.targets[0].gimbal->min_pitch_deg, steepest, 1e-9);
  EXPECT_TRUE(std::isnan(check.targets[0].gimbal->rate_deg_s));
}

TEST(FlightAlong, TakesWhatIsInBoth) {
  using internal::flight::in_both;
  using Intervals = std::vector<LegInterval>;
  EXPECT_EQ(in_both(Intervals{{0, 1}}, Intervals{{0, 0}, {0.2, 0.4}, {1, 1}}), (Intervals{{0, 0}, {0.2, 0.4}, {1, 1}}));
  EXPECT_EQ(in_both(Intervals{{0, 0.3}, {0.6, 1}}, Intervals{{0.2, 0.7}}), (Intervals{{0.2, 0.3}, {0.6, 0.7}}));
  EXPECT_EQ(in_both(Intervals{{0, 0.3}}, Intervals{{0.4, 0.7}}), Intervals{});
}

TEST(FlightAlong, TakesIntervalsFromIntervals) {
  using internal::flight::without;
  using Intervals = std::vector<LegInterval>;
  EXPECT_EQ(without(Intervals{{0, 1}}, Intervals{{0.2, 0.3}, {0.5, 0.5}}), (Intervals{{0, 0.2}, {0.3, 0.5}, {0.5, 1}}));
  EXPECT_EQ(without(Intervals{{0, 0.4}, {0.6, 1}}, Intervals{{0.3, 0.7}}), (Intervals{{0, 0.3}, {0.7, 1}}));
  EXPECT_EQ(without(Intervals{{0.2, 0.4}}, Intervals{{0, 1}}), Intervals{});
  EXPECT_EQ(without(Intervals{{0.2, 0.4}}, Intervals{{0.4, 1}}), (Intervals{{0.2, 0.4}}));
  EXPECT_EQ(internal::flight::united({{0.5, 0.7}, {0, 0.2}, {0.2, 0.5}}), (Intervals{{0, 0.7}}));
}

}  // namespace
}  // namespace vantage::testing
