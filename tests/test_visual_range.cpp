// How far a pilot may be from the aircraft, alone and in missions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/sensor.h"

namespace vantage {
namespace {

TEST(VisualRange, TheSmallerDistanceCounts) {
  using Kind = VisualRange::Kind;
  EXPECT_DOUBLE_EQ(visual_range_m({0.35, Kind::multirotor, 5000}), 327 * 0.35 + 20);
  EXPECT_DOUBLE_EQ(visual_range_m({1.5, Kind::fixed_wing, 5000}), 490 * 1.5 + 30);
  EXPECT_DOUBLE_EQ(visual_range_m({8, Kind::fixed_wing, 5000}), 1500);
  EXPECT_DOUBLE_EQ(visual_range_m({0.35, Kind::multirotor, 100}), 30);
}

TEST(VisualRange, NumbersThatMeanNothingAreRefused) {
  for (const double size : {0.0, -1.0, std::nan("")}) {
    testing::expect_code([&] { visual_range_m({size, {}, 5000}); }, ErrorCode::value_out_of_range, "vlos");
  }
  testing::expect_error([&] { visual_range_m({0, {}, 5000}); }, ErrorCode::value_out_of_range, "vlos");
  testing::expect_error([&] { visual_range_m({1, {}, 0}); }, ErrorCode::value_out_of_range, "vlos");
}

class PilotMission : public ::testing::Test {
 protected:
  PilotMission() { testing::write_bytes(folder_ / "field.obj", "v -500 -500 0\nv 500 -500 0\nv 0 500 0\nf 1 2 3\n"); }

  MissionFile read(const std::string& sensor, const std::string& target = "{point: [0, 0, 0.5]}") const {
    return read_mission_text("scene: {mesh: field.obj}\ntarget: " + target + "\nsensor: " + sensor + "\n",
                             folder_ / "mission.yaml");
  }

  testing::TemporaryDirectory folder_;
};

TEST_F(PilotMission, TheVolumeIsABallOverTheFieldAboutTheEyes) {
  const Mission mission =
      resolve_mission(read("{vlos: {aircraft_size: 0.35, kind: multirotor, visibility: 5000, eye_height: 1.7}}"));
  const double range = 327 * 0.35 + 20, eyes = 0.5 + 1.7;
  EXPECT_DOUBLE_EQ(mission.sensor.max_range_m, range);
  EXPECT_DOUBLE_EQ(mission.target.parts[0][0].z(), eyes);
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  // The ball without the cap under the field.
  const double cap = range - eyes, pi = std::numbers::pi;
  const double expected = 4 * pi / 3 * std::pow(range, 3) - pi * cap * cap * (3 * range - cap) / 3;
  EXPECT_NEAR(measure(result.volume.mesh).volume_m3 / expected, 1, 1e-3);
}

TEST_F(PilotMission, TextReadsBack) {
  const MissionFile mission = read("{vlos: {aircraft_size: 1.5, kind: fixed_wing, visibility: 4000, eye_height: 2}}");
  const MissionFile again = read_mission_text(mission_text(mission, mission.file.parent_path()), mission.file);
  ASSERT_TRUE(again.vlos);
  EXPECT_EQ(again.vlos->range.kind, VisualRange::Kind::fixed_wing);
  EXPECT_EQ(again.vlos->range.aircraft_size_m, 1.5);
  EXPECT_EQ(again.vlos->range.visibility_m, 4000);
  EXPECT_EQ(again.vlos->eye_height_m, 2);
  EXPECT_EQ(again.sensor.max_range_m, mission.sensor.max_range_m);
}

TEST_F(PilotMission, WrongKeysAreRefused) {
  const auto refuse = [&](const std::string& sensor, ErrorCode code) {
    testing::expect_error([&] { read(sensor); }, code, "mission.yaml:3:");
  };
  const std::string good = "aircraft_size: 0.35, kind: multirotor, visibility: 5000";
  refuse("{max_range: 100, vlos: {" + good + "}}", ErrorCode::conflicting_keys);
  refuse("{vlos: {kind: multirotor, visibility: 5000}}", ErrorCode::missing_key);
  refuse("{vlos: {aircraft_size: 0, kind: multirotor, visibility: 5000}}", ErrorCode::value_out_of_range);
  refuse("{vlos: {aircraft_size: 1, kind: balloon, visibility: 5000}}", ErrorCode::unknown_choice);
  refuse("{vlos: {" + good + ", eyes: 2}}", ErrorCode::unknown_key);
  testing::expect_error([&] { read("{vlos: {" + good + "}}", "{vertices: [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}"); },
                        ErrorCode::not_applicable, "mission.yaml:3:");
}

}  // namespace
}  // namespace vantage
