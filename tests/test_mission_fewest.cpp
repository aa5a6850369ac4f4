// Flights of missions that hover at as few positions as possible.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "support/flight_cases.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/mission_tour.h"
#include "vantage/solid.h"

namespace vantage::testing {
namespace {

Target square(double x, double y) {
  return target_of({{x - 2, y - 2, 0}, {x + 2, y - 2, 0}, {x + 2, y + 2, 0}, {x - 2, y + 2, 0}});
}

/// Squares on the ground, each seen from up to 25 m: two in the west, two in the east.
Mission four_squares(SceneBuilder builder = {}) {
  builder.ground("ground", 200, -0.5);
  Scene scene = builder;
  scene.objects.back().kind = ObjectKind::ground;
  Mission mission = mission_in(std::move(scene), square(-36, 0), 25);
  for (const double x : {-36, 30, -24, 42}) {
    mission.views.push_back({square(x, 0)});
    mission.views.back()[0].name = "at " + std::to_string(static_cast<int>(x));
  }
  mission.as_written.combine = Combine::each;
  mission.as_written.tour = TourSettings();
  return mission;
}

MissionTour fewest(const Mission& mission, const Progress& progress = {}, bool with_bound = true) {
  MissionTourOptions options;
  options.fewest_positions = true;
  options.with_bound = with_bound;
  return plan_mission_tour(mission, options, progress);
}

/// Where it hovers: no two stops of one position.
std::size_t stops_of(const MissionTour& tour) {
  std::set<std::tuple<double, double, double>> stops;
  for (const TourVisit& visit : tour.tour.visits) {
    const Vec3& at = tour.tour.flight.points[visit.first_point].position;
    stops.insert({at.x(), at.y(), at.z()});
  }
  return stops.size();
}

void judge(const Mission& mission, const MissionTour& tour) {
  ASSERT_TRUE(tour.fewest);
  EXPECT_EQ(stops_of(tour), tour.fewest->positions.size());
  for (const TourVisit& visit : tour.tour.visits) {
    const std::vector<Vec3> at = {tour.tour.flight.points[visit.first_point].position};
    EXPECT_GE(SolidIndex(tour.targets[visit.target].volume).depths_m(at)[0], tour.settings.margin_m);
  }
  for (const HoverPosition& one : tour.fewest->positions) {
    for (const std::size_t target : one.sees) {
      const FlightCase judged(one_volume(mission, target));
      EXPECT_TRUE(judged.ask({one.position})[0].inside);
    }
  }
  EXPECT_TRUE(!tour.is_complete() || check_flight(mission, tour.tour.flight).passes());
}

TEST(MissionFewest, HoversWhereSeveralTargetsAreSeen) {
  const Mission mission = four_squares();
  const MissionTour tour = fewest(mission);
  ASSERT_TRUE(tour.is_complete());
  judge(mission, tour);
  ASSERT_EQ(tour.fewest->positions.size(), 2U);
  EXPECT_EQ(tour.fewest->positions[0].assigned, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(tour.fewest->positions[1].assigned, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(tour.fewest->necessary, 2U);
  EXPECT_EQ(tour.fewest->apart.size(), 2U);
  EXPECT_FALSE(tour.bound) << "no flight of as many stops is compared with it";
  std::multiset<std::string> photos;
  const FlightOut plan = plan_of_tour(tour, mission);
  ASSERT_EQ(plan.actions.size(), plan.flight.points.size());
  double hold_s = 0;
  for (std::size_t i = 0; i < plan.actions.size(); ++i) {
    hold_s += plan.flight.points[i].hold_s;
    if (!plan.actions[i].photo) continue;
    photos.insert(plan.actions[i].sees);
    EXPECT_GE(plan.flight.points[i].hold_s, tour.settings.dwell_s - 1e-9);
  }
  EXPECT_EQ(photos, (std::multiset<std::string>{"at -24", "at -36", "at 30", "at 42"})) << "each with its own aim";
  double planned_s = 0;
  for (const FlightPoint& point : tour.tour.flight.points) planned_s += point.hold_s;
  EXPECT_NEAR(hold_s, planned_s, 1e-9);
  const auto json = nlohmann::json::parse(json_text(tour));
  EXPECT_EQ(json["positions"]["necessary"], 2);
  EXPECT_EQ(json["positions"]["found"][1]["assigned"][1], "at 42");
  EXPECT_TRUE(json["bound"].is_null());
  EXPECT_EQ(fewest(mission, {}, false).fewest->necessary, 1U) << "nobody asked for more";
}

TEST(MissionFewest, AVolumeIsATargetToo) {
  Mission mission = four_squares();
  auto region = std::make_shared<TargetVolume>();
  region->mesh = make_box_mesh({20, -6, 8}, {44, 6, 18});
  Target given;
  given.parts.clear();
  given.volume = region;
  given.name = "region";
  mission.views.push_back({given});
  const MissionTour tour = fewest(mission);
  ASSERT_TRUE(tour.is_complete());
  EXPECT_EQ(tour.fewest->positions.size(), 2U);
  EXPECT_EQ(tour.fewest->necessary, 2U);
  EXPECT_EQ(tour.fewest->positions[1].assigned, (std::vector<std::size_t>{1, 3, 4}));
}

TEST(MissionFewest, WhatCannotBeVisitedIsLeftOut) {
  // Between walls, higher than the range and 8 m apart: 5 m from both is nowhere.
  Mission mission = four_squares(
      SceneBuilder().box("north wall", {-60, 64, -0.5}, {60, 66, 40}).box("south wall", {-60, 54, -0.5}, {60, 56, 40}));
  mission.views.push_back({square(0, 60)});
  mission.views.back()[0].name = "lane";
  const MissionTour tour = fewest(mission);
  ASSERT_EQ(tour.tour.problems.size(), 1U);
  EXPECT_EQ(tour.tour.problems[0].target, 4U);
  EXPECT_EQ(tour.tour.problems[0].kind, TourProblem::Kind::no_place);
  EXPECT_EQ(tour.fewest->unseen, std::vector<std::size_t>{4});
  EXPECT_EQ(tour.fewest->positions.size(), 2U);
  judge(mission, tour);
  mission.as_written.tour->clearance_m = 2;
  const MissionTour nearer = fewest(mission);
  EXPECT_TRUE(nearer.is_complete());
  EXPECT_EQ(nearer.fewest->positions.size(), 3U);
  EXPECT_EQ(nearer.fewest->necessary, 3U);
}

TEST(MissionFewest, FliesToTheBestSoFarWhenStopped) {
  const Mission mission = four_squares();
  for (const std::string_view last : {"outer meshes", "fewer positions"}) {
    bool is_stopped = false;
    const MissionTour tour = fewest(mission, [&](std::string_view stage, double) {
      is_stopped = is_stopped || stage == last;
      return !is_stopped;
    });
    EXPECT_EQ(tour.fewest->end, FewestPositions::End::cancelled);
    EXPECT_TRUE(tour.is_complete());
    judge(mission, tour);
  }
}

TEST(MissionFewest, WhatMakesNoSenseIsRefused) {
  const Mission mission = four_squares();
  MissionTourOptions options;
  options.fewest_positions = true;
  options.certificate = "tour.cert";
  expect_error([&] { plan_mission_tour(mission, options); }, ErrorCode::conflicting_keys, "tour.cert");
  options.certificate.clear();
  options.positions = {Vec3(0, 0, 10)};
  expect_error([&] { plan_mission_tour(mission, options); }, ErrorCode::conflicting_keys, "positions");
  Mission wing = mission;
  wing.as_written.tour->vehicle.kind = TourVehicle::Kind::fixed_wing;
  expect_error([&] { fewest(wing); }, ErrorCode::not_applicable, "tour.vehicle.kind");
  Mission deep = mission;
  deep.as_written.tour->margin_m = 40;
  expect_code([&] { fewest(deep); }, ErrorCode::limits_empty, "at -36");
}

}  // namespace
}  // namespace vantage::testing
