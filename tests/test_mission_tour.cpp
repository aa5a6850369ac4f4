// The section `tour` of a mission file.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr const char* kPlain =
    "scene: {mesh: city.obj}\ntarget: {vertices: [[0, 0, 0], [4, 0, 0], [0, 4, 0]]}\nsensor: {max_range: 50}\n";

/// Of a text without `scene`.
MissionFile with_tour(const std::string& tour) {
  const std::string plain(kPlain);
  return read_mission_text(plain.substr(plain.find('\n') + 1) + tour, "mission.yaml", SceneSource{});
}

struct TourRefusal {
  ErrorCode code;
  std::string where;
};

TourRefusal tour_refusal(const std::string& tour) {
  try {
    with_tour(tour);
  } catch (const Error& error) {
    return {error.code(), error.where()};
  }
  ADD_FAILURE() << "was not refused: " << tour;
  return {};
}

TEST(MissionTour, IsReadAndWritten) {
  const MissionFile mission = with_tour(
      "tour:\n  vehicle: {kind: fixed_wing, speed: 18, turn_radius: 130 ft, climb: [-15, 20]}\n"
      "  home: [48.137, 11.575]\n  closed: false\n  view: {dwell: 3, margin: 0.5, simultaneous: true}\n"
      "  gimbal: {rate: 45}\n  clearance: 6\n  tube: 2\n  gap: 0.02\n  time_limit: 30\n");
  ASSERT_TRUE(mission.tour);
  const TourSettings& tour = *mission.tour;
  EXPECT_EQ(tour.vehicle.kind, TourVehicle::Kind::fixed_wing);
  EXPECT_EQ(tour.vehicle.speed_m_s, 18);
  EXPECT_NEAR(tour.vehicle.turn_radius_m, 39.624, 1e-12);
  EXPECT_EQ(tour.vehicle.min_climb_deg, -15);
  EXPECT_EQ(tour.vehicle.max_climb_deg, 20);
  EXPECT_EQ(tour.home->at_deg, (std::array{48.137, 11.575}));
  EXPECT_FALSE(tour.closed);
  EXPECT_EQ(tour.dwell_s, 3);
  EXPECT_EQ(tour.margin_m, 0.5);
  EXPECT_TRUE(tour.simultaneous);
  EXPECT_EQ(tour.gimbal_rate_deg_s, 45);
  EXPECT_EQ(tour.clearance_m, 6);
  EXPECT_EQ(tour.tube_m, 2);
  EXPECT_EQ(tour.gap, 0.02);
  EXPECT_EQ(tour.time_limit_s, 30);
  const std::string text = mission_text(mission, ".");
  const std::string section = text.substr(text.find("tour:\n"));
  EXPECT_EQ(mission_text(with_tour(section), "."), text);
}

TEST(MissionTour, OfAMultirotorFromAPoint) {
  const MissionFile mission =
      with_tour("tour: {vehicle: {kind: multirotor, speed: 8, acceleration: 2}, home: [1, 2, 3.5]}\n");
  EXPECT_EQ(*mission.tour->home->position, Vec3(1, 2, 3.5));
  EXPECT_EQ(mission.tour->dwell_s, TourSettings{}.dwell_s);
  EXPECT_GT(mission.tour->dwell_s, 0);
  EXPECT_EQ(mission.tour->tube_m, 1);
  EXPECT_FALSE(mission.tour->gap);
  const std::string text = mission_text(mission, ".");
  EXPECT_EQ(mission_text(with_tour(text.substr(text.find("tour:\n"))), "."), text);
}

TEST(MissionTour, IsNotWrittenWithoutOne) {
  EXPECT_FALSE(with_tour("").tour);
  EXPECT_EQ(mission_text(with_tour(""), ".").find("tour"), std::string::npos);
}

TEST(MissionTour, RefusesWhatIsWrong) {
  const struct {
    const char* tour;
    ErrorCode code;
    const char* where;
  } cases[] = {
      {"tour: {vehicel: {}}\n", ErrorCode::unknown_key, ":3:8"},
      {"tour: {vehicle: {speed: 3}}\n", ErrorCode::missing_key, ":3:17"},
      {"tour: {vehicle: {kind: balloon}}\n", ErrorCode::unknown_choice, ":3:24"},
      {"tour: {vehicle: {kind: multirotor, turn_radius: 4}}\n", ErrorCode::not_applicable, ""},
      {"tour: {vehicle: {kind: fixed_wing, acceleration: 4}}\n", ErrorCode::not_applicable, ""},
      {"tour: {vehicle: {kind: multirotor, speed: 0}}\n", ErrorCode::value_out_of_range, "tour.vehicle.speed"},
      {"tour: {vehicle: {kind: fixed_wing, climb: [5, 20]}}\n", ErrorCode::value_out_of_range, "climb[0]"},
      {"tour: {vehicle: {kind: fixed_wing, climb: [-20, 90]}}\n", ErrorCode::value_out_of_range, "climb[1]"},
      {"tour: {vehicle: {kind: fixed_wing, climb: [-20]}}\n", ErrorCode::wrong_type, ""},
      {"tour: {home: [1]}\n", ErrorCode::wrong_type, ""},
      {"tour: {home: here}\n", ErrorCode::wrong_type, ""},
      {"tour: {closed: maybe}\n", ErrorCode::unknown_choice, ""},
      {"tour: {view: {dwell: -1}}\n", ErrorCode::value_out_of_range, "tour.view.dwell"},
      {"tour: {view: {margin: .nan}}\n", ErrorCode::value_out_of_range, ""},
      {"tour: {gimbal: {rate: 0}}\n", ErrorCode::value_out_of_range, "tour.gimbal.rate"},
      {"tour: {clearance: -1}\n", ErrorCode::value_out_of_range, "tour.clearance"},
      {"tour: {tube: -1}\n", ErrorCode::value_out_of_range, "tour.tube"},
      {"tour: {gap: 1}\n", ErrorCode::value_out_of_range, "tour.gap"},
      {"tour: {time_limit: 0}\n", ErrorCode::value_out_of_range, "tour.time_limit"},
  };
  for (const auto& [tour, code, where] : cases) {
    SCOPED_TRACE(tour);
    const TourRefusal found = tour_refusal(tour);
    EXPECT_EQ(found.code, code);
    EXPECT_NE(found.where.find("mission.yaml:"), std::string::npos);
    EXPECT_NE(found.where.find(where), std::string::npos) << found.where;
  }
}

/// Of a mission in a map with flat ground.
Mission touring_in_a_map(const std::string& rest) {
  const TemporaryDirectory folder;
  MapText map({11, 48});
  map.box(30, 0, 40, 10, {{"building", "yes"}});
  std::ofstream(folder.path() / "city.osm") << map.text();
  std::ofstream(folder.path() / "mission.yaml")
      << "scene: {osm: city.osm, center: [48, 11], radius: 200}\nsensor: {max_range: 80}\n"
      << "target: {center: [48, 11], width: 2, length: 2}\n"
      << rest;
  return resolve_mission(read_mission(folder.path() / "mission.yaml"));
}

TEST(MissionTour, ItsHomeLiesOnTheGround) {
  const Mission mission = touring_in_a_map("tour: {home: [48.0005, 11]}\n");
  ASSERT_TRUE(mission.home);
  const Eigen::Vector2d expected = scene_position(*mission.scene().georeference, 11, 48.0005);
  EXPECT_EQ(*mission.home, Vec3(expected.x(), expected.y(), 0));
  EXPECT_GT(expected.y(), 50);
  EXPECT_EQ(*touring_in_a_map("tour: {home: [1, 2, 30]}\n").home, Vec3(1, 2, 30));
  EXPECT_FALSE(touring_in_a_map("tour: {gap: 0.1}\n").home);
}

TEST(MissionTour, ItsHomeIsInTheSystemOfTheMission) {
  const Mission mission = touring_in_a_map("crs: EPSG:4326\ntour: {home: [11, 48.0005, 30]}\n");
  const Eigen::Vector2d expected = scene_position(*mission.scene().georeference, 11, 48.0005);
  EXPECT_NEAR((*mission.home - Vec3(expected.x(), expected.y(), 30)).norm(), 0, 1e-6);
}

TEST(MissionTour, ItsHomeNeedsAPlaceOnTheEarth) {
  const TemporaryDirectory folder;
  std::ofstream(folder.path() / "city.obj") << "v 9 9 0\nv 9 8 0\nv 9 9 1\nf 1 2 3\n";
  std::ofstream(folder.path() / "mission.yaml") << kPlain << "tour: {home: [48, 11]}\n";
  try {
    resolve_mission(read_mission(folder.path() / "mission.yaml"));
    FAIL() << "was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_georeferenced);
    EXPECT_NE(error.where().find("mission.yaml:4:"), std::string::npos) << error.where();
  }
}

}  // namespace
}  // namespace vantage::testing
