// Limits of the sensor in mission files, hashes and volume files.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/mission_parser.h"
#include "app/sensor_section.h"
#include "support/formats.h"
#include "support/internals.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using app::parse_mission;

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr const char* kLine = "/data/mission.yaml:3:";  // of the section in question

std::string with_sensor(const std::string& sensor) {
  return "scene: {mesh: city.obj}\ntarget: {vertices: [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]}\nsensor: " +
         sensor + "\n";
}

MissionFile parse(const std::string& sensor) { return parse_mission(with_sensor(sensor), "/data/mission.yaml"); }

TEST(SensorMission, ReadsEveryKey) {
  const Sensor sensor = parse(
                            "{max_range: 300, min_range: 20, camera: {model: sony_a7r_iv_35mm}, incidence: 60,"
                            " gimbal: {pitch: [-90, 30], roll: 5}, pixel: {size: 0.02}, sun: {azimuth: 90, elevation:"
                            " 30, exclude: 20}}")
                            .sensor;
  EXPECT_EQ(sensor.max_range_m, 300);
  EXPECT_EQ(sensor.min_range_m, 20);
  EXPECT_EQ(sensor.incidence_deg, 60);
  ASSERT_TRUE(sensor.camera);
  EXPECT_EQ(sensor.camera->half_width, pinhole_of(find_camera("sony_a7r_iv_35mm")).half_width);
  EXPECT_FALSE(sensor.mount.yaw_deg);
  EXPECT_EQ(sensor.mount.min_pitch_deg, -90);
  EXPECT_EQ(sensor.mount.max_pitch_deg, 30);
  EXPECT_EQ(sensor.mount.roll_deg, 5);
  ASSERT_TRUE(sensor.pixel);
  EXPECT_EQ(sensor.pixel->size_m, 0.02);
  EXPECT_EQ(sensor.pixel->kind, PixelLimit::Kind::worst);
  ASSERT_TRUE(sensor.sun);
  EXPECT_NEAR((sensor.sun->direction - Vec3(std::cos(30 * kRadiansPerDegree), 0, 0.5)).norm(), 0, 1e-12);
  EXPECT_EQ(sensor.sun->exclude_deg, 20);
  EXPECT_FALSE(sensor.visible);

  const Sensor share = parse("{max_range: 300, visible: 0.75}").sensor;
  ASSERT_TRUE(share.visible);
  EXPECT_EQ(share.visible->share, 0.75);
  EXPECT_EQ(share.visible->cells, 16u);
  const Sensor fine = parse("{max_range: 300, visible: 1, cells: 64}").sensor;
  EXPECT_EQ(fine.visible->cells, 64u);
}

TEST(SensorMission, CamerasByNumbersAndMountsThatAreFixed) {
  const Sensor numbers =
      parse(
          "{camera: {width: 8000, height: 6000, focal_length: 24.5, sensor_width: 35.9}, dori: identification, mount: "
          "{yaw: any, pitch: -90}}")
          .sensor;
  ASSERT_TRUE(numbers.camera && numbers.camera->focal_px && numbers.pixel);
  EXPECT_NEAR(*numbers.camera->focal_px, 8000 * 24.5 / 35.9, 1e-6);
  EXPECT_EQ(numbers.pixel->size_m, 1.0 / 250);
  EXPECT_EQ(numbers.pixel->kind, PixelLimit::Kind::perpendicular);
  EXPECT_FALSE(numbers.mount.yaw_deg);
  EXPECT_EQ(numbers.mount.min_pitch_deg, -90);
  EXPECT_EQ(numbers.mount.max_pitch_deg, -90);
  EXPECT_TRUE(std::isinf(numbers.max_range_m));

  // Of two focal lengths in pixels the smaller counts.
  const Sensor angles =
      parse("{fov: [60, 40], camera: {width: 4000, height: 2000}, pixel: {size: 0.02, kind: worst}}").sensor;
  ASSERT_TRUE(angles.camera && angles.camera->focal_px);
  EXPECT_NEAR(*angles.camera->focal_px, 1000 / std::tan(20 * kRadiansPerDegree), 1e-6);

  const Sensor fixed = parse("{max_range: 50, fov: [60, 40], mount: {yaw: 120, pitch: -30, roll: -10}}").sensor;
  EXPECT_TRUE(fixed.mount.is_fixed());
  EXPECT_EQ(fixed.mount.yaw_deg, 120);
  EXPECT_EQ(fixed.mount.roll_deg, -10);
  const Sensor on_gimbal = parse("{max_range: 50, fov: [60, 40], mount: gimbal}").sensor;
  EXPECT_FALSE(on_gimbal.mount.yaw_deg);
}

TEST(SensorMission, TheGimbalOfAKnownCameraIsItsLimit) {
  const auto pitches = [](const std::string& words) {
    const MissionFile read = parse("{max_range: 60, " + words + "}");
    EXPECT_EQ(parse_mission(mission_text(read, "/data"), "/data/mission.yaml").sensor, read.sensor) << words;
    return std::array{read.sensor.mount.min_pitch_deg, read.sensor.mount.max_pitch_deg};
  };
  using Pitches = std::array<double, 2>;
  const std::string mavic = "camera: {model: dji_mavic_3e_wide}";
  EXPECT_EQ(pitches(mavic), (Pitches{-90, 35}));
  EXPECT_EQ(pitches(mavic + ", mount: gimbal"), (Pitches{-90, 35}));
  EXPECT_EQ(pitches(mavic + ", gimbal: {yaw: 20, roll: 3}"), (Pitches{-90, 35}));
  EXPECT_EQ(pitches(mavic + ", gimbal: {pitch: [-90, 90]}"), (Pitches{-90, 90})) << "its own words";
  EXPECT_EQ(pitches(mavic + ", mount: {yaw: any, pitch: 50}"), (Pitches{50, 50}));
  EXPECT_EQ(pitches("camera: {model: dji_zenmuse_p1_35mm}"), (Pitches{-90, 30})) << "from -120: past straight down";
  EXPECT_EQ(pitches("camera: {model: sony_a7r_iv_35mm}"), (Pitches{-90, 90})) << "nobody knows";
  EXPECT_EQ(pitches("fov: [60, 40]"), (Pitches{-90, 90}));
}

TEST(SensorMission, TextReadsBackAsTheSame) {
  for (const char* const sensor : {"{max_range: 300, min_range: 20, camera: {model: sony_a7r_iv_35mm}, incidence: 60}",
                                   "{fov: [60, 40], camera: {width: 4000, height: 3000}, pixel: {size: 0.02, kind: "
                                   "worst}, gimbal: {pitch: [-90, 30]}}",
                                   "{camera: {width: 8000, height: 6000, focal_length: 24.5, sensor_width: 35.9}, "
                                   "dori: recognition, mount: {pitch: "
                                   "-90, yaw: any}, sun: {time: 2026-06-21T16:00Z, exclude: 20}}",
                                   "{max_range: 10, fov: [60, 40], gimbal: {yaw: 20, pitch: [-45, 0], roll: 3}}",
                                   "{max_range: 10, fov: [60, 40], mount: {yaw: 20, pitch: -45, roll: 3}, sun: "
                                   "{azimuth: 0, elevation: 90, exclude: 5}}",
                                   "{max_range: 10, visible: 0.8}", "{max_range: 10, visible: 0.05, cells: 1024}"}) {
    const MissionFile read = parse(sensor);
    const std::string text = mission_text(read, "/data");
    const MissionFile again = parse_mission(text, "/data/mission.yaml");
    EXPECT_EQ(mission_text(again, "/data"), text);
    EXPECT_EQ(again.sensor.camera.has_value(), read.sensor.camera.has_value());
    if (read.sensor.camera) {
      EXPECT_EQ(again.sensor.camera->half_width, read.sensor.camera->half_width) << text;
      EXPECT_EQ(again.sensor.camera->focal_px, read.sensor.camera->focal_px) << text;
    }
    EXPECT_EQ(again.sensor.mount.yaw_deg, read.sensor.mount.yaw_deg) << text;
    EXPECT_EQ(again.sensor.mount.min_pitch_deg, read.sensor.mount.min_pitch_deg) << text;
    EXPECT_EQ(again.sensor.mount.roll_deg, read.sensor.mount.roll_deg) << text;
    EXPECT_EQ(range_limit_m(again.sensor), range_limit_m(read.sensor)) << text;
    EXPECT_EQ(again.sun_time.has_value(), read.sun_time.has_value()) << text;
    ASSERT_EQ(again.sensor.visible.has_value(), read.sensor.visible.has_value()) << text;
    if (read.sensor.visible) {
      EXPECT_EQ(again.sensor.visible->share, read.sensor.visible->share) << text;
      EXPECT_EQ(again.sensor.visible->cells, read.sensor.visible->cells) << text;
    }
  }
}

TEST(SensorMission, TimesWithAZone) {
  const auto seconds = [](const char* text) {
    const auto time = app::parse_time(text);
    return time ? time->unix_time_s : NAN;
  };
  EXPECT_EQ(seconds("1970-01-01T00:00Z"), 0);
  EXPECT_EQ(seconds("2026-06-21T16:00Z"), 1782057600);
  EXPECT_EQ(seconds("2026-06-21T18:00+02:00"), 1782057600);
  EXPECT_EQ(seconds("2026-06-21 10:30:30-0530"), 1782057600 + 30);
  for (const char* const wrong :
       {"2026-06-21T16:00", "2026-02-30T16:00Z", "2026-06-21T24:00Z", "2026-06-21", "", "noon", "2026-06-21T16:00Z "}) {
    EXPECT_FALSE(app::parse_time(wrong)) << wrong;
  }
}

TEST(SensorMission, RefusesWhatContradictsItself) {
  struct Case {
    const char* sensor;
    ErrorCode code;
  };
  for (const auto& [sensor, code] : {
           Case{"{min_range: 5}", ErrorCode::missing_key},
           Case{"{max_range: 20, min_range: 30}", ErrorCode::limits_empty},
           Case{"{max_range: 20, incidence: 90}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, camera: {model: nikon}}", ErrorCode::unknown_choice},
           Case{"{max_range: 20, camera: {model: sony_a7r_iv_35mm, width: 100}}", ErrorCode::conflicting_keys},
           Case{"{max_range: 20, camera: {model: sony_a7r_iv_35mm}, fov: [60, 40]}", ErrorCode::conflicting_keys},
           Case{"{max_range: 20, camera: {width: 100, height: 90, focal_length: 5, sensor_width: 4}, fov: [60, 40]}",
                ErrorCode::conflicting_keys},
           Case{"{max_range: 20, camera: {width: 100, height: 90}}", ErrorCode::missing_key},
           Case{"{max_range: 20, camera: {width: 0.5, height: 90, focal_length: 5, sensor_width: 4}}",
                ErrorCode::value_out_of_range},
           Case{"{max_range: 20, camera: {widht: 100}}", ErrorCode::unknown_key},
           Case{"{max_range: 20, fov: [60]}", ErrorCode::wrong_type},
           Case{"{max_range: 20, fov: [60, 190]}", ErrorCode::camera_invalid},
           Case{"{max_range: 20, gimbal: {pitch: [-90, 0]}}", ErrorCode::missing_key},
           Case{"{max_range: 20, fov: [60, 40], gimbal: {pitch: [0, -90]}}", ErrorCode::limits_reversed},
           Case{"{max_range: 20, fov: [60, 40], gimbal: {pitch: [-90, 0]}, mount: gimbal}",
                ErrorCode::conflicting_keys},
           Case{"{max_range: 20, fov: [60, 40], mount: wing}", ErrorCode::unknown_choice},
           Case{"{max_range: 20, fov: [60, 40], mount: {pitch: -90}}", ErrorCode::missing_key},
           Case{"{max_range: 20, fov: [60, 40], mount: {yaw: 0, pitch: -91}}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, fov: [60, 40], pixel: {size: 0.1}}", ErrorCode::missing_key},
           Case{"{max_range: 20, camera: {model: sony_a7r_iv_35mm}, pixel: {size: 0}}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, camera: {model: sony_a7r_iv_35mm}, pixel: {size: 1, kind: best}}",
                ErrorCode::unknown_choice},
           Case{"{camera: {model: sony_a7r_iv_35mm}, pixel: {size: 1}, dori: detection}", ErrorCode::conflicting_keys},
           Case{"{camera: {model: sony_a7r_iv_35mm}, dori: inspection}", ErrorCode::unknown_choice},
           Case{"{max_range: 20, sun: {time: 2026-06-21T16:00, exclude: 5}}", ErrorCode::value_syntax},
           Case{"{max_range: 20, sun: {time: 2026-06-21T16:00Z}}", ErrorCode::missing_key},
           Case{"{max_range: 20, sun: {azimuth: 5, exclude: 5}}", ErrorCode::missing_key},
           Case{"{max_range: 20, sun: {azimuth: 5, elevation: -1, exclude: 5}}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, sun: {azimuth: 5, elevation: 1, exclude: 0}}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, sun: {time: 2026-06-21T16:00Z, azimuth: 5, exclude: 5}}", ErrorCode::conflicting_keys},
           Case{"{max_range: 20, cells: 16}", ErrorCode::missing_key},
           Case{"{max_range: 20, visible: 0}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, visible: 80}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, visible: most}", ErrorCode::not_a_number},
           Case{"{max_range: 20, visible: 0.8, cells: 2.5}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, visible: 0.8, cells: 0}", ErrorCode::value_out_of_range},
           Case{"{max_range: 20, visible: 0.8, cells: 1025}", ErrorCode::value_out_of_range},
       }) {
    SCOPED_TRACE(sensor);
    const Error error = testing::expect_error([&, text = sensor] { parse(text); }, code);
    EXPECT_EQ(error.where().rfind(kLine, 0), 0u) << error.where();
  }
}

Scene yard() { return testing::SceneBuilder().ground("ground", 60).box("shed", {14, 4, 0}, {18, 9, 5}); }

Mission mission_with(const std::string& sensor) {
  Mission mission;
  mission.as_written = parse(sensor);
  mission.loaded = std::make_shared<const LoadedScene>(LoadedScene{yard(), {}, {}});
  mission.target = mission.as_written.targets[0].target;
  mission.sensor = mission.as_written.sensor;
  return mission;
}

TEST(SensorMission, EveryLimitChangesTheHash) {
  std::vector<std::string> hashes;
  for (const char* const sensor :
       {"{max_range: 40}", "{max_range: 40, min_range: 5}", "{max_range: 40, min_range: 6}",
        "{max_range: 40, incidence: 50}", "{max_range: 40, fov: [60, 40]}", "{max_range: 40, fov: [60, 41]}",
        "{max_range: 40, fov: [60, 40], gimbal: {pitch: [-90, 0]}}",
        "{max_range: 40, fov: [60, 40], mount: {yaw: 0, pitch: 0}}",
        "{max_range: 40, camera: {model: sony_a7r_iv_35mm}, pixel: {size: 0.01}}",
        "{max_range: 40, camera: {model: sony_a7r_iv_35mm}, pixel: {size: 0.01, kind: perpendicular}}",
        "{max_range: 40, sun: {azimuth: 0, elevation: 20, exclude: 5}}",
        "{max_range: 40, sun: {azimuth: 1, elevation: 20, exclude: 5}}", "{max_range: 40, visible: 0.8}",
        "{max_range: 40, visible: 0.9}", "{max_range: 40, visible: 0.8, cells: 17}"}) {
    hashes.push_back(mission_hash(mission_with(sensor)));
    for (std::size_t i = 0; i + 1 < hashes.size(); ++i) EXPECT_NE(hashes[i], hashes.back()) << sensor;
  }
}

TEST(SensorMission, LimitsTravelInTheFile) {
  const Mission mission = mission_with(
      "{max_range: 40, min_range: 5, incidence: 70, fov: [80, 60], camera: {width: 400, height: 300}, gimbal: {pitch: "
      "[-80, 10], roll: 2}, pixel: {size: 0.5}, sun: {azimuth: 200, elevation: 20, exclude: 5}}");
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  const testing::TemporaryDirectory folder;
  for (const std::string& name : testing::in_each_format("v")) {
    SCOPED_TRACE(name);
    write_volume(result.volume, folder / name);
    const VolumeFile read = read_volume(folder / name);
    ASSERT_TRUE(read.volume.provenance);
    const Sensor &sensor = read.volume.provenance->sensor, &given = mission.sensor;
    EXPECT_EQ(sensor.max_range_m, given.max_range_m);
    EXPECT_EQ(sensor.min_range_m, given.min_range_m);
    EXPECT_EQ(sensor.incidence_deg, given.incidence_deg);
    ASSERT_TRUE(sensor.camera && sensor.pixel && sensor.sun);
    EXPECT_EQ(sensor.camera->half_width, given.camera->half_width);
    EXPECT_EQ(sensor.camera->half_height, given.camera->half_height);
    EXPECT_EQ(sensor.camera->focal_px, given.camera->focal_px);
    EXPECT_EQ(sensor.mount.yaw_deg, given.mount.yaw_deg);
    EXPECT_EQ(sensor.mount.min_pitch_deg, given.mount.min_pitch_deg);
    EXPECT_EQ(sensor.mount.max_pitch_deg, given.mount.max_pitch_deg);
    EXPECT_EQ(sensor.mount.roll_deg, given.mount.roll_deg);
    EXPECT_EQ(sensor.pixel->size_m, given.pixel->size_m);
    EXPECT_EQ(sensor.pixel->kind, given.pixel->kind);
    EXPECT_EQ(sensor.sun->direction, given.sun->direction);
    EXPECT_EQ(sensor.sun->exclude_deg, given.sun->exclude_deg);
  }
}

TEST(SensorMission, AShareTravelsInTheFile) {
  const Mission mission = mission_with("{max_range: 40, visible: 0.6, cells: 12}");
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  const testing::TemporaryDirectory folder;
  for (const std::string& name : testing::in_each_format("v")) {
    SCOPED_TRACE(name);
    write_volume(result.volume, folder / name);
    const VolumeFile read = read_volume(folder / name);
    ASSERT_TRUE(read.volume.provenance && read.volume.provenance->sensor.visible);
    EXPECT_EQ(read.volume.provenance->sensor.visible->share, 0.6);
    EXPECT_EQ(read.volume.provenance->sensor.visible->cells, 12u);
    const VerifyReport report = verify_volume(mission.scene(), mission.target, read.volume.provenance->sensor, {},
                                              read.volume.mesh, verify_options(read, mission));
    EXPECT_TRUE(report.is_right()) << report.worst_over_cause;
  }
  // More is seen than of the whole target.
  const Volume whole = run_mission(mission_with("{max_range: 40}")).volume;
  EXPECT_GT(measure(result.volume.mesh).volume_m3, measure(whole.mesh).volume_m3);
}

TEST(SensorMission, AShareIsOfAreasAndByTheExactMethod) {
  const std::string point = "scene: {mesh: city.obj}\ntarget: {point: [0, 0, 3]}\n";
  testing::expect_error([&] { parse_mission(point + "sensor: {max_range: 20, visible: 0.5}\n", "/data/mission.yaml"); },
                        ErrorCode::not_applicable, kLine);
  Mission mission = mission_with("{max_range: 30, visible: 0.5}");
  mission.as_written.method = Method::spheres;
  testing::expect_error([&] { run_mission(mission); }, ErrorCode::not_applicable, kLine);
}

TEST(SensorMission, TheSpheresMethodHasThemToo) {
  Mission mission = mission_with("{max_range: 30, incidence: 50}");
  mission.as_written.method = Method::spheres;
  mission.as_written.spheres.cubemap = 40;
  const Volume volume = run_mission(mission).volume;
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  bool is_there = false;
  for (const Cause& cause : volume.causes)
    is_there = is_there || (cause.kind == CauseKind::sensor && cause.name == "incidence");
  EXPECT_TRUE(is_there);
}

}  // namespace
}  // namespace vantage
