// Links of flights, to a pilot or an antenna: against points of the flight, each judged by all triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "flight/flight_timeline.h"
#include "query/leg_link.h"
#include "query/link_query.h"
#include "support/flight_cases.h"
#include "support/legs.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "support/zone_oracle.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"

namespace vantage::testing {
namespace {

/// Whether the line between two points crosses a triangle well inside both. Shares nothing with the library.
bool crosses_one(const Mesh& mesh, const Vec3& from, const Vec3& to) {
  constexpr double kInside = 1e-7;
  const Vec3 along = to - from;
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    const Vec3 &a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
    const Vec3 p = along.cross(ac), q = (from - a).cross(ab);
    const double size = ab.dot(p);
    if (size == 0) return false;
    const double u = (from - a).dot(p) / size, v = along.dot(q) / size, w = ac.dot(q) / size;
    return u > kInside && v > kInside && u + v < 1 - kInside && w > kInside && w < 1 - kInside;
  });
}

Flight drawn_link_flight(Random& random) {
  Flight flight;
  const int count = random.integer(2, 5);
  for (int i = 0; i < count; ++i) {
    flight.points.push_back({{random.uniform(-70, 70), random.uniform(-70, 70), random.uniform(2, 60)}, 0, 5, ""});
  }
  return flight;
}

Mission city_with_link(Random& random, bool is_radio) {
  Mission mission = mission_in(random_city(random, 15, 8), Target::point({0, 0, 5}), 400);
  FlightLink link{"mast", {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(3, 8)}};
  if (random.chance(0.6)) link.max_range_m = random.uniform(40, 90);
  if (is_radio) link.radio = RadioLink{2.4, random.uniform(0.4, 1)};
  mission.links = {link};
  return mission;
}

std::pair<bool, double> where_linked(const LinkCheck& link, double at_m) {
  bool is_in = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (const FlightSpan& span : link.linked) {
    is_in = is_in || (span.begin_m <= at_m && at_m <= span.end_m);
    nearest = std::min({nearest, std::abs(span.begin_m - at_m), std::abs(span.end_m - at_m)});
  }
  return {is_in, nearest};
}

/// What a position is by all triangles. `more_m`: so much longer the ways of the zone may be.
bool is_linked(const Mission& mission, const Vec3& position, double more_m = 0) {
  const FlightLink& link = mission.links[0];
  const Mesh& mesh = mission.scene().mesh;
  if (link.max_range_m && (position - link.point).norm() > *link.max_range_m * (1 + 1e-12)) return false;
  if (!link.radio) return !crosses_one(mesh, link.point, position);
  RadioLink zone = *link.radio;
  const double excess = zone.clear * zone.clear * 0.299792458 / zone.frequency_ghz / 2;
  zone.clear *= std::sqrt(1 + more_m / excess);
  return ZoneOracle(mesh, link.point, zone).share(position) >= 1 - 1e-9;
}

void compare_with_points(std::uint64_t seed, bool is_radio) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::size_t linked = 0, lost = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Mission mission = city_with_link(random, is_radio);
    const Flight flight = drawn_link_flight(random);
    const double radius = trial % 2 == 0 ? 0 : random.uniform(0.1, 2);
    const FlightCheck check = check_flight(mission, flight, {.tube_radius_m = radius});
    const LinkCheck& link = check.links.at(0);
    const internal::flight::FlightTimeline along(flight, 5);
    double farthest = 0;
    for (int i = 0; i < 400; ++i) {
      const auto leg = static_cast<std::size_t>(random.integer(0, static_cast<int>(flight.leg_count()) - 1));
      const double share = random.uniform(0, 1);
      const Vec3 centre = along.position(leg, share);
      const Vec3 position = centre + radius * (1 - 1e-9) * random.uniform(0, 1) * random.direction();
      const double farthest_in_tube = (centre - link.point).norm() + radius;
      farthest = std::max(farthest, (position - link.point).norm());
      const auto [is_in, to_end] = where_linked(link, along.at_m(leg, share));
      if (is_in) {
        ++linked;
        ASSERT_TRUE(is_linked(mission, position)) << "trial " << trial << ", " << position.transpose();
      } else if (radius == 0 && to_end > 0.01) {
        ++lost;
        ASSERT_FALSE(is_linked(mission, position, 2.1e-3)) << "trial " << trial << ", " << position.transpose();
      } else if (is_radio && to_end > 0.01 && farthest_in_tube <= mission.links[0].max_range_m.value_or(1e9)) {
        ++lost;  // for a tube the zone is longer by twice its radius, and no more than that
        ASSERT_FALSE(is_linked(mission, centre, 2 * radius + 2.1e-3))
            << "trial " << trial << ", " << centre.transpose();
      }
    }
    ASSERT_LE(farthest, link.farthest_m + 1e-9);
    const auto is_of_link = [](const std::string& failure) { return failure.find("mast") != std::string::npos; };
    ASSERT_EQ(link.holds(), std::none_of(check.failures.begin(), check.failures.end(), is_of_link));
    double length = 0;
    for (const FlightSpan& span : link.linked) length += span.length_m();
    for (const FlightSpan& span : link.lost) length += span.length_m();
    ASSERT_NEAR(length, check.length_m, 1e-6);
  }
  EXPECT_GT(linked, 500U);
  EXPECT_GT(lost, 300U);
}

TEST(FlightLinks, LinesOfSightAgreeWithPoints) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) compare_with_points(seed, false);
}

TEST(FlightLinks, ZonesAgreeWithPoints) { compare_with_points(4, true); }

/// A wall between a pilot at the origin and a flight along x.
Mission behind_one_wall() {
  SceneBuilder scene;
  scene.ground("ground", 200, -0.5).box("wall", {-5, 10, -0.5}, {5, 11, 10});
  Mission mission = mission_in(scene, Target::point({0, 40, 5}), 500);
  mission.links = {{"pilot", {0, 0, 1}}};
  return mission;
}

Flight past_the_wall() {
  Flight flight;
  flight.points = {{{-60, 20, 5}, 0, 5, ""}, {{60, 20, 5}, 0, 5, ""}};
  return flight;
}

TEST(FlightLinks, TellWhatIsInTheWayAndWhere) {
  const FlightCheck check = check_flight(behind_one_wall(), past_the_wall());
  ASSERT_EQ(check.links.size(), 1U);
  const LinkCheck& link = check.links[0];
  ASSERT_EQ(link.lost.size(), 1U);
  // x = -10: the line passes the corner (-5, 10). A point is seen as a triangle of a millimetre.
  EXPECT_NEAR(link.lost[0].begin_m, 50, 1e-3);
  EXPECT_NEAR(link.lost[0].end_m, 70, 1e-3);
  EXPECT_LE(link.lost[0].begin_m, 50);
  EXPECT_GE(link.lost[0].end_m, 70);
  EXPECT_EQ(link.linked.size(), 2U);
  ASSERT_EQ(link.reasons.size(), 1U);
  EXPECT_EQ(link.reasons[0].kind, NotSeen::Kind::hidden);
  EXPECT_EQ(link.reasons[0].name, "wall");
  EXPECT_NEAR(link.farthest_m, Vec3(60, 20, 4).norm(), 1e-12);
  EXPECT_FALSE(check.passes());
  ASSERT_EQ(check.failures.size(), 1U);
  EXPECT_NE(check.failures[0].find("pilot"), std::string::npos);
  EXPECT_NE(check.failures[0].find("wall"), std::string::npos);
}

TEST(FlightLinks, EndAtTheRange) {
  Mission mission = behind_one_wall();
  mission.links[0].point.z() = 30;  // over the wall
  EXPECT_TRUE(check_flight(mission, past_the_wall()).links[0].holds());
  mission.links[0].max_range_m = 50;
  const LinkCheck near = check_flight(mission, past_the_wall()).links[0];
  const double half = std::sqrt(50 * 50 - 20 * 20 - 25 * 25);
  ASSERT_EQ(near.linked.size(), 1U);
  EXPECT_NEAR(near.linked[0].begin_m, 60 - half, 1e-6);
  EXPECT_EQ(near.reasons.at(0).kind, NotSeen::Kind::out_of_range);
  const LinkCheck tube = check_flight(mission, past_the_wall(), {.tube_radius_m = 3}).links[0];
  EXPECT_NEAR(tube.linked.at(0).begin_m, 60 - std::sqrt(47 * 47 - 20 * 20 - 25 * 25), 1e-6);
  EXPECT_NEAR(tube.farthest_m, near.farthest_m + 3, 1e-12);
}

TEST(FlightLinks, TextsTellThem) {
  Mission mission = behind_one_wall();
  mission.links[0].radio = RadioLink{5.8, 0.6};
  const FlightCheck check = check_flight(mission, past_the_wall());
  const auto json = nlohmann::json::parse(json_text(check)).at("links").at(0);
  EXPECT_EQ(json["name"], "pilot");
  EXPECT_EQ(json["holds"], false);
  EXPECT_EQ(json["reasons"][0]["name"], "wall");
  EXPECT_EQ(json["frequency_ghz"], 5.8);
  EXPECT_TRUE(json["max_range_m"].is_null());
  // The zone is wider than the line.
  EXPECT_LT(json["lost"][0]["begin_m"], 50 - 0.1);
  const std::string table = csv_text(check);
  EXPECT_NE(table.find("pilot,linked,,0,"), std::string::npos) << table;
  EXPECT_NE(table.find("pilot,link_hidden,wall,"), std::string::npos) << table;
}

// The flight is 100 m away, and sees its target within 30 m.
TEST(FlightLinks, WhatIsNotBuiltInTheirWayIsTold) {
  Scene scene = SceneBuilder().ground("ground", 200, -0.5);
  scene.ledger.push_back(
      {{"mast"}, "", "nothing tells how wide it is", Box{{29, 40, 0}, {30, 41, 30}}});  // counts from 20 m farther
  Mission mission = mission_in(scene, Target::point({0, 110, 5}), 30);
  Flight flight;
  flight.points = {{{-20, 100, 5}, 0, 5, ""}, {{0, 100, 5}, 0, 5, ""}};
  EXPECT_TRUE(check_flight(mission, flight).notes.empty());
  mission.links = {{"pilot", {0, 0, 1}}};
  EXPECT_TRUE(check_flight(mission, flight).notes.empty());
  EXPECT_EQ(check_flight(mission, flight, {.tube_radius_m = 10}).notes.size(), 1U);
  mission.links[0].radio = RadioLink{0.05, 1};  // its zone is 12 m wide in the middle
  EXPECT_EQ(check_flight(mission, flight).notes.size(), 1U);
  mission.links = {{"pilot", {40, 0, 1}}};
  ASSERT_EQ(check_flight(mission, flight).notes.size(), 1U);
  expect_wording(check_flight(mission, flight).notes[0]);
}

TEST(FlightLinks, SayWhichOfThemCannotBegin) {
  Mission mission = behind_one_wall();
  mission.links[0].point = {0, 10, 5};  // on the wall
  expect_code([&] { check_flight(mission, past_the_wall()); }, ErrorCode::target_pierced, "links[0]");
}

/// The ground is so near that it enters the zone of some vehicle in the tube, and of none on the leg itself: nothing is
/// halved to the end over that.
TEST(FlightLinks, ATubeNeedsFewPieces) {
  SceneBuilder builder;
  builder.ground("ground", 400, 0);
  const PreparedScene scene(builder);
  const internal::query::LinkQuery link(scene.data(), {0, 0, 30}, {2.4, 0.6});
  const Leg leg{{20, 20, 25}, {150, 60, 30}};
  const auto pieces = [&](double radius) {
    return internal::query::link_parts(link, scene.data().origin, leg, radius, 1e-9).size();
  };
  EXPECT_EQ(pieces(0), 0U);
  EXPECT_GT(pieces(15), 0U);
  EXPECT_LT(pieces(15), 200U);
}

TEST(FlightLinks, AreReadAndWritten) {
  const std::string scene = "target: {point: [0, 0, 5]}\nsensor: {max_range: 100}\n";
  const MissionFile file = read_mission_text(
      scene +
          "links:\n  - {name: pilot, point: [1, 2, 0], vlos: {aircraft_size: 0.35, kind: multirotor, visibility: 5000, "
          "eye_height: 1.7}}\n  - {at: [48, 11], height: 12, max_range: 2 km, frequency: 2.4}\n",
      "m.yaml", SceneSource());
  ASSERT_EQ(file.links.size(), 2U);
  EXPECT_NEAR(*file.links[0].max_range_m, 327 * 0.35 + 20, 1e-9);
  EXPECT_EQ(file.links[1].name, "link 2");
  EXPECT_EQ(file.links[1].max_range_m, 2000);
  EXPECT_EQ(file.links[1].radio->clear, 0.6);
  std::string text = mission_text(file, ".");
  const std::size_t section = text.find("links:");
  ASSERT_NE(section, std::string::npos);
  const MissionFile again = read_mission_text(scene + text.substr(section), "m.yaml", SceneSource());
  EXPECT_EQ(mission_text(again, ".").substr(mission_text(again, ".").find("links:")), text.substr(section));
}

TEST(FlightLinks, ThatAreWrongAreRefused) {
  const auto read = [](const std::string& entry) {
    return read_mission_text("target: {point: [0, 0, 5]}\nsensor: {max_range: 100}\nlinks: " + entry + "\n", "m.yaml",
                             SceneSource());
  };
  for (const auto& [entry, code] : std::vector<std::pair<std::string, ErrorCode>>{
           {"[]", ErrorCode::nothing_given},
           {"[{name: a}]", ErrorCode::missing_key},
           {"[{point: [0, 0, 1], at: [48, 11]}]", ErrorCode::conflicting_keys},
           {"[{point: [0, 0, 1], height: 3}]", ErrorCode::not_applicable},
           {"[{at: [48], height: 3}]", ErrorCode::wrong_type},
           {"[{point: [0, 0, 1], clear: 0.6}]", ErrorCode::missing_key},
           {"[{point: [0, 0, 1], frequency: 1e5}]", ErrorCode::value_out_of_range},
           {"[{point: [0, 0, 1], frequency: 2.4, clear: 2}]", ErrorCode::value_out_of_range},
           {"[{point: [0, 0, 1], max_range: -3}]", ErrorCode::value_out_of_range},
           {"[{point: [0, 0, 1], max_rnage: 3}]", ErrorCode::unknown_key},
           {"[{name: a, point: [0, 0, 1]}, {name: a, point: [0, 0, 2]}]", ErrorCode::conflicting_keys}}) {
    SCOPED_TRACE(entry);
    const std::string& given = entry;
    expect_code([&] { read(given); }, code);
  }
}

}  // namespace
}  // namespace vantage::testing
