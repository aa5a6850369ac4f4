// Radio links in missions, in what files of volumes state, and in a real city.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "support/formats.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

class LinkMission : public ::testing::Test {
 protected:
  LinkMission() {
    write_bytes(folder_ / "field.obj",
                "v -500 -500 0\nv 500 -500 0\nv 0 500 0\nf 1 2 3\n"
                "o wall\nv 40 -30 0\nv 40 30 0\nv 40 30 20\nv 40 -30 20\nf 4 5 6 7\n");
  }

  MissionFile read(const std::string& sensor, const std::string& target = "{point: [0, 0, 10]}",
                   const std::string& rest = "") const {
    return read_mission_text("scene: {mesh: field.obj}\ntarget: " + target + "\nsensor: " + sensor + "\n" + rest,
                             folder_ / "mission.yaml");
  }

  TemporaryDirectory folder_;
};

TEST_F(LinkMission, TheZoneIsHalfOfAWavelengthWide) {
  const MissionFile mission = read("{max_range: 120, link: {frequency: 2.4}}");
  ASSERT_TRUE(mission.sensor.link);
  EXPECT_EQ(mission.sensor.link->frequency_ghz, 2.4);
  EXPECT_EQ(mission.sensor.link->clear, 0.6);
  const Result with = run_mission(resolve_mission(mission));
  const Result without = run_mission(resolve_mission(read("{max_range: 120}")));
  ASSERT_EQ(with.volume.outcome, Outcome::computed) << with.volume.reason;
  EXPECT_LT(measure(with.volume.mesh).volume_m3, measure(without.volume.mesh).volume_m3);
  EXPECT_GT(measure(with.volume.mesh).volume_m3, 0.8 * measure(without.volume.mesh).volume_m3);
}

TEST_F(LinkMission, TextReadsBack) {
  const MissionFile mission = read("{max_range: 120, link: {frequency: 5.8, clear: 0.75}}");
  const MissionFile again = read_mission_text(mission_text(mission, mission.file.parent_path()), mission.file);
  ASSERT_TRUE(again.sensor.link);
  EXPECT_EQ(again.sensor.link->frequency_ghz, 5.8);
  EXPECT_EQ(again.sensor.link->clear, 0.75);
}

TEST_F(LinkMission, OfAPilotWhoFliesByRadioToo) {
  const Mission mission = resolve_mission(read(
      "{vlos: {aircraft_size: 0.35, kind: multirotor, visibility: 5000, eye_height: 1.7}, link: {frequency: 2.4}}"));
  EXPECT_TRUE(mission.sensor.link);
  EXPECT_EQ(run_mission(mission).volume.outcome, Outcome::computed);
}

TEST_F(LinkMission, TheHashTellsLinksApart) {
  const auto hash = [&](const std::string& sensor) { return mission_hash(resolve_mission(read(sensor))); };
  const std::string none = hash("{max_range: 120}"), usual = hash("{max_range: 120, link: {frequency: 2.4}}");
  EXPECT_NE(none, usual);
  const std::string higher = hash("{max_range: 120, link: {frequency: 2.5}}");
  const std::string wider = hash("{max_range: 120, link: {frequency: 2.4, clear: 0.7}}");
  const std::string same = hash("{max_range: 120, link: {frequency: 2.4, clear: 0.6}}");
  EXPECT_NE(usual, higher);
  EXPECT_NE(usual, wider);
  EXPECT_EQ(usual, same);
}

TEST_F(LinkMission, FilesStateTheLink) {
  const Mission mission = resolve_mission(read("{max_range: 120, link: {frequency: 5.8, clear: 0.75}}"));
  const Result result = run_mission(mission);
  for (const std::string& name : testing::in_each_format("a")) {
    SCOPED_TRACE(name);
    write_volume(result.volume, folder_ / name);
    const VolumeFile file = read_volume(folder_ / name);
    ASSERT_TRUE(file.volume.provenance && file.volume.provenance->sensor.link);
    EXPECT_EQ(file.volume.provenance->sensor.link->frequency_ghz, 5.8);
    EXPECT_EQ(file.volume.provenance->sensor.link->clear, 0.75);
    const VerifyReport report = verify_volume(mission.scene(), mission.target, mission.sensor, {}, file.volume.mesh,
                                              verify_options(file, mission));
    EXPECT_EQ(report.over_claimed, 0U) << report.worst_over_cause << ' ' << report.worst_over_depth_m;
  }
}

TEST_F(LinkMission, WrongKeysAreRefused) {
  const auto refuse = [&](const std::string& sensor, ErrorCode code) {
    expect_error([&] { read(sensor); }, code, "mission.yaml:3:");
  };
  refuse("{max_range: 100, link: {clear: 0.6}}", ErrorCode::missing_key);
  refuse("{max_range: 100, link: 2.4}", ErrorCode::wrong_type);
  refuse("{max_range: 100, link: {frequency: 0}}", ErrorCode::value_out_of_range);
  refuse("{max_range: 100, link: {frequency: -2.4}}", ErrorCode::value_out_of_range);
  refuse("{max_range: 100, link: {frequency: 5800}}", ErrorCode::value_out_of_range);
  refuse("{max_range: 100, link: {frequency: 2.4, clear: 0}}", ErrorCode::value_out_of_range);
  refuse("{max_range: 100, link: {frequency: 2.4, clear: 60}}", ErrorCode::value_out_of_range);
  refuse("{max_range: 100, link: {freqency: 2.4}}", ErrorCode::unknown_key);
  expect_error(
      [&] { read("{max_range: 100, link: {frequency: 2.4}}", "{vertices: [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}"); },
      ErrorCode::not_applicable, "mission.yaml:3:");
}

TEST_F(LinkMission, SpheresRefuseIt) {
  const Mission mission =
      resolve_mission(read("{max_range: 100, link: {frequency: 2.4}}", "{point: [0, 0, 10]}", "method: spheres\n"));
  expect_error([&] { run_mission(mission); }, ErrorCode::not_applicable, "mission.yaml:3:");
}

// With VANTAGE_HEAVY_POINTS=200000 it looks more closely.
TEST(HeavyLink, InARealCityNothingIsClaimedWrongly) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  const Scene city = read_scene(shared_data("charlotte/uptownCharlotte.obj"), {.up = UpAxis::y});
  const PreparedScene prepared(city);
  const Box bounds = prepared.statistics().bounds;
  const Vec3 middle = 0.5 * (bounds.min + bounds.max);
  const char* const more = std::getenv("VANTAGE_HEAVY_POINTS");
  const std::size_t points = more ? std::strtoull(more, nullptr, 10) : 6000;
  Random random(1);
  for (int round = 0; round < 6; ++round) {
    Sensor sensor{.max_range_m = random.uniform(150, 600)};
    sensor.link = RadioLink{std::exp(random.uniform(-1, 3)), random.uniform(0.4, 1)};
    const Vec3 place = middle + Vec3(random.uniform(-200, 200), random.uniform(-200, 200), 0);
    const Target antenna = Target::point({place.x(), place.y(), bounds.min.z() + random.uniform(20, 120)});
    SCOPED_TRACE(::testing::Message() << "round " << round << ", " << sensor.link->frequency_ghz << " GHz");
    const PreparedTarget target(prepared, antenna, sensor);
    const Volume volume = compute_visibility(target, {.tolerance_m = 0.05});
    if (volume.outcome != Outcome::computed) continue;
    const VerifyReport report = verify_volume(city, antenna, sensor, {}, volume.mesh,
                                              {.points = points, .tolerance_m = 0.05, .lift_m = volume.lift_m});
    EXPECT_TRUE(report.is_right()) << report.over_claimed << ": " << report.worst_over_cause << ' '
                                   << report.worst_over_depth_m << " at " << report.worst_over_point.transpose();
    EXPECT_LE(report.under_claimed, points / 500) << report.worst_under_depth_m;
  }
}

}  // namespace
}  // namespace vantage::testing
