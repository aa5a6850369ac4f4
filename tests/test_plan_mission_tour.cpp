// Tours of missions: what is planned and written keeps what is asked, as the judge of plans sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "flight/tour/mission_limits.h"
#include "support/places.h"
#include "support/plaza_text.h"
#include "support/random.h"
#include "support/run_program.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/dubins.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/mission_tour.h"
#include "vantage/standpoints.h"

namespace vantage::testing {
namespace {

using Json = nlohmann::json;

class PlanMissionTour : public ::testing::Test {
 protected:
  PlanMissionTour() { write_bytes(folder_ / "plaza.obj", plaza_obj()); }

  Mission mission(const std::string& tour, const std::string& more = "") const {
    return of_text(plaza_mission(tour, more));
  }
  Mission of_two_targets(const std::string& tour) const;
  Mission of_text(const std::string& text) const {
    write_bytes(folder_ / "mission.yaml", text);
    MissionFile file = read_mission(folder_ / "mission.yaml");
    file.combine = Combine::each;
    return resolve_mission(file);
  }

  TemporaryDirectory folder_;
};

/// The plan as a table, read back and judged.
FlightCheck judged(const MissionTour& tour, const Mission& mission) {
  const std::string table = flight_plan_bytes(plan_of_tour(tour, mission), PlanFormat::csv);
  const LocatedPlan located = locate_flight(parse_flight_plan(table, "tour.csv"), {});
  FlightCheckOptions options;
  options.speed_m_s = tour.settings.vehicle.speed_m_s;
  options.clearance_m = tour.settings.clearance_m;
  options.dwell_s = tour.settings.dwell_s - 1e-3;  // which the clock of the plan may round
  options.tube_radius_m = tour.settings.tube_m;
  return check_flight(mission, located.flight, options);
}

/// Written in each format, the flight keeps what is asked.
void expect_all_formats_pass(const MissionTour& tour, const Mission& mission) {
  for (const PlanFormat format : {PlanFormat::qgroundcontrol, PlanFormat::waypoints, PlanFormat::kml, PlanFormat::wpml,
                                  PlanFormat::gpx, PlanFormat::geojson, PlanFormat::csv}) {
    SCOPED_TRACE(name_of(format));
    FlightOut plan = plan_of_tour(tour, mission);
    plan.georeference = Georeference{48, 11, "EGM96 geoid", ""};
    plan.levels.undulation_m = 45;
    plan.aircraft = DjiAircraft{77, 0, 66};
    plan.heights = HeightDatum::home;
    if (format == PlanFormat::kml || format == PlanFormat::gpx || format == PlanFormat::geojson) plan.heights.reset();
    LocateOptions options;
    options.georeference = plan.georeference;
    options.levels = plan.levels;
    options.home_z_m = tour.home->z();
    const LocatedPlan located = locate_flight(parse_flight_plan(flight_plan_bytes(plan, format), "tour"), options);
    const FlightCheck check = check_flight(mission, located.flight, {.tube_radius_m = tour.settings.tube_m});
    EXPECT_TRUE(check.passes()) << (check.failures.empty() ? "" : check.failures.front());
  }
}

void expect_passes(const FlightCheck& check) {
  EXPECT_TRUE(check.passes()) << (check.failures.empty() ? "" : check.failures.front());
}

/// One photo for each view, from where the target is seen, straight at its centre; the flight stays what it is.
void expect_photos(const MissionTour& tour, const Mission& mission) {
  const FlightOut plan = plan_of_tour(tour, mission);
  ASSERT_EQ(plan.actions.size(), plan.flight.points.size());
  const FlightCheck check = check_flight(mission, plan.flight, {.speed_m_s = 5});
  double length_m = 0, hold_s = 0, planned_s = 0;
  for (std::size_t i = 0; i < tour.tour.flight.leg_count(); ++i) {
    length_m += (tour.tour.flight.leg(i).to - tour.tour.flight.leg(i).from).norm();
  }
  EXPECT_NEAR(check.length_m, length_m, 1e-9 * length_m);
  for (const FlightPoint& point : plan.flight.points) hold_s += point.hold_s;
  for (const FlightPoint& point : tour.tour.flight.points) planned_s += point.hold_s;
  if (!tour.settings.simultaneous) {
    EXPECT_NEAR(hold_s, planned_s, 1e-9);
  }
  std::map<std::string, int> photos;
  for (std::size_t i = 0; i < plan.actions.size(); ++i) {
    const FlightAction& action = plan.actions[i];
    if (!action.photo) continue;
    ++photos[action.sees];
    const auto target = std::find_if(check.targets.begin(), check.targets.end(),
                                     [&](const TargetCheck& one) { return one.name == action.sees; });
    ASSERT_NE(target, check.targets.end()) << action.sees;
    const Vec3 to = target->centre - plan.flight.points[i].position;
    ASSERT_EQ(action.look_at.has_value(), plan.vehicle == PlanVehicle::fixed_wing) << "its nose cannot be turned";
    if (action.look_at) {
      EXPECT_LT((*action.look_at - target->centre).norm(), 1e-9);
      EXPECT_FALSE(action.yaw_deg || action.gimbal_pitch_deg);
    } else {
      EXPECT_NEAR(std::sin((*action.yaw_deg) * std::numbers::pi / 180), to.x() / to.head<2>().norm(), 1e-9);
      EXPECT_NEAR(std::cos((*action.yaw_deg) * std::numbers::pi / 180), to.y() / to.head<2>().norm(), 1e-9);
      EXPECT_NEAR(*action.gimbal_pitch_deg, std::atan2(to.z(), to.head<2>().norm()) * 180 / std::numbers::pi, 1e-9);
    }
    const double at_m = check.point_at_m[i];
    EXPECT_TRUE(
        std::any_of(target->seen.begin(), target->seen.end(),
                    [&](const FlightSpan& span) { return span.begin_m - 1e-9 <= at_m && at_m <= span.end_m + 1e-9; }))
        << action.sees << " is not seen at " << at_m;
  }
  EXPECT_EQ(photos.size(), tour.tour.visits.size());
  for (const auto& [name, count] : photos) EXPECT_EQ(count, 1) << name;
}

TEST_F(PlanMissionTour, SharesOfTargetsAreRefused) {
  const std::string text = plaza_mission("gap: 0.9");
  const std::string sensor = "sensor: {max_range: 60, visible: 0.5}\nexact: {tolerance: 0.5}\n";
  std::string of_share = text;
  of_share.replace(of_share.find(kPlazaSensor), std::string(kPlazaSensor).size(), sensor);
  expect_code([&] { plan_mission_tour(of_text(of_share), {.with_bound = false}); }, ErrorCode::not_applicable);
}

/// Two targets that are seen from one position far from both.
Mission PlanMissionTour::of_two_targets(const std::string& tour) const {
  return of_text(std::string(kPlazaScene) +
                 "sensor: {max_range: 160}\ntargets:\n"
                 "  - {name: west, vertices: [[-83, -3, 0.1], [-77, -3, 0.1], [-77, 3, 0.1], [-83, 3, 0.1]]}\n"
                 "  - {name: south, vertices: [[-3, -83, 0.1], [3, -83, 0.1], [3, -77, 0.1], [-3, -77, 0.1]]}\n"
                 "tour: {home: [-20, -20, 0], gap: 0.9, time_limit: 2, " +
                 tour + "}\n");
}

MissionTour from_one_position(const Mission& mission) {
  return plan_mission_tour(mission, {.with_bound = false, .positions = std::vector<Vec3>(2, {-30, -30, 80})});
}

TEST_F(PlanMissionTour, PhotosOfViewsFromOnePlaceLookAtEachTarget) {
  const Mission mission = of_two_targets("view: {dwell: 3, margin: 0}");
  const MissionTour tour = from_one_position(mission);
  ASSERT_EQ(tour.tour.visits.size(), 2U);
  expect_photos(tour, mission);
}

TEST_F(PlanMissionTour, PhotosFromOnePlaceLeaveTimeToTurn) {
  const Mission mission = of_two_targets("view: {dwell: 1, margin: 0, simultaneous: true}, gimbal: {rate: 5}");
  const MissionTour tour = from_one_position(mission);
  expect_photos(tour, mission);
  const FlightOut plan = plan_of_tour(tour, mission);
  std::vector<std::size_t> photos;
  for (std::size_t i = 0; i < plan.actions.size(); ++i) {
    if (plan.actions[i].photo) photos.push_back(i);
  }
  ASSERT_EQ(photos.size(), 2U);
  const auto direction = [&](std::size_t i) {
    const double yaw = *plan.actions[i].yaw_deg * std::numbers::pi / 180;
    const double pitch = *plan.actions[i].gimbal_pitch_deg * std::numbers::pi / 180;
    return Vec3(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch));
  };
  const double turn_deg = std::acos(direction(photos[0]).dot(direction(photos[1]))) * 180 / std::numbers::pi;
  EXPECT_GT(turn_deg, 30);
  EXPECT_GE(plan.flight.points[photos[1]].hold_s, turn_deg / 5 - 1e-9);
}

TEST_F(PlanMissionTour, OfAMultirotorKeepsWhatIsAsked) {
  const Mission of = mission("home: [-20, -20, 0], clearance: 4, gap: 0.3", "navigation: {altitude: [0, 100]}\n");
  const MissionTour tour = plan_mission_tour(of);
  EXPECT_TRUE(tour.is_complete());
  EXPECT_EQ(tour.tour.order.size(), 3U);
  EXPECT_EQ(tour.home, Vec3(-20, -20, 0));
  const Vec3 start = tour.tour.flight.points.front().position;
  EXPECT_EQ(start.head<2>(), Eigen::Vector2d(-20, -20));
  EXPECT_EQ(start.z(), 1.5) << "the lowest step of 0.5 m that is a metre above the ground";
  EXPECT_EQ(tour.tour.flight.points.back().position, start);
  const FlightCheck check = judged(tour, of);
  expect_passes(check);
  expect_photos(tour, of);
  EXPECT_GE(check.nearest.distance_m, 4);
  EXPECT_NEAR(check.length_m, tour.tour.length_m, 1e-4);
  expect_all_formats_pass(tour, of);

  ASSERT_TRUE(tour.bound);
  EXPECT_GT(tour.bound->length_m, 0);
  EXPECT_LE(tour.bound->length_m, tour.tour.length_m);
  EXPECT_NEAR(tour.bound->gap, 1 - tour.bound->length_m / tour.tour.length_m, 1e-12);
  EXPECT_TRUE(tour.reaches_gap());
  EXPECT_FALSE(tour.bound->ignored.empty());
}

TEST_F(PlanMissionTour, ClimbsNoHigherAtTakeoffThanItsLimitsAllow) {
  const Mission of = mission("home: [-20, -20, 0], clearance: 4", "navigation: {altitude: [3, 12.5]}\n");
  const MissionTour tour = plan_mission_tour(of, {.with_bound = false});
  EXPECT_NEAR(tour.highest_takeoff_m.value(), 11.47, 0.011);  // less the tube, and two centimetres for rounding
  expect_all_formats_pass(tour, of);
  // The way to an orbit is not planned, and the climb at its beginning keeps the limits of height.
  Orbit orbit;
  orbit.centre = Vec3(0, 0, 10);
  orbit.radius_m = 20;
  EXPECT_NEAR(plan_of_orbit(orbit, of, PlanFormat::csv).highest_takeoff_m.value(), 12.499, 1e-9);
  const Mission high = mission("home: [-20, -20, 0]", "navigation: {altitude: {agl: [3, 60]}, ground: ground}\n");
  EXPECT_EQ(plan_of_orbit(orbit, high, PlanFormat::csv).highest_takeoff_m, 20);
}

TEST_F(PlanMissionTour, OfAFixedWingKeepsWhatIsAsked) {
  const Mission of = mission(
      "vehicle: {kind: fixed_wing, speed: 12, turn_radius: 15}, home: [-20, -20, 0], clearance: 4, "
      "view: {dwell: 1}",
      "navigation: {altitude: [0, 100]}\n");
  const MissionTour tour = plan_mission_tour(of, {.with_bound = false});
  EXPECT_TRUE(tour.is_complete());
  EXPECT_FALSE(tour.bound);
  expect_passes(judged(tour, of));
  expect_photos(tour, of);
  EXPECT_NEAR(tour.tour.time_s, tour.tour.length_m / 12, 1e-9);
}

TEST_F(PlanMissionTour, KeepsWhatIsAskedInATubeAboutTheFlight) {
  const std::string zones = "navigation: {altitude: [6, 60], keep_out: [{min: [-60, -60, 0], max: [-40, -20, 60]}]}\n";
  for (const auto& [tube, radius_m] :
       {std::pair("", 1.0), std::pair(", tube: 2.5", 2.5), std::pair(", tube: 0", 0.0)}) {
    const Mission of = mission(std::string("home: [-20, -20, 0], clearance: 4") + tube, zones);
    SCOPED_TRACE(tube);
    const MissionTour tour = plan_mission_tour(of, {.with_bound = false});
    EXPECT_TRUE(tour.is_complete());
    const Flight flight = plan_of_tour(tour, of).flight;
    expect_passes(check_flight(of, flight, {.tube_radius_m = radius_m}));
    if (radius_m > 0) continue;
    EXPECT_FALSE(check_flight(of, flight, {.tube_radius_m = 1}).passes()) << "it touches what it may touch";
  }
}

TEST_F(PlanMissionTour, KeepsWhatIsAskedInATubeWithACameraThatTurns) {
  for (const std::string sensor : {"camera: {model: dji_mavic_3e_wide}", "fov: [40, 30]", "fov: [10, 8]",
                                   "fov: [60, 40], gimbal: {pitch: [-70, -20]}"}) {
    SCOPED_TRACE(sensor);
    const Mission of = of_text(std::string(kPlazaScene) + "sensor: {max_range: 120, " + sensor + "}\n" +
                               "target: {vertices: [[-43, -3, 0.1], [-37, -3, 0.1], [-37, 3, 0.1], [-43, 3, 0.1]]}\n" +
                               "navigation: {altitude: [2, 110]}\ntour: {home: [-40, 0, 0], clearance: 4}\n");
    const MissionTour tour = plan_mission_tour(of, {.with_bound = false});
    EXPECT_TRUE(tour.is_complete());
    const Flight flight = plan_of_tour(tour, of).flight;
    expect_passes(check_flight(of, flight, {.tube_radius_m = 1}));
    EXPECT_FALSE(check_flight(of, flight, {.tube_radius_m = 3}).passes()) << "it is no deeper than it has to be";
  }
}

TEST_F(PlanMissionTour, SaysWhereItCannotKeepTheTube) {
  const auto says = [](const MissionTour& tour) {
    return std::any_of(tour.notes.begin(), tour.notes.end(),
                       [](const std::string& note) { return note.find("tour.tube") != std::string::npos; });
  };
  // A band that is 1.5 m high, and two zones that are apart.
  const std::string band = "navigation: {altitude: [30, 31.5]}\n";
  const std::string apart =
      "navigation: {keep_in: [{min: [-150, -150, 0], max: [20, 150, 100]}, {min: [80, -150, 0], max: [150, 150, "
      "100]}]}\n";
  const Mission flat = mission("home: [-20, -20, 0], clearance: 4", band);
  expect_code([&] { plan_mission_tour(flat); }, ErrorCode::limits_empty, "mission.yaml:9:");
  const Mission thin = mission("home: [-20, -20, 0], clearance: 4, tube: 0.5, view: {margin: 0.5}", band);
  EXPECT_TRUE(plan_mission_tour(thin, {.with_bound = false}).is_complete());
  EXPECT_TRUE(says(plan_mission_tour(mission("home: [-20, -20, 0]", apart), {.with_bound = false})));
  EXPECT_FALSE(says(plan_mission_tour(mission("home: [-20, -20, 0], tube: 0", apart), {.with_bound = false})));
}

/// A square high on the tower's west side, seen from below.
std::string seen_from_below(const std::string& sensor) {
  return std::string(kPlazaScene) +
         "target: {vertices: [[59.9, -3, 36], [59.9, -3, 42], [59.9, 3, 42], [59.9, 3, 36]]}\n"
         "sensor: {max_range: 60, " +
         sensor + "}\nexact: {tolerance: 0.5}\nnavigation: {altitude: [2, 12]}\n" +
         "tour: {home: [50, 0, 0], clearance: 4}\n";
}

TEST_F(PlanMissionTour, AsksOfNoKnownGimbalForWhatItDoesNotReach) {
  const auto asked = [&](const std::string& sensor) {
    const Mission of = of_text(seen_from_below(sensor));
    const MissionTour tour = plan_mission_tour(of, {.with_bound = false});
    EXPECT_TRUE(tour.is_complete());
    expect_passes(check_flight(of, plan_of_tour(tour, of).flight, {.tube_radius_m = 1}));
    double highest_deg = -90;
    for (const FlightAction& action : plan_of_tour(tour, of).actions) {
      highest_deg = std::max(highest_deg, action.gimbal_pitch_deg.value_or(-90));
    }
    return std::pair(highest_deg, tour.notes);
  };
  const auto [known_deg, notes] = asked("camera: {model: dji_mavic_3e_wide}");
  EXPECT_LE(known_deg, 35 + 1e-9);
  EXPECT_EQ(notes, std::vector<std::string>());
  // By its own words, and where nobody knows: the pitch is told.
  const auto [own_deg, own_notes] = asked("camera: {model: dji_mavic_3e_wide}, gimbal: {pitch: [-90, 90]}");
  EXPECT_GT(own_deg, 36);
  ASSERT_EQ(own_notes.size(), 1U);
  EXPECT_NE(own_notes[0].find("dji_mavic_3e_wide takes -90 to 35"), std::string::npos) << own_notes[0];
  const std::vector<std::string> unknown = asked("camera: {model: sony_a7r_iv_35mm}").second;
  ASSERT_EQ(unknown.size(), 1U);
  EXPECT_NE(unknown[0].find("not known"), std::string::npos) << unknown[0];
  EXPECT_EQ(asked("camera: {model: sony_a7r_iv_35mm}, gimbal: {pitch: [-90, 70]}").second.size(), 0U);
}

TEST_F(PlanMissionTour, WithoutAHomeAndOneTarget) {
  const Mission of = of_text(std::string(kPlazaScene) + kPlazaSensor +
                             "target: {vertices: [[-83, -3, 0.1], [-77, -3, 0.1], [-77, 3, 0.1], [-83, 3, 0.1]]}\n");
  const MissionTour tour = plan_mission_tour(of);
  EXPECT_FALSE(tour.home);
  EXPECT_EQ(tour.tour.length_m, 0) << "it hovers";
  ASSERT_TRUE(tour.bound);
  EXPECT_EQ(tour.bound->length_m, 0);
  expect_passes(judged(tour, of));
  expect_photos(tour, of);
}

TEST_F(PlanMissionTour, ItsCertificateIsAccepted) {
  const Mission of = mission("home: [-20, -20, 0], gap: 0.3");
  const std::filesystem::path file = folder_ / "tour of 3.cert";
  const MissionTour tour = plan_mission_tour(of, {.certificate = file});
  const ProgramRun run =
      run_program("/usr/bin/env", {"python3", (source_folder() / "tools/check_tour.py").string(), file.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Json::parse(read_bytes(file))["bound_m"], tour.bound->length_m);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "tour_of_3.region2.ply"));
}

TEST_F(PlanMissionTour, ItsCertificateReplacesNothingOfOthers) {
  const Mission of = mission("gap: 0.3");
  const auto plan = [&] { plan_mission_tour(of, {.certificate = folder_ / "tour.cert"}); };
  write_bytes(folder_ / "tour.region1.ply", "ply\nof somebody\n");
  expect_error(plan, ErrorCode::output_of_others, "tour.region1.ply");
  EXPECT_EQ(read_bytes(folder_ / "tour.region1.ply"), "ply\nof somebody\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "tour.region0.ply"));
  std::filesystem::remove(folder_ / "tour.region1.ply");
  write_bytes(folder_ / "tour.cert", "of somebody");
  expect_code(plan, ErrorCode::output_of_others, "tour.cert");
  EXPECT_EQ(read_bytes(folder_ / "tour.cert"), "of somebody");
  std::filesystem::remove(folder_ / "tour.cert");
  plan();
  plan();  // its own files it may replace
  expect_error([&] { plan_mission_tour(of, {.certificate = folder_ / "plaza.obj"}); },
               ErrorCode::output_overwrites_input, "plaza.obj");
}

TEST_F(PlanMissionTour, ItsJsonSaysAllOfIt) {
  const Mission of = mission("home: [-20, -20, 0], gap: 0.3");
  const MissionTour tour = plan_mission_tour(of);
  const Json answer = Json::parse(json_text(tour));
  EXPECT_EQ(answer["vehicle"], "multirotor");
  EXPECT_EQ(answer["length_m"], tour.tour.length_m);
  EXPECT_EQ(answer["time_s"], tour.tour.time_s);
  EXPECT_EQ(answer["bound"]["length_m"], tour.bound->length_m);
  EXPECT_EQ(answer["bound"]["gap"], tour.bound->gap);
  EXPECT_EQ(answer["bound"]["time_s"], tour.bound->time_s);
  EXPECT_EQ(tour.bound->time_s, std::max(tour.bound->length_m / 8, 3 * 2.0));
  EXPECT_LE(tour.bound->time_s, tour.tour.time_s);
  EXPECT_EQ(answer["bound"]["kind"], tour.bound->kind);
  const double start_z = tour.tour.flight.points.front().position.z();
  EXPECT_GT(start_z, 0);
  EXPECT_EQ(answer["bound"]["start_above_home_m"], start_z - tour.home->z());
  EXPECT_EQ(answer["bound"]["ignored"].size(), tour.bound->ignored.size());
  ASSERT_EQ(answer["visits"].size(), 3U);
  for (const Json& visit : answer["visits"]) {
    EXPECT_GE(visit["dwell_s"], 2);
    EXPECT_LE(visit["begin_m"], visit["end_m"]);
    EXPECT_EQ(visit["from"].size(), 3U);
  }
  EXPECT_EQ(answer["left_out"], Json::array());
  EXPECT_EQ(answer["points"].size(), tour.tour.flight.points.size());
}

TEST_F(PlanMissionTour, WhatCannotBeReachedIsLeftOut) {
  const std::string apart =
      "navigation: {keep_in: [{min: [-150, -150, 0], max: [20, 150, 100]}, "
      "{min: [80, -150, 0], max: [150, 150, 100]}]}\n";
  const Mission of = mission("home: [-20, -20, 0], gap: 0.3", apart);
  const MissionTour tour = plan_mission_tour(of);
  EXPECT_FALSE(tour.is_complete());
  ASSERT_EQ(tour.tour.problems.size(), 1U);
  EXPECT_EQ(tour.targets[tour.tour.problems[0].target].name, "east");
  EXPECT_EQ(tour.tour.order.size(), 2U);
  ASSERT_TRUE(tour.bound);
  EXPECT_LE(tour.bound->length_m, tour.tour.length_m);
  EXPECT_EQ(Json::parse(json_text(tour))["left_out"][0]["target"], "east");
}

TEST_F(PlanMissionTour, EndsAtTheTimeLimitWithTheBestSoFar) {
  const Mission of = mission("home: [-20, -20, 0], gap: 0, time_limit: 0.2");
  const MissionTour tour = plan_mission_tour(of);
  EXPECT_EQ(tour.tour.order.size(), 3U);
  ASSERT_TRUE(tour.bound);
  EXPECT_FALSE(tour.reaches_gap());
  expect_passes(judged(tour, of));
  expect_photos(tour, of);
}

TEST_F(PlanMissionTour, SaysWhatCannotBeSeenOrFlown) {
  const auto expect = [&](const std::string& tour, const std::string& more, ErrorCode code, const std::string& where) {
    SCOPED_TRACE(tour + more);
    const Mission of = mission(tour, more);
    expect_error([&] { plan_mission_tour(of); }, code, where);
  };
  const std::string far = "navigation: {keep_in: [{min: [-150, 100, 0], max: [150, 150, 100]}]}\n";
  const std::string narrow =
      "navigation: {keep_in: [{polygon: [[-100, -110], [110, 100], [80, 130], [-130, -80]], "
      "heights: any}]}\n";
  const std::string wing = "vehicle: {kind: fixed_wing, turn_radius: 40}";
  expect("gap: 0.3", far, ErrorCode::nothing_given, "mission.yaml:3:");
  expect("view: {margin: 40}", "", ErrorCode::limits_empty, "west");
  expect("vehicle: {kind: fixed_wing, speed: 60, turn_radius: 150}, view: {dwell: 10}", "", ErrorCode::limits_empty,
         "west");
  expect(wing, narrow, ErrorCode::limits_empty, "mission.yaml:9:");
  expect("home: [0, 70, 8]", "", ErrorCode::viewpoint_inside_solid, "object 'hall'");
  expect("home: [0, -42, 0]", "", ErrorCode::viewpoint_inside_solid, "object 'kiosk'");
  expect("home: [-20, -20, 0]", far, ErrorCode::limits_empty, "mission.yaml:9:");
  expect("home: [-20, -20, -3]", "", ErrorCode::viewpoint_inside_solid, "mission.yaml:8:");
}

TEST_F(PlanMissionTour, AHomeUnderARoofIsRefused) {
  // Four posts' worth of nothing, and a roof over the home: it is in no solid.
  write_bytes(folder_ / "plaza.obj", plaza_obj() +
                                         "o roof\nv -30 -30 12\nv -10 -30 12\nv -10 -10 12\nv -30 -10 12\n"
                                         "f 29 30 31 32\n");
  const Mission of = mission("home: [-20, -20, 0]", "navigation: {altitude: [15, 100]}\n");
  expect_error([&] { plan_mission_tour(of); }, ErrorCode::viewpoint_inside_solid, "mission.yaml:9:");
}

TEST_F(PlanMissionTour, AHomeUnderAZoneToStayOutOfIsRefused) {
  const std::string home = "home: [-20, -20, 0]";
  const auto with = [](const std::string& zone) {
    return "navigation: {altitude: [12, 100], keep_out: [" + zone + "]}\n";
  };
  for (const std::string zone : {"{min: [-22, -22, 0.5], max: [-18, -18, 10]}",
                                 "{polygon: [[-22, -22], [-18, -22], [-18, -18], [-22, -18]], z: [2, 3]}"}) {
    const Mission of = mission(home, with(zone));
    expect_error([&] { plan_mission_tour(of); }, ErrorCode::limits_empty, "mission.yaml:9:");
  }
  EXPECT_TRUE(plan_mission_tour(mission(home, with("{min: [-18, -22, 0.5], max: [-15, -18, 10]}"))).is_complete());
}

TEST_F(PlanMissionTour, BeginsInABandAboveTheHomeHoweverNarrowOrHigh) {
  const auto start = [&](const std::string& altitude) {
    const Mission of = mission("home: [-20, -20, 0]", "navigation: {altitude: " + altitude + "}\n");
    const PreparedScene scene(of.scene());
    const auto airspace = make_airspace(scene, 1, of.navigation);
    return internal::flight::tour::start_above(*of.home, of, scene, *airspace, 0).z();
  };
  EXPECT_EQ(start("[12, 100]"), 12);
  EXPECT_NEAR(start("[12.1, 12.4]"), 12.1, 1e-9);
  EXPECT_NEAR(start("[1000.5, 1100]"), 1000.5, 1e-9);
}

TEST(MissionTourLimits, TheWidthOfZonesIsThatOfTheNarrowestStrip) {
  using internal::flight::tour::least_width_m;
  EXPECT_EQ(least_width_m({}), std::numeric_limits<double>::infinity());
  Random random(61);
  for (int i = 0; i < 200; ++i) {
    Navigation navigation;
    Zone zone;
    for (int k = random.integer(3, 9); k > 0; --k) zone.outer.emplace_back(random.uniform(0, 9), random.uniform(0, 4));
    navigation.keep_in.push_back(zone);
    if (random.chance(0.5))
      navigation.keep_in.push_back(Box{{1, 1, 0}, {random.uniform(2, 5), random.uniform(2, 3), 9}});
    std::vector<Eigen::Vector2d> points(zone.outer.begin(), zone.outer.end());
    if (navigation.keep_in.size() > 1)
      points.insert(points.end(), navigation.keep_in[1].outer.begin(), navigation.keep_in[1].outer.end());
    double slow = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3000; ++k) {
      const Eigen::Vector2d across(std::cos(k * std::numbers::pi / 3000), std::sin(k * std::numbers::pi / 3000));
      double low = 1e9, high = -1e9;
      for (const Eigen::Vector2d& point : points) {
        low = std::min(low, across.dot(point));
        high = std::max(high, across.dot(point));
      }
      slow = std::min(slow, high - low);
    }
    const double width = least_width_m(navigation);
    EXPECT_LE(width, slow + 1e-12);
    EXPECT_GE(width, slow - 10 * std::numbers::pi / 3000);
  }
}

/// Allows to be below a height.
class Ceiling : public Airspace {
 public:
  explicit Ceiling(double height_m) : height_m_(height_m) {}
  bool allows(const Leg& leg, double) const override { return std::max(leg.from.z(), leg.to.z()) <= height_m_; }
  std::string obstacle(const Leg& leg, double) const override { return allows(leg, 0) ? "" : "the ceiling"; }
  Box bounds() const override { return {}; }

 private:
  double height_m_;
};

TEST(MissionTourLimits, TheRoomAboveAHomeIsNeverTooLarge) {
  using internal::flight::tour::room_above_m;
  Random random(63);
  for (int i = 0; i < 200; ++i) {
    const Vec3 home = random.point(-30, 30);
    const double least = random.uniform(0, 5), room = least + random.uniform(0, 30);
    const double found = room_above_m(home, home + Vec3(0, 0, least), Ceiling(home.z() + room));
    EXPECT_LE(found, std::min(20.0, room) + 1e-9);
    EXPECT_GE(found, std::min(20.0, room) - 0.02);
  }
}

TEST(MissionTourLimits, OpenFlightsInNarrowZonesSayWhatTheyLack) {
  Mission mission;
  TourSettings settings;
  settings.closed = false;
  settings.vehicle.kind = TourVehicle::Kind::fixed_wing;
  Tour tour;
  tour.order = {0};
  tour.problems = {{TourProblem::Kind::no_way, 1, 0, ""}};
  using internal::flight::tour::note_of_narrow_zones;
  EXPECT_FALSE(note_of_narrow_zones(mission, settings, tour));
  mission.navigation.keep_in = {Box{{0, 0, 0}, {300, 79, 90}}};
  EXPECT_TRUE(note_of_narrow_zones(mission, settings, tour));
  tour.order.clear();
  expect_error([&] { note_of_narrow_zones(mission, settings, tour); }, ErrorCode::limits_empty, "");
  mission.navigation.keep_in = {Box{{0, 0, 0}, {300, 81, 90}}};
  EXPECT_FALSE(note_of_narrow_zones(mission, settings, tour));
  mission.navigation.keep_in = {Box{{0, 0, 0}, {300, 79, 90}}};
  tour.problems.push_back({TourProblem::Kind::no_place, 2, 0, "a tower"});
  EXPECT_FALSE(note_of_narrow_zones(mission, settings, tour)) << "it may be the tower";
  tour.problems.clear();
  EXPECT_FALSE(note_of_narrow_zones(mission, settings, tour));
}

TEST(MissionTourLimits, ClosedFlightsAreAsWideAsACircle) {
  // From a place through some others and back, whatever the headings: never narrower than two radii.
  Random random(62);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1500; ++i) {
    std::vector<PlanePose> poses;
    const double size = random.chance(0.5) ? 0.5 : 4;
    for (int k = random.integer(1, 3); k > 0; --k) {
      poses.push_back({random.uniform(0, size), random.uniform(0, size), random.uniform(0, 7)});
    }
    poses.push_back({poses.front().x_m, poses.front().y_m, random.uniform(0, 7)});
    std::vector<Eigen::Vector2d> points;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
      const DubinsPath path = shortest_dubins(poses[k], poses[k + 1], 1);
      for (int step = 0; step <= 200; ++step) {
        const PlanePose pose = path.at(path.length_m() * step / 200);
        points.emplace_back(pose.x_m, pose.y_m);
      }
    }
    for (int k = 0; k < 60; ++k) {
      const Eigen::Vector2d across(std::cos(k * std::numbers::pi / 60), std::sin(k * std::numbers::pi / 60));
      double low = 1e9, high = -1e9;
      for (const Eigen::Vector2d& point : points) {
        low = std::min(low, across.dot(point));
        high = std::max(high, across.dot(point));
      }
      // A straight that comes back on itself needs a turn; one pose and its like is no flight.
      if (poses.size() > 2 || high > low) least = std::min(least, high - low);
    }
  }
  EXPECT_GE(least, 2 - 1e-2);
  EXPECT_LE(least, 2 + 1e-1);
}

}  // namespace
}  // namespace vantage::testing
