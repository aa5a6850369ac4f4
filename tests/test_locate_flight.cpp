// Plans of ground stations: where they lie in a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "geo/local_frame.h"
#include "support/grounds.h"
#include "support/internals.h"
#include "support/plan_texts.h"
#include "support/random.h"
#include "support/wording.h"
#include "vantage/flight.h"

namespace vantage::testing {
namespace {

using namespace plan_texts;

Georeference munich(const std::string& vertical = "EGM96 geoid") {
  Georeference place;
  place.latitude_deg = 48;
  place.longitude_deg = 11;
  place.vertical = vertical;
  return place;
}

LocateOptions in_munich() {
  LocateOptions options;
  options.georeference = munich();
  return options;
}

/// The distance of the vertical or slanted segment's line to a point.
double distance_to_leg(const Leg& leg, const Vec3& p) {
  const Vec3 along = leg.to - leg.from;
  const double share =
      along.squaredNorm() > 0 ? std::clamp((p - leg.from).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
  return (leg.from + share * along - p).norm();
}

TEST(LocateFlight, TurnsEachHeightIntoZ) {
  const auto z = [](HeightDatum datum, const LocateOptions& options) {
    FlightPlan one;
    one.file = "a.plan";
    one.home = PlanPosition{{11, 48}, 500, HeightDatum::sea_level};
    one.items.resize(1);
    one.items[0].position = {{11.001, 48.001}, 100, datum};
    one.items[0].place = "a.plan: item 1";
    return locate_flight(one, options).flight.points.at(0).position.z();
  };
  const Ground ground{30, nullptr};
  LocateOptions options = in_munich();
  EXPECT_EQ(z(HeightDatum::scene_z, options), 100);
  EXPECT_EQ(z(HeightDatum::sea_level, options), 100);
  EXPECT_EQ(z(HeightDatum::home, options), 600);
  options.levels.undulation_m = 45;
  EXPECT_EQ(z(HeightDatum::ellipsoid, options), 55);
  options.ground = &ground;
  EXPECT_EQ(z(HeightDatum::ground, options), 130);
  EXPECT_EQ(z(HeightDatum::home, options), 130);  // on the ground of the scene
  options.home_z_m = 7;
  EXPECT_EQ(z(HeightDatum::home, options), 107);
  options.levels.sea_level_z_m = -500;
  EXPECT_EQ(z(HeightDatum::sea_level, options), -400);
  EXPECT_EQ(z(HeightDatum::ellipsoid, options), -445);
  options = in_munich();
  options.georeference->vertical = "ellipsoidal height";
  EXPECT_EQ(z(HeightDatum::ellipsoid, options), 100);
  expect_error([&] { z(HeightDatum::sea_level, options); }, ErrorCode::height_unknown, "a.plan: item 1");
  options.levels.undulation_m = 45;
  EXPECT_EQ(z(HeightDatum::sea_level, options), 145);
  options.unknown_heights = HeightDatum::sea_level;
  EXPECT_EQ(z(HeightDatum::unknown, options), 145);
}

TEST(LocateFlight, SaysWhichLevelIsNotKnown) {
  FlightPlan one;
  one.file = "a.csv";
  one.items.resize(1);
  PlanItem& item = one.items[0];
  item.place = "a.csv: line 2";
  item.position = {{11.001, 48.001}, 100, HeightDatum::unknown};
  LocateOptions options = in_munich();
  const auto locate = [&] { locate_flight(one, options); };
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  item.position.datum = HeightDatum::ellipsoid;
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  item.position.datum = HeightDatum::ground;
  expect_error(locate, ErrorCode::ground_missing, "a.csv: line 2");
  item.position.datum = HeightDatum::home;
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  options.home = Eigen::Vector2d(11, 48);
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  options.georeference->vertical = kFlatGround;
  item.position.datum = HeightDatum::sea_level;
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  item.position.height_m = std::nan("");
  expect_error(locate, ErrorCode::height_unknown, "a.csv: line 2");
  options.missing_height_m = 20;
  options.levels.sea_level_z_m = 3;
  EXPECT_EQ(locate_flight(one, options).flight.points[0].position.z(), 23);
  options.georeference.reset();
  expect_error(locate, ErrorCode::not_georeferenced, "a.csv");
}

TEST(LocateFlight, RefusesPlansOfAnotherPlace) {
  LocateOptions options = in_munich();
  const auto locate = [&](double latitude, double longitude) {
    locate_flight(parsed_plan(plan({waypoint(48, 11, 5, 0), waypoint(latitude, longitude, 5, 0)})), options);
  };
  locate(48.4, 11);
  expect_error([&] { locate(48.5, 11); }, ErrorCode::too_far_away, "item 2");
  expect_error([&] { locate(11, 48); }, ErrorCode::too_far_away, "item 2");
  expect_error([&] { locate(-33, 151); }, ErrorCode::too_far_away, "item 2");
  options.farthest_m = 80e3;
  locate(48.5, 11);
}

// Their positions are near enough, and the ways to them are not.
TEST(LocateFlight, RefusesCurvesThatLeadElsewhere) {
  const auto locate = [](const std::vector<std::string>& items) {
    return [items] { locate_flight(parsed_plan(plan(items)), in_munich()); };
  };
  const std::string south = waypoint(48.3, 11, 5, 0), north = waypoint(48.44, 11, 5, 0);
  const auto circle = [](const std::string& radius) { return simple(18, 0, "[1, 0, " + radius + ", 0, 48.4, 11, 5]"); };
  locate({south, circle("1000")})();
  expect_error(locate({south, circle("10000")}), ErrorCode::too_far_away, "item 2");
  expect_code(locate({south, simple(34, 0, "[10000, 0, 0, 6.2, 48.4, 11, 5]")}), ErrorCode::too_far_away, "item 2");
  const auto arc = [](const std::string& angle) { return simple(36, 0, "[" + angle + ", 0, 0, 0, 48.2, 11, 5]"); };
  locate({waypoint(48, 11, 5, 0), arc("180")})();
  expect_code(locate({waypoint(48, 11, 5, 0), arc("330")}), ErrorCode::too_far_away, "item 2");
  const std::string at = "[0, 0, 0, 0, 48.44, 11.1, 5]";
  locate({south, north, simple(16, 0, at)})();
  expect_code(locate({south, north, simple(82, 0, at)}), ErrorCode::too_far_away, "item 3");
}

TEST(LocateFlight, FollowsPositionsOfTheFrame) {
  const geo::LocalFrame frame({11, 48});
  const FlightPlan two = parsed_plan(plan({waypoint(48.003, 11.002, 5, 0), waypoint(47.99, 11.05, 9, 0)}, 2, "null"));
  const LocatedPlan located = locate_flight(two, in_munich());
  ASSERT_EQ(located.flight.points.size(), 2u);
  EXPECT_LT((located.flight.points[1].position.head<2>() - frame.to_local({11.05, 47.99})).norm(), 1e-9);
  EXPECT_EQ(located.flight.points[1].speed_m_s, 5);
  EXPECT_EQ(located.flight.points[1].place, "/data/flight.plan: item 2");
  EXPECT_EQ(located.items, (std::vector<std::size_t>{0, 1}));
  EXPECT_LT(located.flight.chord_error_m, 1e-3);  // of geodesics alone
}

TEST(LocateFlight, CutsGeodesicsWhereTheFrameBendsThem) {
  Random random(5);
  std::size_t most = 0;
  for (int i = 0; i < 60; ++i) {
    const geo::LocalFrame frame({11, 48});
    const Vec3 a = random.point(-33e3, 33e3),
               b = i % 3 == 0 ? Vec3(random.point(-33e3, 33e3)) : Vec3(a + random.point(-3e3, 3e3));
    const geo::LonLat from = frame.to_lonlat(a.head<2>()), to = frame.to_lonlat(b.head<2>());
    FlightPlan two;
    two.items.resize(2);
    two.items[0].position = {{from.longitude_deg, from.latitude_deg}, 100, HeightDatum::scene_z};
    two.items[1].position = {{to.longitude_deg, to.latitude_deg}, 300, HeightDatum::scene_z};
    LocateOptions options = in_munich();
    options.chord_error_m = 0.01;
    const Flight flight = locate_flight(two, options).flight;
    most = std::max(most, flight.points.size());
    const geo::LocalFrame about(from);
    const Eigen::Vector2d way = about.to_local(to);
    for (int k = 0; k <= 200; ++k) {
      const Eigen::Vector2d p = frame.to_local(about.to_lonlat(way * k / 200));
      const Vec3 at(p.x(), p.y(), 100 + k);
      double nearest = 1e9;
      for (std::size_t leg = 0; leg < flight.leg_count(); ++leg)
        nearest = std::min(nearest, distance_to_leg(flight.leg(leg), at));
      ASSERT_LE(nearest, flight.chord_error_m);
    }
  }
  EXPECT_GT(most, 2u);
}

TEST(LocateFlight, CirclesWithinTheErrorOfChords) {
  Random random(8);
  for (const double error_m : {0.5, 0.05, 0.001}) {
    for (const double radius_m : {2.0, -75.0, 900.0}) {
      const FlightPlan circle = parsed_plan(
          plan({waypoint(48.2, 11.1, 40), simple(18, 3, "[1.5, 0, " + shortest(radius_m) + ", 0, 48.21, 11.1, 50]"),
                waypoint(48.22, 11.12, 60)}));
      LocateOptions options = in_munich();
      options.chord_error_m = error_m;
      const LocatedPlan located = locate_flight(circle, options);
      const geo::LocalFrame frame({11, 48}), about({11.1, 48.21});
      double turned = 0, length = 0;
      std::size_t chords = 0;
      for (std::size_t i = 1; i < located.items.size(); ++i) {
        if (located.items[i] != 1 || located.items[i - 1] != 1) continue;
        const Leg leg = located.flight.leg(i - 1);
        const auto on_circle = [&](const Vec3& p) { return about.to_local(frame.to_lonlat(p.head<2>())); };
        for (int k = 0; k <= 8; ++k) {
          const double off = std::abs(on_circle(leg.from + (leg.to - leg.from) * k / 8.0).norm() - std::abs(radius_m));
          ASSERT_LE(off, error_m);
        }
        const Eigen::Vector2d p = on_circle(leg.from), q = on_circle(leg.to);
        turned += std::atan2(p.y() * q.x() - p.x() * q.y(), p.dot(q));  // clockwise
        length += (leg.to - leg.from).norm();
        ++chords;
      }
      EXPECT_NEAR(turned, 3 * std::numbers::pi * (radius_m > 0 ? 1 : -1), 1e-6);
      EXPECT_NEAR(length, 3 * std::numbers::pi * std::abs(radius_m), 3 * std::sqrt(error_m * std::abs(radius_m)) + 0.1);
      EXPECT_GE(chords, 6u);
    }
  }
}

TEST(LocateFlight, CirclesForATime) {
  const std::string loiter = simple(19, 3, "[100, 0, 40, 0, 48.002, 11, 50]");
  const FlightPlan circles = parsed_plan(plan({waypoint(48, 11, 50), loiter}, 1));
  const LocatedPlan located = locate_flight(circles, in_munich());
  double length = 0;
  for (std::size_t i = 1; i < located.items.size(); ++i) {
    if (located.items[i - 1] != 1 || located.flight.points[i].is_other_way) continue;
    length += (located.flight.leg(i - 1).to - located.flight.leg(i - 1).from).norm();
  }
  EXPECT_NEAR(length, 100 * 15, 3);
  // A multirotor stays.
  const LocatedPlan stays = locate_flight(parsed_plan(plan({waypoint(48, 11, 50), loiter})), in_munich());
  EXPECT_EQ(stays.flight.points.size(), 2u);
  EXPECT_EQ(stays.flight.points[1].hold_s, 100);
  const FlightPlan open = parsed_plan(plan({waypoint(48, 11, 50), simple(18, 3, "[1, 0, 0, 0, 48.002, 11, 50]")}));
  LocateOptions options = in_munich();
  expect_error([&] { locate_flight(open, options); }, ErrorCode::missing_key, "item 2");
  options.loiter_radius_m = 30;
  EXPECT_GT(locate_flight(open, options).flight.points.size(), 10u);
  // Of its own radius a plan may say which way round: to the south of the centre, so to the west or the east first.
  FlightPlan own = circles;
  own.items[1].loiter_radius_m = -0.0;
  own.items[1].hold_s = 1;
  const auto first_x = [&] {
    const Flight flight = locate_flight(own, options).flight;
    return flight.points.at(2).position.x();
  };
  EXPECT_GT(first_x(), 0);
  own.items[1].loiter_radius_m = 0;
  EXPECT_LT(first_x(), 0);
}

TEST(LocateFlight, CutsCornersByArcs) {
  FlightPlan corner;
  corner.is_in_scene_frame = true;
  corner.items.resize(3);
  corner.items[0].position = {{0, 0}, 10, HeightDatum::scene_z};
  corner.items[1].position = {{100, 0}, 10, HeightDatum::scene_z};
  corner.items[2].position = {{100, 80}, 10, HeightDatum::scene_z};
  LocateOptions options;
  EXPECT_EQ(locate_flight(corner, options).flight.points.size(), 3u);
  EXPECT_EQ(locate_flight(corner, options).flight.chord_error_m, 0);
  corner.items[1].cut_m = 20;
  const Flight flight = locate_flight(corner, options).flight;
  EXPECT_GT(flight.points.size(), 5u);
  EXPECT_LT((flight.points[1].position - Vec3(80, 0, 10)).norm(), 1e-9);
  EXPECT_LT((flight.points[flight.points.size() - 2].position - Vec3(100, 20, 10)).norm(), 1e-9);
  for (std::size_t i = 1; i + 1 < flight.points.size(); ++i) {
    EXPECT_NEAR((flight.points[i].position - Vec3(80, 20, 10)).norm(), 20, 1e-9);
    if (i + 2 < flight.points.size()) {
      const Vec3 middle = (flight.points[i].position + flight.points[i + 1].position) / 2;
      EXPECT_LE(20 - (middle - Vec3(80, 20, 10)).norm(), options.chord_error_m);
    }
  }
  corner.items[1].hold_s = 1;  // it goes there, or does not stay
  EXPECT_EQ(locate_flight(corner, options).flight.points.size(), 3u);
  EXPECT_EQ(locate_flight(corner, options).flight.not_judged.size(), 1u);
}

TEST(LocateFlight, FollowsTheGround) {
  Random random(13);
  for (int i = 0; i < 12; ++i) {
    const auto hills = std::make_shared<const Mesh>(make_hills(random, 200, 25, 20, Vec3(0, 0, 0)));
    const Ground ground{0, hills};
    const GroundLevels levels(ground);
    FlightPlan two;
    two.is_in_scene_frame = true;
    two.items.resize(2);
    const Vec3 a = random.point(-190, 190);
    const Vec3 b = i % 4 == 0 ? Vec3(a.x(), -a.y(), 0) : random.point(-190, 190);
    two.items[0].position = {a.head<2>(), 20, HeightDatum::ground};
    two.items[1].position = {b.head<2>(), 60, HeightDatum::ground};
    two.items[1].follows_ground = true;
    LocateOptions options;
    options.ground = &ground;
    options.ground_error_m = i % 2 == 0 ? 0.25 : 3;
    const Flight flight = locate_flight(two, options).flight;
    EXPECT_EQ(flight.chord_error_m, options.ground_error_m);
    const Eigen::Vector2d way = (b - a).head<2>();
    std::size_t checked = 0;
    for (std::size_t leg = 0; leg < flight.leg_count(); ++leg) {
      for (int k = 0; k <= 20; ++k) {
        const Vec3 p = flight.leg(leg).from + (flight.leg(leg).to - flight.leg(leg).from) * k / 20.0;
        const double share = (p - a).head<2>().dot(way) / way.squaredNorm();
        const auto range = levels.at(p.x(), p.y());
        ASSERT_TRUE(range);
        ASSERT_NEAR(p.z() - range->highest_m, 20 + 40 * share, options.ground_error_m + 1e-3);
        ++checked;
      }
    }
    EXPECT_GE(checked, 42u);
    two.items[1].follows_ground = false;
    EXPECT_EQ(locate_flight(two, options).flight.points.size(), 2u);
    two.items[1].follows_ground = true;
    two.items[1].position.horizontal = {300, 0};
    expect_code([&] { locate_flight(two, options); }, ErrorCode::ground_missing);
  }
}

// A line along an edge that triangles share, and a step of the ground.
TEST(LocateFlight, FollowsEdgesAndStepsOfTheGround) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},   {50, 0, 0},   {50, 50, 0},   {0, 50, 0},
                   {50, 0, 30}, {100, 0, 30}, {100, 50, 30}, {50, 50, 30}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const Ground ground{0, std::make_shared<const Mesh>(mesh)};
  FlightPlan two;
  two.is_in_scene_frame = true;
  two.items.resize(2);
  two.items[0].position = {{0, 0}, 10, HeightDatum::ground};
  two.items[1].position = {{50, 50}, 10, HeightDatum::ground};
  two.items[1].follows_ground = true;
  LocateOptions options;
  options.ground = &ground;
  EXPECT_EQ(locate_flight(two, options).flight.points.size(), 2u + 1u);  // up at the step, at its end
  two.items[1].position.horizontal = {100, 50};
  const Flight flight = locate_flight(two, options).flight;
  ASSERT_EQ(flight.points.size(), 4u);
  EXPECT_LT((flight.points[1].position - Vec3(50, 25, 10)).norm(), 1e-5);
  EXPECT_LT((flight.points[2].position - Vec3(50, 25, 40)).norm(), 1e-5);
}

TEST(LocateFlight, TakesOffAndReturns) {
  std::vector<std::string> items{simple(22, 3, "[0, 0, 0, null, 48, 11, 30]"), waypoint(48.002, 11, 50),
                                 simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]")};
  const FlightPlan copter = parsed_plan(plan(items));
  const auto heights = [](const LocatedPlan& located) {
    std::vector<double> z;
    for (const FlightPoint& point : located.flight.points) z.push_back(point.position.z());
    return z;
  };
  LocateOptions options = in_munich();
  const LocatedPlan plain = locate_flight(copter, options);
  EXPECT_EQ(heights(plain), (std::vector<double>{530, 550, 550}));
  EXPECT_LT(plain.flight.points[0].position.head<2>().norm(), 1e-6);
  EXPECT_LT(plain.flight.points[2].position.head<2>().norm(), 1e-6);
  ASSERT_TRUE(plain.home);
  EXPECT_EQ(plain.home->z(), 500);
  EXPECT_TRUE(has_note(plain.notes, WarningCode::plan_assumed));
  options.return_height_m = 80;
  options.with_ground_legs = true;
  const LocatedPlan whole = locate_flight(copter, options);
  EXPECT_EQ(heights(whole), (std::vector<double>{500, 530, 550, 580, 580, 500}));
  EXPECT_TRUE(whole.notes.empty());
  items[0] = simple(22, 3, "[0, 0, 0, null, 48.001, 11, 30]");
  EXPECT_EQ(heights(locate_flight(parsed_plan(plan(items, 1)), options)),
            (std::vector<double>{500, 530, 550, 580, 580, 500}));
  const FlightPlan lands = parsed_plan(plan({waypoint(48.002, 11, 50), simple(21, 3, "[0, 0, 0, 0, 48.003, 11, 0]")}));
  EXPECT_EQ(heights(locate_flight(lands, options)), (std::vector<double>{500, 550, 550, 550, 550, 500}));
  options.with_ground_legs = false;
  EXPECT_EQ(heights(locate_flight(lands, options)), (std::vector<double>{550, 550, 550, 550, 500})) << "elsewhere";
  EXPECT_EQ(heights(locate_flight(
                parsed_plan(plan({waypoint(48.002, 11, 50), simple(21, 3, "[0, 0, 0, 0, 48, 11, 0]")})), options)),
            (std::vector<double>{550, 550, 550, 550}))
      << "at the home";
  const FlightPlan homeless =
      parsed_plan(plan({waypoint(48.002, 11, 50, 0), simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]")}, 2, "null"));
  expect_error([&] { locate_flight(homeless, options); }, ErrorCode::missing_key, "item 2");
}

// Down to the ground and up again: whatever height the landing has, it ends on the ground.
TEST(LocateFlight, LandsAndTakesOffOnItsWay) {
  const Ground ground{470, nullptr};
  LocateOptions options = in_munich();
  options.home_z_m = 500;
  options.ground = &ground;
  const auto located = [&](const std::string& takeoff, int vehicle) {
    return locate_flight(parsed_plan(plan({waypoint(48.002, 11, 50), simple(21, 3, "[0, 0, 0, 0, 48.003, 11, 0]"),
                                           takeoff, waypoint(48.004, 11, 50)},
                                          vehicle)),
                         options)
        .flight;
  };
  const auto heights = [&](const std::string& takeoff, int vehicle) {
    std::vector<double> z;
    for (const FlightPoint& point : located(takeoff, vehicle).points) z.push_back(point.position.z());
    return z;
  };
  const std::string there = simple(22, 3, "[0, 0, 0, 0, 48.003, 11, 30]"),
                    here = simple(22, 3, "[0, 0, 0, 0, 0, 0, 30]"),
                    elsewhere = simple(22, 3, "[0, 0, 0, 0, 48.0035, 11, 30]");
  EXPECT_EQ(heights(there, 2), (std::vector<double>{550, 550, 550, 550, 470, 530, 550})) << "first from the home";
  EXPECT_EQ(heights(here, 2), (std::vector<double>{550, 550, 550, 550, 470, 530, 550}));
  EXPECT_EQ(heights(there, 1), (std::vector<double>{550, 470, 530, 550})) << "on slopes";
  EXPECT_EQ(heights(elsewhere, 2), (std::vector<double>{550, 550, 550, 550, 470, 530, 530, 550}));
  EXPECT_TRUE(located(here, 2).not_judged.empty());
  ASSERT_EQ(located(elsewhere, 2).not_judged.size(), 1u);
  expect_wording(located(elsewhere, 2).not_judged);
}

/// Waypoints in the scene frame.
FlightPlan in_scene(const std::vector<Vec3>& positions) {
  FlightPlan plan;
  plan.is_in_scene_frame = true;
  for (const Vec3& at : positions) {
    plan.items.emplace_back().position = {at.head<2>(), at.z(), HeightDatum::scene_z};
  }
  return plan;
}

/// How far the flight's legs are from a point.
double distance_to_flight(const Flight& flight, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < flight.leg_count(); ++i) least = std::min(least, distance_to_leg(flight.leg(i), p));
  return least;
}

// Clockwise from the west over the north to the east, and likewise.
TEST(LocateFlight, FliesArcs) {
  const auto arc = [](double angle, const Vec3& to, const LocateOptions& options = {}) {
    FlightPlan plan = in_scene({{-20, 0, 10}, to});
    plan.items[1].arc_deg = angle;
    plan.items[1].hold_s = 3;
    return locate_flight(plan, options).flight;
  };
  const Flight half = arc(180, {20, 0, 30});
  EXPECT_EQ(half.chord_error_m, 0.05);
  EXPECT_LT(distance_to_flight(half, {0, 20, 20}), 0.05);
  EXPECT_GT(distance_to_flight(half, {0, -20, 20}), 20);
  EXPECT_LT((half.points.back().position - Vec3(20, 0, 30)).norm(), 1e-9);
  EXPECT_EQ(half.points.back().hold_s, 3);
  for (std::size_t i = 0; i + 1 < half.points.size(); ++i) EXPECT_EQ(half.points[i].hold_s, 0);
  EXPECT_LT(distance_to_flight(arc(-180, {20, 0, 30}), {0, -20, 20}), 0.05);
  EXPECT_LT(distance_to_flight(arc(270, {20, 0, 10}), {0, 20 + 20 * std::numbers::sqrt2, 10}), 0.05);
  EXPECT_LT(distance_to_flight(arc(-90, {20, 0, 10}), {0, 20 - 20 * std::numbers::sqrt2, 10}), 0.05);
  EXPECT_EQ(arc(180, {-20, 0, 30}).points.size(), 2u) << "where it is: straight";
  // Seven and a half turns up: every position of the helix.
  const Flight helix = arc(-2700, {20, 0, 90});
  for (int i = 0; i <= 200; ++i) {
    const double share = i / 200.0, angle = std::numbers::pi + share * 15 * std::numbers::pi;
    ASSERT_LT(distance_to_flight(helix, {20 * std::cos(angle), 20 * std::sin(angle), 10 + 80 * share}), 0.05) << i;
  }
  LocateOptions fine;
  fine.chord_error_m = 1e-9;
  expect_error([&] { arc(35000, {20, 0, 10}, fine); }, ErrorCode::work_too_large);
}

// The frame of the scene bends it by nothing that counts, and ground legs keep their height.
TEST(LocateFlight, FliesArcsOnTheEarthAndOverGround) {
  const FlightPlan plan = parsed_plan(plan_texts::plan(
      {waypoint(48, 10.999731994569604, 550, 0), simple(36, 0, "[180, 0, 0, null, 48.00269807653214, 11, 550]")}, 2,
      "null"));
  const Flight flight = locate_flight(plan, in_munich()).flight;
  const geo::LocalFrame frame({11, 48});
  const Vec3 begin = flight.points.front().position, end = flight.points.back().position;
  EXPECT_LT((end.head<2>() - frame.to_local({11, 48.00269807653214})).norm(), 1e-6);
  const Vec3 centre = (begin + end) / 2;
  for (const FlightPoint& point : flight.points) {
    EXPECT_NEAR((point.position - centre).norm(), (end - begin).norm() / 2, 0.01);
    EXPECT_LE((point.position - begin).head<2>().dot(Eigen::Vector2d((end - begin).y(), -(end - begin).x())), 1);
  }
  FlightPlan low = in_scene({{-20, 0, 0}, {20, 0, 0}});
  for (PlanItem& item : low.items) {
    item.position.datum = HeightDatum::ground;
    item.position.height_m = 10;
  }
  low.items[1].follows_ground = true;
  low.items[1].arc_deg = 180;
  const Ground slope{0, std::make_shared<const Mesh>(
                            Mesh{{{-99, -99, 0}, {99, -99, 0}, {99, 99, 99}, {-99, 99, 99}}, {{0, 1, 2}, {0, 2, 3}}})};
  LocateOptions options;
  options.ground = &slope;
  const Flight over = locate_flight(low, options).flight;
  EXPECT_LT(distance_to_flight(over, {0, 20, 119.0 / 2 + 10}), 0.3);
}

// To a height above ground from one that is not: even in the scene, as a straight leg would be.
TEST(LocateFlight, FliesArcsToHeightsAboveGround) {
  FlightPlan plan = in_scene({{-20, 0, 10}, {20, 0, 10}});
  plan.items[1].position.datum = HeightDatum::ground;
  plan.items[1].follows_ground = true;
  plan.items[1].arc_deg = 180;
  const Ground slope{0, std::make_shared<const Mesh>(
                            Mesh{{{-99, -99, 0}, {99, -99, 0}, {99, 99, 99}, {-99, 99, 99}}, {{0, 1, 2}, {0, 2, 3}}})};
  LocateOptions options;
  options.ground = &slope;
  const Flight flight = locate_flight(plan, options).flight;
  EXPECT_LT(distance_to_flight(flight, {0, 20, (10 + 99.0 / 2 + 10) / 2}), 0.05);
  for (std::size_t i = 0; i < flight.leg_count(); ++i) {
    EXPECT_GT(flight.leg(i).to.z(), flight.leg(i).from.z()) << "no steps: " << i;
    EXPECT_LT(flight.leg(i).to.z() - flight.leg(i).from.z(), 5) << i;
  }
}

/// The cubic of Bezier that has these ends and tangents, by de Casteljau's halving of its control points.
Vec3 cubic_at(const Vec3& from, const Vec3& to, const Vec3& from_tangent, const Vec3& to_tangent, double t) {
  std::vector<Vec3> points{from, from + from_tangent / 3, to - to_tangent / 3, to};
  while (points.size() > 1) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) points[i] = (1 - t) * points[i] + t * points[i + 1];
    points.pop_back();
  }
  return points[0];
}

/// A loiter about (60, 0, 10) between waypoints in the west and the north.
FlightPlan with_loiter(double radius_m, double height_m = 10) {
  FlightPlan plan = in_scene({{-60, 0, 10}, {60, 0, height_m}, {60, 90, height_m}});
  plan.file = "a.plan";
  PlanItem& loiter = plan.items[1];
  loiter.kind = PlanItemKind::loiter;
  loiter.place = "a.plan: item 2";
  loiter.loiter_radius_m = radius_m;
  loiter.turns = 1;
  return plan;
}

bool flies(const Flight& flight, const Vec3& from, const Vec3& to) {
  for (int i = 0; i <= 100; ++i) {
    if (distance_to_flight(flight, from + i / 100.0 * (to - from)) > flight.chord_error_m + 1e-9) return false;
  }
  return true;
}

// A plane circles, and a multirotor stays: the ways of both, there and on.
TEST(LocateFlight, FliesBothWaysOfVehiclesThatNobodyKnows) {
  FlightPlan plan = with_loiter(20);
  const Vec3 begin(-60, 0, 10), end(60, 90, 10), centre(60, 0, 10), side(60, -20, 10), entry(40, 0, 10);
  const Flight circles = locate_flight(plan, {}).flight;
  EXPECT_TRUE(flies(circles, begin, entry) && flies(circles, side, side) && flies(circles, entry, end));
  EXPECT_FALSE(flies(circles, centre, centre));
  plan.items[1].may_stay = true;
  const LocatedPlan both = locate_flight(plan, {});
  EXPECT_TRUE(flies(both.flight, begin, centre) && flies(both.flight, centre, end));
  EXPECT_TRUE(flies(both.flight, side, side) && flies(both.flight, entry, end));
  EXPECT_TRUE(both.flight.not_judged.empty());
  // On to a landing, and up from it, nothing leads along the ground.
  plan.items[2].kind = PlanItemKind::land;
  plan.items[2].position.height_m = 0;
  const Flight lands = locate_flight(plan, {}).flight;
  EXPECT_TRUE(flies(lands, centre, end) && flies(lands, entry, end) && flies(lands, end, {60, 90, 0}));
  for (std::size_t i = 0; i < lands.leg_count(); ++i) {
    EXPECT_TRUE(lands.leg(i).from.z() > 0 || lands.leg(i).to.z() > 0) << i;
  }
}

/// The legs that the vehicle flies for certain.
double length_of(const FlightPlan& plan, const LocateOptions& options = {}) {
  return length_m(locate_flight(plan, options).flight);
}

// A delay behind a circle takes nothing away from it.
TEST(LocateFlight, StaysBehindACircle) {
  for (const PlanVehicle vehicle : {PlanVehicle::unknown, PlanVehicle::multirotor}) {
    FlightPlan plan = with_loiter(20);
    plan.vehicle = vehicle;
    const double length = length_of(plan);
    plan.items[1].hold_s = 3;
    EXPECT_EQ(length_of(plan), length);
    const Flight flight = locate_flight(plan, {}).flight;
    EXPECT_TRUE(flies(flight, {60, -20, 10}, {60, -20, 10}));
    double held_s = 0;
    for (const FlightPoint& point : flight.points) held_s += point.hold_s;
    EXPECT_EQ(held_s, 3);
    plan.speed_m_s = 1;
    plan.items[1].is_timed = true;
    EXPECT_LT(length_of(plan), length - 100);
  }
  // Of a climb: in the end alone.
  FlightPlan plan = with_loiter(20, 40);
  plan.vehicle = PlanVehicle::multirotor;
  plan.items[1].is_climb = true;
  plan.items[1].turns = 0;
  plan.items[1].hold_s = 3;
  double held_s = 0;
  for (const FlightPoint& point : locate_flight(plan, {}).flight.points) held_s += point.hold_s;
  EXPECT_EQ(held_s, 3);
}

// It is wherever it may be, and what nobody knows is no part of what is seen, of the length or of the time.
TEST(LocateFlight, FliesAllWaysOffACircle) {
  const double along = 20 * std::sqrt(1 - 4 / 81.0), across = 20 * 2 / 9.0;  // of the tangents through (60, 90)
  const Vec3 end(60, 90, 10), east(60 + along, across, 10), west(60 - along, across, 10), north(60, 20, 10);
  for (const double radius : {20.0, -20.0}) {
    for (const double turns : {0.1, 1.0, 2.5}) {
      SCOPED_TRACE(shortest(radius) + ", " + shortest(turns));
      FlightPlan plan = with_loiter(radius);
      plan.items[1].turns = turns;
      plan.vehicle = PlanVehicle::multirotor;
      const Flight hovers = locate_flight(plan, {}).flight;
      EXPECT_FALSE(flies(hovers, east, end) || flies(hovers, west, end) || flies(hovers, north, end));
      for (const PlanVehicle vehicle : {PlanVehicle::fixed_wing, PlanVehicle::vtol, PlanVehicle::unknown}) {
        plan.vehicle = vehicle;
        const Flight flight = locate_flight(plan, {}).flight;
        EXPECT_TRUE(flies(flight, east, end) && flies(flight, west, end) && flies(flight, north, end));
        EXPECT_TRUE(flies(flight, {40, 0, 10}, end));
        for (int i = 0; i < 16; ++i) {
          const double angle = i * std::numbers::pi / 8;
          const Vec3 on_circle(60 + 20 * std::cos(angle), 20 * std::sin(angle), 10);
          EXPECT_TRUE(flies(flight, on_circle, on_circle)) << i;
        }
        EXPECT_NEAR(length_m(flight), 100 + 40 * std::numbers::pi * turns, 1);
        EXPECT_TRUE(flight.points[flight.points.size() - 2].is_other_way);
        EXPECT_FALSE(flight.points.back().is_other_way) << "it is there on any way";
        EXPECT_TRUE(flight.not_judged.empty());
        plan.items.pop_back();  // all of the circle, and there it ends
        EXPECT_TRUE(flies(locate_flight(plan, {}).flight, {60, -20, 10}, {60, -20, 10}));
        plan.items = with_loiter(radius).items;
        plan.items[1].turns = turns;
      }
    }
  }
  // On to another circle, to a stay, and within the circle.
  FlightPlan plan = with_loiter(20);
  plan.vehicle = PlanVehicle::fixed_wing;
  plan.items[2].kind = PlanItemKind::loiter;
  plan.items[2].loiter_radius_m = 30;
  plan.items[2].turns = 1;
  const Flight on = locate_flight(plan, {}).flight;
  EXPECT_TRUE(flies(on, {60, 120, 10}, {60, 120, 10}) && flies(on, north, {60, 60, 10}));
  plan = with_loiter(20);
  plan.items[2].hold_s = 5;
  EXPECT_EQ(locate_flight(plan, {}).flight.points.back().hold_s, 5);
  plan.items[2].position.horizontal = {60, 5};
  EXPECT_TRUE(flies(locate_flight(plan, {}).flight, north, {60, 5, 10}));
}

// Nothing with wings stops.
TEST(LocateFlight, CountsNoStaysOfWings) {
  FlightPlan plan = in_scene({{0, 0, 10}, {50, 0, 10}, {90, 0, 10}});
  plan.items[1].hold_s = 8;
  const auto held_s = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    return locate_flight(plan, {}).flight.points[1].hold_s;
  };
  EXPECT_EQ(held_s(PlanVehicle::multirotor), 8);
  EXPECT_EQ(held_s(PlanVehicle::fixed_wing), 0);
  EXPECT_EQ(held_s(PlanVehicle::vtol), 0);
  const std::vector<Warning> notes = locate_flight(plan, {}).notes;
  ASSERT_EQ(notes.size(), 1u);
  expect_wording(notes[0].text);
}

/// A home at the origin of the scene, whose ground is at 0.
LocateOptions with_home() {
  static const Ground kGround{0, nullptr};
  LocateOptions options;
  options.ground = &kGround;
  options.home = Eigen::Vector2d(0, 0);
  return options;
}

// Copters climb above the home and go on; others fly to the place of the takeoff first.
TEST(LocateFlight, TakesOffElsewhereOnBothWays) {
  FlightPlan plan = in_scene({{0, 100, 20}, {200, 100, 30}, {300, 100, 30}});
  LocateOptions options = with_home();
  plan.items[0].kind = PlanItemKind::takeoff;
  plan.items[0].hold_s = 5;
  const Vec3 above(0, 0, 20), away(0, 100, 20), next(200, 100, 30);
  for (const PlanVehicle vehicle : {PlanVehicle::multirotor, PlanVehicle::vtol, PlanVehicle::unknown}) {
    plan.vehicle = vehicle;
    const Flight flight = locate_flight(plan, options).flight;
    EXPECT_TRUE(flies(flight, above, away) && flies(flight, away, next) && flies(flight, above, next));
    EXPECT_NEAR(length_m(flight), 100, 1e-9) << "but for the last leg nothing is certain";
    EXPECT_TRUE(flight.not_judged.empty());
    for (const FlightPoint& point : flight.points) EXPECT_EQ(point.hold_s, 0);
  }
  plan.vehicle = PlanVehicle::fixed_wing;
  EXPECT_EQ(locate_flight(plan, options).flight.points.size(), 3u);
  plan.vehicle = PlanVehicle::multirotor;
  plan.items[0].position.horizontal = {0, 0.5};
  EXPECT_FALSE(locate_flight(plan, options).flight.points[1].is_other_way) << "it is at the home";
}

// Without a takeoff: level from above the home, a fixed wing on a slope. What it sees there does not count.
TEST(LocateFlight, ComesFromTheHomeWithoutATakeoff) {
  FlightPlan plan = in_scene({{0, 100, 40}, {200, 100, 40}});
  plan.items[0].hold_s = 5;
  LocateOptions options = with_home();
  const auto comes = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    const Flight flight = locate_flight(plan, options).flight;
    EXPECT_NEAR(length_m(flight), 200, 1e-9);
    double held_s = 0;
    for (const FlightPoint& point : flight.points) held_s += point.hold_s;
    EXPECT_EQ(held_s, vehicle == PlanVehicle::multirotor || vehicle == PlanVehicle::unknown ? 5 : 0);
    return std::tuple(flies(flight, {0, 0, 0}, {0, 0, 40}), flies(flight, {0, 0, 40}, {0, 100, 40}),
                      flies(flight, {0, 0, 0}, {0, 100, 40}));
  };
  EXPECT_EQ(comes(PlanVehicle::multirotor), std::tuple(false, false, false)) << "a table is flown in the air";
  for (const PlanFormat format : {PlanFormat::qgroundcontrol, PlanFormat::waypoints}) {
    plan.format = format;
    options.loiter_radius_m = 20;
    options.with_ground_legs = false;
    EXPECT_EQ(comes(PlanVehicle::multirotor), std::tuple(false, true, false));
    EXPECT_EQ(comes(PlanVehicle::fixed_wing), std::tuple(false, false, false));
    options.with_ground_legs = true;
    EXPECT_EQ(comes(PlanVehicle::multirotor), std::tuple(true, true, false));
    EXPECT_EQ(comes(PlanVehicle::vtol), std::tuple(true, true, false));
    EXPECT_EQ(comes(PlanVehicle::fixed_wing), std::tuple(false, false, true));
    EXPECT_EQ(comes(PlanVehicle::unknown), std::tuple(true, true, true));
  }
  plan.vehicle = PlanVehicle::multirotor;
  options.with_ground_legs = false;
  plan.items[0].is_spline = true;
  EXPECT_TRUE(flies(locate_flight(plan, options).flight, {0, 100, 40}, {200, 100, 40}));
  plan.items[0].is_spline = false;
  plan.items[0].position.horizontal = {0, 0.5};
  EXPECT_EQ(locate_flight(plan, options).flight.points.size(), 2u) << "it is at the home";
}

// What has wings circles about the last waypoint of a mission, and may be anywhere in the circle before.
TEST(LocateFlight, CirclesWhereTheMissionEnds) {
  FlightPlan plan = in_scene({{-60, 0, 10}, {0, 0, 10}});
  plan.file = "a.plan";
  plan.format = PlanFormat::qgroundcontrol;
  plan.items[1].place = "a.plan: item 2";
  LocateOptions options;
  const auto ends = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    return locate_flight(plan, options).flight;
  };
  EXPECT_TRUE(ends(PlanVehicle::multirotor).not_judged.empty());
  ASSERT_EQ(ends(PlanVehicle::fixed_wing).not_judged.size(), 1u);
  expect_wording(ends(PlanVehicle::fixed_wing).not_judged);
  EXPECT_EQ(ends(PlanVehicle::vtol).not_judged.size(), 1u);
  EXPECT_EQ(ends(PlanVehicle::unknown).not_judged.size(), 1u);
  options.loiter_radius_m = -30;
  for (const PlanVehicle vehicle : {PlanVehicle::fixed_wing, PlanVehicle::vtol, PlanVehicle::unknown}) {
    const Flight flight = ends(vehicle);
    EXPECT_TRUE(flight.not_judged.empty());
    EXPECT_EQ(flight.chord_error_m, 0.05 + 0.25);
    EXPECT_NEAR(length_m(flight), 60, 1e-9);
    for (int i = 0; i < 200; ++i) {
      const double away = 30 * i / 199.0, angle = i * 2.4;
      const Vec3 inside(away * std::cos(angle), away * std::sin(angle), 10);
      EXPECT_LE(distance_to_flight(flight, inside), flight.chord_error_m) << i;
    }
  }
  EXPECT_FALSE(flies(ends(PlanVehicle::multirotor), {0, 30, 10}, {0, 30, 10}));
  options.ground_error_m = 1e-5;
  expect_code([&] { ends(PlanVehicle::fixed_wing); }, ErrorCode::work_too_large, "item 2");
}

// Straight up and down, or on slopes: nobody knows which.
TEST(LocateFlight, TakesOffAndLandsOnSlopesToo) {
  FlightPlan plan = in_scene({{0, 100, 40}, {200, 100, 60}, {300, 100, 7}});
  LocateOptions options = with_home();
  plan.items[0].kind = PlanItemKind::takeoff;
  plan.items[2].kind = PlanItemKind::land;
  options.with_ground_legs = true;
  const auto on_slopes = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    const Flight flight = locate_flight(plan, options).flight;
    return std::pair(flies(flight, {0, 0, 0}, {0, 100, 40}), flies(flight, {200, 100, 60}, {300, 100, 0}));
  };
  const auto straight = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    const Flight flight = locate_flight(plan, options).flight;
    return std::pair(flies(flight, {0, 0, 0}, {0, 0, 40}), flies(flight, {300, 100, 60}, {300, 100, 0}));
  };
  EXPECT_EQ(on_slopes(PlanVehicle::multirotor), std::pair(false, false));
  EXPECT_EQ(on_slopes(PlanVehicle::fixed_wing), std::pair(true, true));
  EXPECT_EQ(on_slopes(PlanVehicle::unknown), std::pair(true, true));
  EXPECT_EQ(straight(PlanVehicle::multirotor), std::pair(true, true));
  EXPECT_EQ(straight(PlanVehicle::fixed_wing), std::pair(false, false));
  EXPECT_EQ(straight(PlanVehicle::unknown), std::pair(true, true));
}

// Whatever height it states; and time on the ground is none in the air.
TEST(LocateFlight, LandsOnTheGround) {
  FlightPlan plan = in_scene({{100, 0, 50}, {0, 0, 30}});
  LocateOptions options = with_home();
  plan.items[1].kind = PlanItemKind::land;
  plan.items[1].hold_s = 60;
  plan.items[1].place = "a.plan: item 2";
  options.with_ground_legs = true;
  const Flight home = locate_flight(plan, options).flight;
  EXPECT_EQ(home.points.back().position, Vec3(0, 0, 0));
  EXPECT_TRUE(home.not_judged.empty());
  EXPECT_EQ(home.points[home.points.size() - 2].hold_s, 0);
  options.with_ground_legs = false;
  EXPECT_EQ(locate_flight(plan, options).flight.points.back().hold_s, 0);
  plan.items[1].position.horizontal = {200, 0};
  EXPECT_EQ(locate_flight(plan, options).flight.points.back().position, Vec3(200, 0, 0));
  options.ground = nullptr;
  options.home_z_m = 0;
  const std::vector<std::string> told = locate_flight(plan, options).flight.not_judged;
  ASSERT_EQ(told.size(), 1u);
  expect_wording(told);
}

// What has wings circles about the home until the pilot acts.
TEST(LocateFlight, CirclesAboutTheHome) {
  FlightPlan plan = in_scene({{0, 300, 50}, {0, 0, 0}});
  LocateOptions options = with_home();
  plan.file = "a.plan";
  plan.format = PlanFormat::qgroundcontrol;
  plan.items[1] = PlanItem();
  plan.items[1].kind = PlanItemKind::return_home;
  plan.items[1].place = "a.plan: item 2";
  const auto located = [&](PlanVehicle vehicle) {
    plan.vehicle = vehicle;
    return locate_flight(plan, options);
  };
  EXPECT_TRUE(located(PlanVehicle::multirotor).flight.not_judged.empty());
  const std::vector<std::string> wing = located(PlanVehicle::fixed_wing).flight.not_judged;
  ASSERT_EQ(wing.size(), 1u);
  expect_wording(wing);
  EXPECT_EQ(located(PlanVehicle::vtol).flight.not_judged.size(), 1u);
  EXPECT_EQ(located(PlanVehicle::unknown).flight.not_judged.size(), 1u);
  plan.format = PlanFormat::waypoints;
  EXPECT_TRUE(located(PlanVehicle::unknown).flight.not_judged.empty());
  EXPECT_EQ(located(PlanVehicle::unknown).notes.size(), 2u) << "of the circle, and of the height";
  options.loiter_radius_m = 80;
  for (const PlanVehicle vehicle : {PlanVehicle::fixed_wing, PlanVehicle::vtol, PlanVehicle::unknown}) {
    const Flight flight = located(vehicle).flight;
    EXPECT_TRUE(flies(flight, {80, 0, 50}, {80, 0, 50}) && flies(flight, {0, -80, 50}, {0, -80, 50}));
    EXPECT_TRUE(flies(flight, {0, 300, 50}, {0, 0, 50}));
    EXPECT_NEAR(length_m(flight), 300, 1e-9);
    EXPECT_TRUE(flight.not_judged.empty());
  }
  EXPECT_FALSE(flies(located(PlanVehicle::multirotor).flight, {80, 0, 50}, {80, 0, 50}));
}

// Without a radius a table is taken as of a multirotor, with a note, and others are not judged; unless it is given.
TEST(LocateFlight, TellsCirclesThatTheVehicleKnowsAlone) {
  FlightPlan plan = with_loiter(0);
  plan.items[1].may_stay = true;
  const LocatedPlan open = locate_flight(plan, {});
  EXPECT_EQ(open.flight.points.size(), 3u);
  ASSERT_EQ(open.flight.not_judged.size(), 1u);
  expect_wording(open.flight.not_judged);
  plan.format = PlanFormat::waypoints;
  const LocatedPlan table = locate_flight(plan, {});
  EXPECT_EQ(table.flight.points.size(), 3u);
  EXPECT_TRUE(table.flight.not_judged.empty());
  ASSERT_EQ(table.notes.size(), 1u);
  expect_wording(table.notes[0].text);
  LocateOptions options;
  options.loiter_radius_m = 20;
  const LocatedPlan given = locate_flight(plan, options);
  EXPECT_TRUE(flies(given.flight, {60, -20, 10}, {60, -20, 10}) && given.notes.empty());
  // That no vehicle is named shows in what is read.
  const auto read = [](int vehicle) {
    const FlightPlan one = parsed_plan(plan_texts::plan({simple(19, 3, "[60, 0, 0, 0, 48, 11, 50]")}, vehicle));
    return std::pair(one.items.at(0).may_stay, one.items[0].turns);
  };
  EXPECT_EQ(read(0), std::pair(true, 1.0));
  EXPECT_EQ(read(1), std::pair(false, 1.0));
  EXPECT_EQ(read(2), std::pair(false, 0.0));
}

// It comes at its own height or at that before, and may be anywhere on the circles between.
TEST(LocateFlight, ClimbsInCircles) {
  FlightPlan plan = with_loiter(20, 40);
  plan.items[1].is_climb = true;
  const Flight flight = locate_flight(plan, {}).flight;
  EXPECT_EQ(flight.chord_error_m, 0.05 + 0.25);
  for (const double angle : {0.0, 1.0, 2.5, 4.0, 5.5}) {
    const Vec3 foot(60 + 20 * std::cos(angle), 20 * std::sin(angle), 10);
    EXPECT_TRUE(flies(flight, foot, foot + Vec3(0, 0, 30))) << angle;
  }
  EXPECT_TRUE(flies(flight, {-60, 0, 10}, {40, 0, 10}) && flies(flight, {-60, 0, 10}, {40, 0, 40}));
  EXPECT_TRUE(flies(flight, {40, 0, 40}, {60, 90, 40}));
  plan.items[1].turns = 0;  // a multirotor
  const Flight stays = locate_flight(plan, {}).flight;
  EXPECT_TRUE(flies(stays, {-60, 0, 10}, {60, 0, 10}) && flies(stays, {-60, 0, 10}, {60, 0, 40}));
  EXPECT_TRUE(flies(stays, {60, 0, 10}, {60, 0, 40}) && flies(stays, {60, 0, 40}, {60, 90, 40}));
  LocateOptions fine;
  fine.ground_error_m = 1e-5;
  plan.items[1].turns = 1;
  expect_code([&] { locate_flight(plan, fine); }, ErrorCode::work_too_large, "item 2");
}

// As ArduPilot's Copter takes the tangents: from the leg before, to the leg behind, along the chord between two
// splines; none where it stops.
TEST(LocateFlight, FliesSplines) {
  const std::vector<Vec3> at = {{0, 0, 10}, {40, 0, 10}, {60, 30, 20}, {20, 60, 30}, {-30, 60, 30}, {-60, 0, 10}};
  FlightPlan plan = in_scene(at);
  plan.items[2].is_spline = plan.items[3].is_spline = true;
  const auto expect_curve = [&](std::size_t item, const Vec3& first, const Vec3& last, double scale = 1) {
    const Flight flight = locate_flight(plan, {}).flight;
    for (int i = 0; i <= 200; ++i) {
      const Vec3 p = cubic_at(at[item - 1], at[item], scale * first, scale * last, i / 200.0);
      ASSERT_LT(distance_to_flight(flight, p), 0.05) << item << ": " << i;
    }
    EXPECT_EQ(flight.chord_error_m, 0.05);
  };
  expect_curve(2, at[1] - at[0], at[3] - at[1]);
  expect_curve(3, at[3] - at[1], at[4] - at[3]);
  plan.items[3].hold_s = 2;
  expect_curve(3, at[3] - at[1], {0, 0, 0});
  plan.items[1].hold_s = 2;
  expect_curve(2, {0, 0, 0}, at[3] - at[1]);
  plan.items[1].hold_s = 0;
  plan.items[0].kind = plan.items[1].kind = PlanItemKind::loiter;  // stays
  expect_curve(2, {0, 0, 0}, at[3] - at[1]);
  plan.items.resize(3);
  expect_curve(2, {0, 0, 0}, {0, 0, 0});
  // Long tangents are shortened.
  FlightPlan near = in_scene({{0, 0, 0}, {100, 0, 0}, {100, 5, 0}, {0, 5, 0}});
  near.items[2].is_spline = true;
  const double scale = 4 * 5 / (100.0 + 100.0);
  const Flight flight = locate_flight(near, {}).flight;
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p = cubic_at({100, 0, 0}, {100, 5, 0}, {scale * 100, 0, 0}, {-scale * 100, 0, 0}, i / 100.0);
    ASSERT_LT(distance_to_flight(flight, p), 0.05) << i;
  }
}

// The tangents of a spline follow from the items before and behind it, whose heights may not be measured alike.
TEST(LocateFlight, NamesSplinesBetweenHeightsOfTwoKinds) {
  const Ground ground{0, nullptr};
  LocateOptions options;
  options.ground = &ground;
  FlightPlan level = in_scene({{0, 0, 10}, {40, 0, 10}, {60, 30, 20}, {20, 60, 30}, {-30, 60, 30}});
  level.file = "a.plan";
  for (std::size_t i = 0; i < level.items.size(); ++i) level.items[i].place = "a.plan: item " + std::to_string(i + 1);
  level.items[2].is_spline = true;
  FlightPlan low = level;
  for (PlanItem& item : low.items) {
    item.position.datum = HeightDatum::ground;
    item.follows_ground = true;
  }
  const auto told = [&](const FlightPlan& plan) { return locate_flight(plan, options).flight.not_judged; };
  EXPECT_TRUE(told(level).empty());
  EXPECT_TRUE(told(low).empty());
  for (const auto& [all, other] : {std::pair(level, low), std::pair(low, level)}) {
    for (std::size_t i = 0; i < all.items.size(); ++i) {
      FlightPlan mixed = all;
      mixed.items[i].position.datum = other.items[i].position.datum;
      mixed.items[i].follows_ground = false;
      mixed.not_judged = {"a.plan: item 9: a loop"};
      const std::vector<std::string> names = told(mixed);
      ASSERT_EQ(names.size(), i < 4 ? 2u : 1u) << i;  // the last one is beside no spline
      EXPECT_EQ(names[0], mixed.not_judged[0]);
      if (i == 4) continue;
      EXPECT_EQ(names[1].find("a.plan: item 3: "), 0u) << names[1];
      if (i == 0) expect_wording(names);
    }
  }
  // Of heights that the ground station computes from its terrain no legs follow the ground.
  FlightPlan computed = low;
  for (PlanItem& item : computed.items) item.follows_ground = false;
  EXPECT_TRUE(told(computed).empty());
  computed.items[3].follows_ground = true;
  EXPECT_EQ(told(computed).size(), 1u);
  // Where the vehicle stops it comes from nowhere, and goes nowhere.
  FlightPlan stops = level;
  stops.items[0].position.datum = stops.items[3].position.datum = HeightDatum::ground;
  stops.items[1].hold_s = stops.items[2].hold_s = 1;
  EXPECT_TRUE(told(stops).empty());
}

TEST(LocateFlight, NamesTurnsThatFollowTheGround) {
  FlightPlan plan = in_scene({{0, 0, 10}, {100, 0, 10}, {100, 80, 10}});
  for (PlanItem& item : plan.items) item.position.datum = HeightDatum::ground;
  plan.items[1].cut_m = 20;
  plan.items[1].place = "a.kmz: waypoint 2";
  const Ground ground{0, nullptr};
  LocateOptions options;
  options.ground = &ground;
  EXPECT_TRUE(locate_flight(plan, options).flight.not_judged.empty());
  plan.items[1].follows_ground = plan.items[2].follows_ground = true;
  const std::vector<std::string> told = locate_flight(plan, options).flight.not_judged;
  ASSERT_EQ(told.size(), 1u);
  expect_wording(told);
}

TEST(LocateFlight, KeepsWhatIsNotJudged) {
  FlightPlan plan = in_scene({{0, 0, 10}, {40, 0, 10}});
  plan.not_judged = {"a.plan: item 3: a loop"};
  EXPECT_EQ(locate_flight(plan, {}).flight.not_judged, plan.not_judged);
}

// DJI's plans say how high the aircraft returns at least.
TEST(LocateFlight, ReturnsAtTheHeightOfThePlan) {
  const auto highest = [](const std::string& height) {
    const std::string config =
        "<wpml:finishAction>goHome</wpml:finishAction><wpml:takeOffRefPoint>48,11,560"
        "</wpml:takeOffRefPoint>" +
        height;
    LocateOptions options = in_munich();
    options.home_z_m = 500;
    const LocatedPlan located = locate_flight(
        parsed_plan(waylines(wayline(wayline_point(11.001, 48, 40) + wayline_point(11.002, 48, 50)), config)), options);
    double z = 0;
    for (const FlightPoint& point : located.flight.points) z = std::max(z, point.position.z());
    EXPECT_EQ(has_note(located.notes, WarningCode::plan_assumed), height.empty());
    return z;
  };
  EXPECT_EQ(highest(""), 550);
  EXPECT_EQ(highest("<wpml:globalRTHHeight>100</wpml:globalRTHHeight>"), 600);
  EXPECT_EQ(highest("<wpml:globalRTHHeight>20</wpml:globalRTHHeight>"), 550);
}

// Near the home vehicles climb less, or not at all; what has wings comes to that height in its own way.
TEST(LocateFlight, ReturnsAtAnyHeightNearTheHome) {
  LocateOptions options = with_home();
  options.return_height_m = 100;
  const auto returns = [&](double away_m, PlanVehicle vehicle) {
    FlightPlan plan = in_scene({{300, 0, 30}, {away_m, 0, 30}, {0, 0, 0}});
    plan.file = "a.plan";
    plan.format = PlanFormat::qgroundcontrol;
    plan.vehicle = vehicle;
    plan.items[2] = PlanItem();
    plan.items[2].kind = PlanItemKind::return_home;
    plan.items[2].place = "a.plan: item 3";
    return locate_flight(plan, options).flight;
  };
  const Flight near = returns(60, PlanVehicle::multirotor);
  EXPECT_EQ(near.points.back().position, Vec3(0, 0, 100));
  EXPECT_NEAR(length_m(near), 240, 1e-9) << "nothing of the return is certain";
  EXPECT_TRUE(near.not_judged.empty());
  for (double x = 0; x <= 60; x += 7) {
    for (double z = 30; z <= 100; z += 3.3) EXPECT_LE(distance_to_flight(near, {x, 0, z}), near.chord_error_m) << x;
  }
  const Flight far = returns(120, PlanVehicle::multirotor);
  EXPECT_GT(distance_to_flight(far, {60, 0, 50}), 19);
  EXPECT_NEAR(length_m(far), 180 + 70 + 120, 1e-9);
  options.loiter_radius_m = 20;
  const std::vector<std::string> told = returns(120, PlanVehicle::fixed_wing).not_judged;
  ASSERT_EQ(told.size(), 1u);
  expect_wording(told);
  options.return_height_m = 30;
  EXPECT_TRUE(returns(120, PlanVehicle::fixed_wing).not_judged.empty());
}

// "Safely": level at the higher one of the heights. "Point to point": straight, and down some aircraft fly level first.
TEST(LocateFlight, FliesToTheFirstWaypointAsDjiDoes) {
  const Ground ground{470, nullptr};
  LocateOptions options = in_munich();
  options.home_z_m = 500;
  options.ground = &ground;
  const auto flight = [&](const std::string& how, double height, const std::string& mode) {
    const std::string config = "<wpml:flyToWaylineMode>" + how +
                               "</wpml:flyToWaylineMode><wpml:takeOffSecurityHeight>100</wpml:takeOffSecurityHeight>"
                               "<wpml:takeOffRefPoint>48,11,560</wpml:takeOffRefPoint>";
    return locate_flight(parsed_plan(waylines(wayline(wayline_point(11.001, 48, height), mode), config)), options)
        .flight;
  };
  const std::string home = "relativeToStartPoint", ground_level = "aboveGroundLevel";
  for (const std::string how : {"safely", "pointToPoint"}) {
    for (const auto& [height, mode] :
         {std::pair(20.0, home), {50.0, ground_level}, {160.0, home}, {190.0, ground_level}}) {
      const Flight way = flight(how, height, mode);
      const double z = height + (mode == home ? 500 : 470);
      const Vec3 begin(0, 0, 600);
      Vec3 first = way.points.back().position;
      EXPECT_NEAR(first.z(), z, 1e-9);
      const Vec3 above(first.x(), first.y(), std::max(z, 600.0)), climbed(0, 0, std::max(z, 600.0));
      const bool is_safe = how == "safely", is_down = z < 600;
      EXPECT_LT(distance_to_flight(way, is_safe ? climbed : begin), 1e-6);
      EXPECT_EQ(distance_to_flight(way, (climbed + above) / 2) < 1e-3, is_safe || is_down) << how << z;
      EXPECT_EQ(distance_to_flight(way, (begin + first) / 2) < 1e-3, !is_safe) << how << z;
      EXPECT_EQ(distance_to_flight(way, (above + first) / 2) < 1e-3, true) << how << z;
    }
  }
}

TEST(LocateFlight, KnowsTheHomeThatAPlanOfDjiDoesNotHave) {
  const auto plan = [](int drone) {
    return parsed_plan(waylines(wayline(wayline_point(11.001, 48, 30) + wayline_point(11.002, 48, 30)),
                                "<wpml:flyToWaylineMode>safely</wpml:flyToWaylineMode><wpml:takeOffSecurityHeight>100"
                                "</wpml:takeOffSecurityHeight><wpml:droneInfo><wpml:droneEnumValue>" +
                                    std::to_string(drone) + "</wpml:droneEnumValue></wpml:droneInfo>"));
  };
  LocateOptions options = in_munich();
  options.home_z_m = 500;
  EXPECT_EQ(locate_flight(plan(67), options).flight.points.size(), 2U) << "nobody knows where it takes off";
  options.home = Eigen::Vector2d(11, 48);
  const Flight way = locate_flight(plan(67), options).flight;
  const Vec3 first = way.points[way.points.size() - 2].position, high(first.x() / 2, 0, 600),
             low(first.x() / 2, 0, 530);
  EXPECT_LT(distance_to_flight(way, high), 1e-3);
  EXPECT_GT(distance_to_flight(way, low), 10);
  const Flight either = locate_flight(plan(60), options).flight;  // a Matrice 300 flies at the waypoint's height
  EXPECT_LT(distance_to_flight(either, high), 1e-3);
  EXPECT_LT(distance_to_flight(either, low), 1e-3);
}

// DJI: a leg is longer than both turns at its ends. They may go beyond its middle.
TEST(LocateFlight, TurnsAsFarBeforeAWaypointAsItSays) {
  const auto turn = [](double metres, double hold_s) {
    FlightPlan plan;
    plan.is_in_scene_frame = true;
    plan.file = "a.csv";
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(0, 0), Eigen::Vector2d(100, 0), Eigen::Vector2d(100, 100)}) {
      PlanItem& item = plan.items.emplace_back();
      item.position = {at, 50, HeightDatum::scene_z};
      item.place = "a.csv: line " + std::to_string(plan.items.size());
    }
    plan.items[1].cut_m = metres;
    plan.items[1].hold_s = hold_s;
    return locate_flight(plan, {}).flight;
  };
  EXPECT_LT(distance_to_flight(turn(90, 0), {10, 0, 50}), 1e-6);
  EXPECT_GT(distance_to_flight(turn(90, 0), {60, 0, 50}), 5);
  EXPECT_TRUE(turn(90, 0).not_judged.empty());
  std::vector<std::string> told;
  for (const Flight& flight : {turn(120, 0), turn(20, 3)}) {
    ASSERT_EQ(flight.not_judged.size(), 1U);
    told.push_back(flight.not_judged[0]);
  }
  expect_wording(told);
}

TEST(LocateFlight, HasBounds) {
  FlightPlan circles = parsed_plan(plan({simple(18, 3, "[10000, 0, 90000, 0, 48, 11, 50]")}));
  LocateOptions options = in_munich();
  expect_error([&] { locate_flight(circles, options); }, ErrorCode::work_too_large, "item 1");
  options.chord_error_m = 0;
  expect_error([&] { locate_flight(circles, options); }, ErrorCode::value_out_of_range, "chord_error_m");
}

}  // namespace
}  // namespace vantage::testing
