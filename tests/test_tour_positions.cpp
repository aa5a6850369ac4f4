// Tours through positions that are given, and what is written of tours that are known.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/flight_cases.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/mission_tour.h"

namespace vantage::testing {
namespace {

/// Two squares on the ground, 60 m apart, each seen from up to 25 m.
Mission two_squares() {
  SceneBuilder builder;
  builder.ground("ground", 200, -0.5);
  Scene scene = builder;
  scene.objects.front().kind = ObjectKind::ground;
  const auto square = [](double x) {
    return target_of({{x - 2, -2, 0}, {x + 2, -2, 0}, {x + 2, 2, 0}, {x - 2, 2, 0}});
  };
  Mission mission = mission_in(std::move(scene), square(-30), 25);
  mission.views = {{square(-30)}, {square(30)}};
  mission.views[0][0].name = "west";
  mission.views[1][0].name = "east";
  mission.as_written.combine = Combine::each;
  mission.as_written.tour = TourSettings();
  mission.as_written.tour->gap = 0.99;  // the first bound will do
  return mission;
}

MissionTour through(const std::vector<Vec3>& positions) {
  MissionTourOptions options;
  options.positions = positions;
  return plan_mission_tour(two_squares(), options);
}

TEST(TourPositions, AreWhereTargetsAreViewed) {
  const std::vector<Vec3> positions = {{-30, 0, 15}, {35, 3, 12}};
  const MissionTour tour = through(positions);
  ASSERT_TRUE(tour.is_complete());
  ASSERT_EQ(tour.tour.visits.size(), 2U);
  for (const TourVisit& visit : tour.tour.visits) {
    const Vec3& at = tour.tour.flight.points[visit.first_point].position;
    EXPECT_LT((at - positions[visit.target]).norm(), 0.01);
    EXPECT_GE(visit.dwell_s, tour.settings.dwell_s);
  }
  ASSERT_TRUE(tour.bound);
  EXPECT_LE(tour.bound->length_m, tour.tour.length_m);
  EXPECT_EQ(tour.bound->ignored.back(), "the positions that are given");
  FlightCheckOptions options;
  options.gimbal_rate_deg_s = 1000;  // it flies straight over the first square
  EXPECT_TRUE(check_flight(two_squares(), tour.tour.flight, options).passes());
}

TEST(TourPositions, LieInTheVolumesOfTheirTargets) {
  expect_code([] { through({{-30, 0, 15}}); }, ErrorCode::array_sizes_differ, "positions");
  expect_code([] { through({{-30, 0, 15}, {-30, 0, 15}}); }, ErrorCode::value_out_of_range, "positions[1]");
  expect_code([] { through({{-30, 0, 0.005}, {30, 0, 15}}); }, ErrorCode::value_out_of_range, "positions[0]");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_code([&] { through({{-30, 0, nan}, {30, 0, 15}}); }, ErrorCode::coordinate_not_finite);
}

TEST(TourPositions, ItsBoundIsWrittenLater) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "tour.cert", early = folder.path() / "early.cert";
  const Mission mission = two_squares();
  MissionTourOptions options;
  options.certificate = early;
  const MissionTour tour = plan_mission_tour(mission, options);
  write_tour_certificate(tour, file);
  const auto bound_in = [](const std::filesystem::path& path) {
    std::ifstream stream(path);
    return nlohmann::json::parse(stream).at("bound_m").get<double>();
  };
  EXPECT_EQ(bound_in(file), bound_in(early));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "tour.region0.ply"));
  MissionTour without = tour;
  without.bound.reset();
  expect_code([&] { write_tour_certificate(without, file); }, ErrorCode::nothing_given);
  EXPECT_GT(bound_in(file), 0) << "what is there stays";
}

TEST(TourPositions, FormatsStateTheTourAsTheyCan) {
  Mission mission = two_squares();
  mission.home = Vec3(0, -20, -0.5);
  MissionTour tour;
  tour.home = mission.home;
  tour.tour.flight.points = {{Vec3(0, -20, 5)}, {Vec3(0, 20, 5)}};
  expect_code([&] { plan_of_tour(tour, mission, PlanFormat::kml); }, ErrorCode::not_georeferenced, "KML");
  EXPECT_EQ(plan_of_tour(tour, mission, PlanFormat::csv).heights, HeightDatum::scene_z);
  LoadedScene loaded = *mission.loaded;
  loaded.scene.georeference = Georeference{48, 11, "EGM96 geoid", ""};
  mission.loaded = std::make_shared<const LoadedScene>(std::move(loaded));
  EXPECT_EQ(plan_of_tour(tour, mission, PlanFormat::qgroundcontrol).heights, HeightDatum::home);
  for (const PlanFormat format : {PlanFormat::kml, PlanFormat::gpx, PlanFormat::geojson}) {
    EXPECT_FALSE(plan_of_tour(tour, mission, format).heights);
  }
  const FlightOut shown = plan_of_tour(tour, mission, PlanFormat::czml);
  EXPECT_FALSE(shown.heights);
  ASSERT_EQ(shown.targets.size(), 2U);
  EXPECT_EQ(shown.targets[1].name, "east");
  EXPECT_EQ(shown.targets[1].parts, mission.views[1][0].parts);
  EXPECT_TRUE(shown.targets[1].seen_s.empty()) << "the flight passes between them";
}

TEST(TourPositions, CzmlSaysWhenTargetsAreSeen) {
  Mission mission = two_squares();
  LoadedScene loaded = *mission.loaded;
  loaded.scene.georeference = Georeference{48, 11, "EGM96 geoid", ""};
  mission.loaded = std::make_shared<const LoadedScene>(std::move(loaded));
  MissionTour tour;
  tour.tour.flight.points = {{Vec3(-60, 0, 10)}, {Vec3(60, 0, 10), 2}};
  tour.settings.vehicle.speed_m_s = 4;
  const FlightOut shown = plan_of_tour(tour, mission, PlanFormat::czml);
  FlightCheckOptions options;
  options.speed_m_s = 4;
  const FlightCheck check = check_flight(mission, tour.tour.flight, options);
  ASSERT_EQ(shown.targets.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(shown.targets[i].seen_s.size(), 1U);
    EXPECT_EQ(shown.targets[i].seen_s[0][0], check.targets[i].seen[0].begin_s);
    EXPECT_EQ(shown.targets[i].seen_s[0][1], check.targets[i].seen[0].end_s);
  }
  EXPECT_LT(shown.targets[0].seen_s[0][1], shown.targets[1].seen_s[0][0]) << "first the west";
}

}  // namespace
}  // namespace vantage::testing
