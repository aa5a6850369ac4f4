// The mission file: what it means, and what is said when it is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include "app/mission_parser.h"
#include "app/yaml_tree.h"
#include "common/input.h"
#include "support/internals.h"
#include "support/limit_samples.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using app::parse_mission;

constexpr const char* kScene = "scene:\n  mesh: city.obj\n";
constexpr const char* kTarget = "target:\n  vertices: [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]\n";
constexpr const char* kSensor = "sensor:\n  max_range: 100\n";

/// A mission of the four texts; the first three default to right ones.
std::string text_of_mission(const std::string& rest, const std::string& target = kTarget,
                            const std::string& sensor = kSensor, const std::string& scene = kScene) {
  return scene + target + sensor + rest;
}

std::string with_navigation(const std::string& line) { return text_of_mission("navigation:\n  " + line + "\n"); }
std::string with_sensor(const std::string& line) { return text_of_mission("", kTarget, "sensor:\n  " + line + "\n"); }
std::string with_scene(const std::string& line) {
  return text_of_mission("", kTarget, kSensor, "scene:\n  " + line + "\n");
}
std::string with_vertices(const std::string& vertices) {
  return text_of_mission("", "target:\n  vertices: " + vertices + "\n");
}
/// A right target with one more line.
std::string with_target(const std::string& line) {
  return text_of_mission("", std::string(kTarget) + "  " + line + "\n");
}

constexpr const char* kMissionFile = "folder/mission.yaml";

MissionFile parse(const std::string& text) { return parse_mission(text, kMissionFile); }

/// The Error(input) that the text brings; fails the test when there is none.
Error refusal(const std::string& text) {
  return testing::error_of([&] { parse(text); });
}

void expect_refusal(const std::string& text, ErrorCode code, const std::string& where) {
  SCOPED_TRACE(text);
  const Error error = testing::expect_error([&] { parse(text); }, code);
  EXPECT_NE((error.where() + ",").find(kMissionFile + where), std::string::npos)
      << error.where() << " is not " << where << ": " << error.problem();
}

TEST(Mission, ReadsEveryKey) {
  const MissionFile mission = parse_mission(R"(
scene: {mesh: ../city.obj, up: y, scale: 0.5}
target:
  name: "plaza, north"
  vertices: [[0, 0, 1], [10, 0, 1], [0, 10, +1.0e0]]
  edges: [[1, 0], [1, 2], [0, 2]]
  offset: 0.25
  front: [0, 0, -2]
sensor: {max_range: 1.5e2}
navigation:
  altitude: [-20, 120]
  boxes: [{min: [0, 1, 2], max: [3, 4, 5]}, {max: [1, 1, 1], min: [.5, .5, .5]}]
  keep_out: [{min: [6, 7, 8], max: [9, 10, 11]}]
  meshes: [airspace.ply, zone.obj, {mesh: old.OBJ.gz, up: z, scale: 2}]
method: exact
exact: {tolerance: 0.02}
)",
                                            "/data/missions/plaza.yaml");
  const fs::path folder = "/data/missions";
  EXPECT_EQ(mission.file, folder / "plaza.yaml");
  EXPECT_EQ(mission.scene.file, folder / "../city.obj") << "missions may be a symbolic link";
  EXPECT_EQ(mission.scene.mesh.up, UpAxis::y);
  EXPECT_EQ(mission.scene.mesh.scale, 0.5);
  EXPECT_EQ(mission.targets[0].target.name, "plaza, north");
  ASSERT_EQ(mission.targets[0].target.parts[0].size(), 3U);
  EXPECT_EQ(mission.targets[0].target.parts[0][2], Vec3(0, 10, 1));
  EXPECT_EQ(mission.targets[0].target.offset_m, 0.25);
  ASSERT_TRUE(mission.targets[0].target.front.has_value());
  EXPECT_EQ(*mission.targets[0].target.front, Vec3(0, 0, -2));
  EXPECT_EQ(mission.places.target, folder / "plaza.yaml:5:13");
  EXPECT_EQ(mission.sensor.max_range_m, 150);
  ASSERT_TRUE(mission.navigation.altitude.has_value());
  EXPECT_EQ(mission.navigation.altitude->min_m, -20);
  EXPECT_EQ(mission.navigation.altitude->max_m, 120);
  ASSERT_EQ(mission.navigation.keep_in.size(), 2U);
  EXPECT_EQ(mission.navigation.keep_in[0].box().max, Vec3(3, 4, 5));
  EXPECT_EQ(mission.navigation.keep_in[1].box().min, Vec3(.5, .5, .5));
  ASSERT_EQ(mission.navigation.keep_out.size(), 1U);
  EXPECT_EQ(mission.navigation.keep_out[0].box().min, Vec3(6, 7, 8));
  EXPECT_EQ(mission.exact.tolerance_m, 0.02);

  ASSERT_EQ(mission.navigation_meshes.size(), 3U);
  EXPECT_EQ(mission.navigation_meshes[0].file, folder / "airspace.ply");
  EXPECT_EQ(mission.navigation_meshes[0].name, "airspace.ply");
  EXPECT_FALSE(mission.navigation_meshes[0].up || mission.navigation_meshes[0].scale);
  EXPECT_EQ(mission.navigation_meshes[2].up, UpAxis::z);
  EXPECT_EQ(mission.navigation_meshes[2].scale, 2);
  EXPECT_EQ(mission.places.navigation_meshes[0], folder / "plaza.yaml:14:12");
}

TEST(Mission, OfSeveralPolygons) {
  const MissionFile mission = parse(text_of_mission(
      "", "target: {parts: [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[5, 0, 0], [6, 0, 0], [6, 1, 0], [5, 1, 0]]]}\n"));
  ASSERT_EQ(mission.targets[0].target.parts.size(), 2U);
  EXPECT_EQ(mission.targets[0].target.parts[1][2], Vec3(6, 1, 0));
  const Error error =
      refusal(text_of_mission("", "target: {parts: [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 1, 1]]]}\n"));
  EXPECT_NE(error.where().find("mission.yaml:3:"), std::string::npos) << error.what();
  EXPECT_EQ(refusal(text_of_mission("", "target: {parts: []}\n")).kind(), ErrorKind::input);
}

TEST(Mission, SaysWhomPicturesHaveToName) {
  const MissionFile mission = parse(with_scene("mesh: city.obj\n  attribution: \"\u00a9 the city's surveyors\""));
  EXPECT_EQ(mission.scene.attribution, "\u00a9 the city's surveyors");
  EXPECT_EQ(parse(text_of_mission("")).scene.attribution, "");
  EXPECT_EQ(refusal(with_scene("mesh: city.obj\n  attribution: [a, b]")).code(), ErrorCode::wrong_type);
}

TEST(Mission, TheReferenceSystemOfAMapIsThatOfItsTerrain) {
  EXPECT_EQ(parse(with_scene("osm: city.osm\n  terrain: dem.asc\n  crs: EPSG:25832")).scene.city.terrain_crs,
            "EPSG:25832");
  EXPECT_EQ(refusal(with_scene("osm: city.osm\n  crs: EPSG:25832")).code(), ErrorCode::not_applicable);
}

// What is written reads back as the same text: nothing that a mission says is lost.
TEST(Mission, TextReadsBackAsTheSameMission) {
  const std::string scenes[] = {
      "scene: {mesh: ../city.obj, up: y, scale: 0.3048, lod: '2.2', crs: 'EPSG:28992', origin: [52, 4.3]}\n",
      "scene: {mesh: city.obj, attribution: 'The city''s \"surveyors\": \u00a9 2024'}\n",
      "scene: {osm: city.osm.pbf, center: [48.1, 11.5], radius: 600, terrain: dem.tif, error: 0.25,\n"
      "        without: [trees, walls], defaults: {level: 3.25, levels.house: 3, wall.fence: 2, way.path: 1.5}}\n",
      "scene: {osm: 'a \"b\".osm', bbox: [11.1, 48, 11.2, 48.1]}\n",
      "scene: {raster: dsm.tif, center: [48.1, 11.5], radius: 100, error: 0.125, origin: [48.1, 11.5]}\n",
      "scene: {raster: dsm.tif, crs: 'EPSG:2263', z_unit: us-ft, void: -0.5}\n",
      "scene: {osm: city.json, partial: true, terrain: dem.tif, crs: 'EPSG:25832', z_unit: ft, void: 3}\n",
      "scene: {tiles: tileset.json, terrain: dem.tif, z_unit: m, void: 3}\n"};
  const std::string targets[] = {
      "target: {name: \"the 'plaza': north\", vertices: [[0.1, 1e-9, 1], [1e6, 0, 1], [0, 10, 1]], offset: 0.25, "
      "front: "
      "[0, 0, -2]}\n",
      "target: {point: [1, 2, 3]}\n", "target: {center: [48.1, 11.5], width: 5, length: 7.5, heading: 30}\n",
      "target: {parts: [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[5, 0, 0], [6, 0, 0], [6, 1, 0]]]}\n"};
  const std::string rest[] = {
      "sensor: {max_range: 0.1}\n",
      "sensor: {max_range: 0.1}\nnavigation: {altitude: {agl: [30.5, 120], z: [0, 80]}, ground: -2.5}\n",
      "sensor: {max_range: 150}\nnavigation:\n  altitude: [-20, 120]\n  boxes: [{min: [0, 1, 2], max: [3, 4, 5]}]\n"
      "  keep_out: [{min: [6, 7, 8], max: [9, 10, 11]}]\n  meshes: [airspace.ply, {mesh: old.obj, up: y, scale: 2}]\n"
      "method: spheres\nexact: {tolerance: 0.02}\nspheres: {sphere: centers, cubemap: 100, resolution: [160, 80],\n"
      "  merge: 0.001, split: always, max_splits: 3, min_edge: 0.25, device: cpu}\n"};
  for (const std::string& scene : scenes) {
    for (const std::string& target : targets) {
      for (const std::string& more : rest) {
        const std::string given = std::string(scene).append(target).append(more);
        SCOPED_TRACE(given);
        const MissionFile read = parse_mission(given, "/data/missions/one.yaml");
        const std::string text = mission_text(read, "/data/missions");
        const MissionFile again = parse_mission(text, "/data/missions/two.yaml");
        EXPECT_EQ(mission_text(again, "/data/missions"), text);
        EXPECT_EQ(again.scene.file, read.scene.file);
        EXPECT_EQ(again.scene.attribution, read.scene.attribution);
        EXPECT_EQ(again.targets[0].target.parts, read.targets[0].target.parts);
        EXPECT_EQ(again.targets[0].target.name, read.targets[0].target.name);
        EXPECT_EQ(again.sensor.max_range_m, read.sensor.max_range_m);
        testing::expect_same_limits(again.navigation, read.navigation);
        testing::expect_same_limits(again.sensor, read.sensor);
        EXPECT_EQ(again.navigation_meshes.size(), read.navigation_meshes.size());
        EXPECT_EQ(again.scene.city.defaults.levels_of, read.scene.city.defaults.levels_of);
        EXPECT_EQ(again.scene.city.partial, read.scene.city.partial);
        EXPECT_EQ(again.scene.raster.crs, read.scene.raster.crs);
        EXPECT_EQ(again.scene.city.terrain_crs, read.scene.city.terrain_crs);
        for (const auto& [now, before] : {std::pair{again.scene.raster.heights, read.scene.raster.heights},
                                          {again.scene.city.terrain_heights, read.scene.city.terrain_heights},
                                          {again.scene.terrain_options.heights, read.scene.terrain_options.heights}}) {
          EXPECT_EQ(now.unit, before.unit);
          EXPECT_EQ(now.void_m, before.void_m);
        }
        EXPECT_EQ(again.spheres.resolution, read.spheres.resolution);
      }
    }
  }
}

TEST(Mission, HasDefaults) {
  const MissionFile mission = parse(text_of_mission(""));
  EXPECT_EQ(mission.scene.mesh.up, UpAxis::z);
  EXPECT_EQ(mission.scene.mesh.scale, 1.0);
  EXPECT_EQ(mission.targets[0].target.name, "target");
  EXPECT_EQ(mission.targets[0].target.offset_m, 0.0);
  EXPECT_FALSE(mission.targets[0].target.front.has_value());
  EXPECT_TRUE(mission.navigation.empty());
  EXPECT_EQ(mission.exact.tolerance_m, ExactOptions{}.tolerance_m);
  EXPECT_EQ(mission.exact.threads, 0);
  EXPECT_TRUE(mission.file.is_absolute());
  EXPECT_EQ(mission.scene.file, mission.file.parent_path() / "city.obj");
  EXPECT_TRUE(parse(text_of_mission("navigation:\n")).navigation.empty()) << "the heading alone is not a limit";
}

TEST(Mission, AcceptsAByteOrderMarkAndWindowsLineEnds) {
  std::string text = "\xEF\xBB\xBF" + text_of_mission("");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(parse(text).targets[0].target.parts[0].size(), 4U);
}

TEST(Mission, AcceptsEdgesInAnyOrderAndTurn) {
  for (const char* edges : {"[[0, 1], [1, 2], [2, 3], [3, 0]]", "[[3, 2], [2, 1], [1, 0], [0, 3]]",
                            "[[2, 3], [1, 0], [0, 3], [1, 2]]", "[[0.0, 1], [1, 2], [2, 3], [3, 0]]"}) {
    EXPECT_NO_THROW(parse(with_target(std::string("edges: ") + edges))) << edges;
  }
}

TEST(MissionErrors, APlanOfAFlightIsNoMission) {
  for (const char* plan : {"{\n  \"fileType\": \"Plan\", \"geoFence\": {}}", "QGC WPL 110\n0\t1\t0\t16\n",
                           "<?xml version=\"1.0\"?><kml></kml>", "PK\x03\x04zip"}) {
    const Error error = testing::expect_error([&] { parse(plan); }, ErrorCode::wrong_type);
    EXPECT_NE(error.fix().find("vantage check"), std::string::npos);
  }
}

TEST(MissionErrors, OldKeysAreReadAndNotSuggested) {
  EXPECT_EQ(parse(with_navigation("boxes: [{min: [0, 0, 0], max: [1, 1, 1]}]")).navigation.keep_in.size(), 1U);
  const Error error = testing::expect_error([&] { parse(with_navigation("no_fly: []")); }, ErrorCode::unknown_key);
  EXPECT_EQ(error.fix().find("boxes"), std::string::npos) << error.fix();
  EXPECT_EQ(error.fix().find("you mean"), std::string::npos) << error.fix();
}

TEST(MissionErrors, UnknownKeysNameTheNearest) {
  expect_refusal(with_sensor("max_rnage: 100"), ErrorCode::unknown_key, ":6:3");
  expect_refusal(text_of_mission("navigaton: {altitude: [1, 2]}"), ErrorCode::unknown_key, ":7:1");
  expect_refusal(with_scene("Mesh: city.obj"), ErrorCode::unknown_key, ":2:3");
  expect_refusal(with_target("edge: []"), ErrorCode::unknown_key, ":5:3");
  expect_refusal(with_navigation("keepout: []"), ErrorCode::unknown_key, ":8:3");
  expect_refusal(with_navigation("boxes: [{min: [0, 0, 0], mix: [1, 1, 1]}]"), ErrorCode::unknown_key, ":8:28");
  expect_refusal(with_navigation("meshes: [{mesh: a.ply, units: m}]"), ErrorCode::unknown_key, ":8:26");
  expect_refusal(text_of_mission("exact: {tolerence: 1}"), ErrorCode::unknown_key, ":7:9");
  expect_refusal(text_of_mission("<<: 1"), ErrorCode::unknown_key, ":7:1");
  expect_refusal(text_of_mission("x\xC3\xA9: 1"), ErrorCode::unknown_key, ":7:1");
  expect_refusal(text_of_mission("\"a\\e[31m\\n\": 1"), ErrorCode::unknown_key, ":7:1");
  expect_refusal(text_of_mission(std::string(500, 'k') + ": 1"), ErrorCode::unknown_key, ":7:1");
}

TEST(MissionErrors, MisplacedKeysNameTheirSection) {
  expect_refusal(with_sensor("altitude: [1, 2]"), ErrorCode::unknown_key, ":6:3");
  expect_refusal(text_of_mission("max_range: 3"), ErrorCode::unknown_key, ":7:1");
}

TEST(MissionErrors, KeysGivenTwice) {
  expect_refusal(with_sensor("max_range: 1\n  max_range: 2"), ErrorCode::duplicate_key, ":7:3");
  expect_refusal(text_of_mission(kSensor), ErrorCode::duplicate_key, ":7:1");
}

TEST(MissionErrors, MissingKeysSayWhatToWrite) {
  expect_refusal(std::string(kTarget) + kSensor, ErrorCode::missing_key, ":1:1");
  expect_refusal(std::string(kScene) + kSensor, ErrorCode::missing_key, ":1:1");
  expect_refusal(std::string(kScene) + kTarget, ErrorCode::missing_key, ":1:1");
  expect_refusal(with_scene("up: y"), ErrorCode::missing_key, ":2:3");
  expect_refusal(text_of_mission("", "target: {name: a}\n"), ErrorCode::missing_key, ":3:9");
  expect_refusal(text_of_mission("", kTarget, "sensor: {}\n"), ErrorCode::missing_key, ":5:9");
  expect_refusal(with_navigation("boxes: [{min: [0, 0, 0]}]"), ErrorCode::missing_key, ":8:11");
  expect_refusal(text_of_mission("", kTarget, "sensor:\n"), ErrorCode::wrong_type, ":5:1");
}

TEST(MissionErrors, HeightsOfRastersAndPartialMaps) {
  expect_refusal(with_scene("raster: a.tif\n  z_unit: inch"), ErrorCode::unknown_choice, ":3:11");
  expect_refusal(with_scene("osm: a.osm\n  void: 3"), ErrorCode::not_applicable, ":3:9");
  expect_refusal(with_scene("mesh: a\n  partial: true"), ErrorCode::not_applicable, ":3:12");
  expect_refusal(with_scene("osm: a.osm\n  partial: maybe"), ErrorCode::unknown_choice, ":3:12");
}

TEST(MissionErrors, WrongTypes) {
  expect_refusal("- 1\n- 2\n", ErrorCode::wrong_type, ":1:1");
  expect_refusal("just words", ErrorCode::wrong_type, ":1:1");
  expect_refusal(text_of_mission("", kTarget, kSensor, "scene: city.obj\n"), ErrorCode::wrong_type, ":1:8");
  expect_refusal(with_scene("mesh: [a, b]"), ErrorCode::wrong_type, ":2:9");
  expect_refusal(with_scene("mesh: ''"), ErrorCode::wrong_type, ":2:9");
  expect_refusal(with_scene("mesh: ~"), ErrorCode::wrong_type, ":2:3");
  expect_refusal(with_scene("mesh: \"a\\0b\""), ErrorCode::value_syntax, ":2:9");
  expect_refusal(with_scene("mesh: a\n  up: x"), ErrorCode::unknown_choice, ":3:7");
  expect_refusal(with_scene("mesh: a\n  up: [y]"), ErrorCode::wrong_type, ":3:7");
  expect_refusal(with_scene("mesh: a\n  scale: big"), ErrorCode::not_a_number, ":3:10");
  expect_refusal(with_scene("mesh: a\n  scale: 0"), ErrorCode::value_out_of_range, ":3:10");
  expect_refusal(with_target("name: [a]"), ErrorCode::wrong_type, ":5:9");
  expect_refusal(with_target("offset: high"), ErrorCode::not_a_number, ":5:11");
  expect_refusal(with_target("front: up"), ErrorCode::wrong_type, ":5:10");
  expect_refusal(with_target("front: [0, 1]"), ErrorCode::wrong_type, ":5:10");
  expect_refusal(with_vertices("3"), ErrorCode::wrong_type, ":4:13");
  expect_refusal(with_vertices("[[0, 0, 0], [1, 0], [0, 1, 0]]"), ErrorCode::wrong_type, ":4:25");
  expect_refusal(with_vertices("[[0, 0, 0], [1, 0, 0, 0], [0, 1, 0]]"), ErrorCode::wrong_type, ":4:25");
  expect_refusal(with_vertices("[[0, 0, 0], [1, 0, a], [0, 1, 0]]"), ErrorCode::not_a_number, ":4:32");
  expect_refusal(with_sensor("max_range: \"100\""), ErrorCode::wrong_type, ":6:14");
  expect_refusal(with_sensor("max_range: [100]"), ErrorCode::wrong_type, ":6:14");
  expect_refusal(with_sensor("max_range: true"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_navigation("altitude: 20"), ErrorCode::wrong_type, ":8:13");
  expect_refusal(with_navigation("altitude: [20]"), ErrorCode::wrong_type, ":8:13");
  expect_refusal(with_navigation("boxes: {min: [0, 0, 0], max: [1, 1, 1]}"), ErrorCode::wrong_type, ":8:");
  expect_refusal(with_navigation("boxes: [1]"), ErrorCode::wrong_type, ":8:11");
  expect_refusal(with_navigation("boxes: []"), ErrorCode::nothing_given, ":8:10");
  expect_refusal(with_navigation("meshes: a.ply"), ErrorCode::wrong_type, ":8:11");
  expect_refusal(with_navigation("meshes: [[a.ply]]"), ErrorCode::wrong_type, ":8:12");
  expect_refusal(text_of_mission("navigation: 3"), ErrorCode::wrong_type, ":7:13");
  expect_refusal(text_of_mission("exact: fine"), ErrorCode::wrong_type, ":7:8");
  expect_refusal(text_of_mission("exact: {tolerance: -1}"), ErrorCode::value_out_of_range, ":7:20");
}

TEST(MissionErrors, Methods) {
  EXPECT_NO_THROW(parse(text_of_mission("method: exact")));
  EXPECT_EQ(parse(text_of_mission("method: spheres")).method, Method::spheres);
  expect_refusal(text_of_mission("method: sphere"), ErrorCode::unknown_choice, ":7:9");
  expect_refusal(text_of_mission("method:"), ErrorCode::wrong_type, ":7:");
}

TEST(MissionErrors, NumbersThatAreNone) {
  expect_refusal(with_sensor("max_range: 1_000"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 0x10"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 0o17"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 1:30"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 1,5"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 100yd"), ErrorCode::value_syntax, ":6:14");
  for (const char* text : {".inf", "-.Inf", "+.INF", ".nan", ".NaN", "nan", "inf", "-Infinity"}) {
    expect_refusal(with_sensor(std::string("max_range: ") + text), ErrorCode::value_out_of_range, ":6:14");
    expect_refusal(with_vertices(std::string("[[0, 0, 0], [1, ") + text + ", 0], [0, 1, 0]]"),
                   ErrorCode::value_out_of_range, ":4:29");
  }
  expect_refusal(with_sensor("max_range: 1e400"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_sensor("max_range: 1e-400"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_sensor("max_range: 1e300"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_vertices("[[0, 0, 0], [1, -2e9, 0], [0, 1, 0]]"), ErrorCode::value_out_of_range, ":4:29");
}

TEST(MissionErrors, Ranges) {
  expect_refusal(with_sensor("max_range: 0"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_sensor("max_range: -0.0"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_sensor("max_range: -5"), ErrorCode::value_out_of_range, ":6:14");
  expect_refusal(with_sensor("max_range:"), ErrorCode::wrong_type, ":6:3");
}

TEST(MissionErrors, ReversedLimits) {
  expect_refusal(with_navigation("altitude: [120, 20]"), ErrorCode::limits_reversed, ":8:13");
  expect_refusal(with_navigation("altitude: [20, 20]"), ErrorCode::limits_empty, ":8:13");
  expect_refusal(with_navigation("boxes: [{min: [0, 5, 0], max: [1, 4, 1]}]"), ErrorCode::limits_reversed, ":8:11");
  expect_refusal(with_navigation("keep_out: [{min: [0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 2], max: [1, 1, 1]}]"),
                 ErrorCode::limits_reversed, ":8:48");
  expect_refusal(with_navigation("keep_out: [{min: [0, 0, 0], max: [1, 0, 1]}]"), ErrorCode::limits_empty, ":8:14");
}

TEST(MissionErrors, EdgesThatDisagree) {
  expect_refusal(with_target("edges: [[0, 2], [2, 1], [1, 3], [3, 0]]"), ErrorCode::edges_mismatch, ":5:11");
  expect_refusal(with_target("edges: [[0, 1], [1, 2], [2, 3]]"), ErrorCode::edges_mismatch, ":5:10");
  expect_refusal(with_target("edges: []"), ErrorCode::edges_mismatch, ":5:10");
  expect_refusal(with_target("edges: [[0, 1], [1, 2], [2, 3], [1, 0]]"), ErrorCode::edges_mismatch, ":5:35");
  expect_refusal(with_target("edges: [[0, 1], [1, 2], [2, 3], [3, 4]]"), ErrorCode::edges_mismatch, ":5:39");
  expect_refusal(with_target("edges: [[0, 1], [1, 2], [2, 3], [3, -1]]"), ErrorCode::edges_mismatch, ":5:39");
  expect_refusal(with_target("edges: [[0, 1], [1, 2], [2, 3], [3, 0.5]]"), ErrorCode::edges_mismatch, ":5:39");
  expect_refusal(with_target("edges: [[0, 1], [1, 1], [2, 3], [3, 0]]"), ErrorCode::edges_mismatch, ":5:19");
  expect_refusal(with_target("edges: [[0, 1, 2]]"), ErrorCode::wrong_type, ":5:11");
  expect_refusal(with_target("edges: [0, 1]"), ErrorCode::wrong_type, ":5:11");
  expect_refusal(with_target("edges: 4"), ErrorCode::wrong_type, ":5:10");
}

std::string with_point(const std::string& rest) { return text_of_mission("", "target:\n  " + rest + "\n"); }

TEST(Mission, TargetOfAPoint) {
  MissionFile mission = parse(with_point("point: [1, -2, 3.5]"));
  ASSERT_TRUE(mission.targets[0].target.is_point());
  EXPECT_EQ(mission.targets[0].target.parts[0][0], Vec3(1, -2, 3.5));
  EXPECT_FALSE(mission.targets[0].target.front.has_value());
  EXPECT_EQ(mission.places.target, std::string(kMissionFile) + ":4:10");
  mission = parse(with_point("{name: camera, point: [1, 2, 3], front: [0, -1, 0], offset: 0.1}"));
  EXPECT_EQ(mission.targets[0].target.name, "camera");
  EXPECT_EQ(mission.targets[0].target.offset_m, 0.1);
  EXPECT_EQ(*mission.targets[0].target.front, Vec3(0, -1, 0));
}

TEST(MissionErrors, PointsThatAreNone) {
  expect_refusal(with_point("point: [1, 2]"), ErrorCode::wrong_type, ":4:10");
  expect_refusal(with_point("point: [1, 2, .nan]"), ErrorCode::value_out_of_range, ":4:17");
  expect_refusal(with_point("point: 5"), ErrorCode::wrong_type, ":4:10");
  expect_refusal(with_point("{point: [1, 2, 3], vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}"),
                 ErrorCode::conflicting_keys, ":4:32");
  expect_refusal(with_point("{point: [1, 2, 3], edges: [[0, 0]]}"), ErrorCode::conflicting_keys, ":4:29");
  expect_refusal(with_point("{point: [1, 2, 3], offset: 1}"), ErrorCode::conflicting_keys, ":4:30");
  expect_refusal(with_point("{point: [1, 2, 3], front: [0, 0, 0]}"), ErrorCode::direction_invalid, ":4:11");
  expect_refusal(with_vertices("[[1, 2, 3]]"), ErrorCode::target_vertex_count, ":4:13");
  expect_refusal(with_point("name: x"), ErrorCode::missing_key, ":4:3");
}

TEST(MissionErrors, TargetsThatAreNone) {
  // What is wrong with a polygon is told by make_target_frame; here it gets its place.
  const std::string place = ":4:13, target \"target\"";
  expect_refusal(with_vertices("[[0, 0, 0], [1, 0, 0]]"), ErrorCode::target_vertex_count, place);
  expect_refusal(with_vertices("[]"), ErrorCode::target_vertex_count, place);
  expect_refusal(with_vertices("[[0, 0, 0], [9, 0, 0], [9, 9, 0.5], [0, 9, 0]]"), ErrorCode::target_not_planar, place);
  expect_refusal(with_vertices("[[0, 0, 0], [9, 0, 0], [2, 2, 0], [0, 9, 0]]"), ErrorCode::target_not_convex, place);
  expect_refusal(with_vertices("[[0, 0, 0], [9, 0, 0], [9, 0, 0], [0, 9, 0]]"), ErrorCode::target_vertices_coincide,
                 place);
  expect_refusal(with_vertices("[[0, 0, 0], [9, 0, 0], [4, 0, 0]]"), ErrorCode::target_without_area, place);
  expect_refusal(with_target("front: [1, 0, 0]"), ErrorCode::direction_invalid, place);
  expect_refusal(with_target("front: [0, 0, 0]"), ErrorCode::direction_invalid, place);
  std::string many = "[";
  for (int i = 0; i < 65; ++i)
    many += (i > 0 ? ", [" : "[") + std::to_string(i) + ", " + std::to_string(i * i) + ", 0]";
  expect_refusal(with_vertices(many + "]"), ErrorCode::target_vertex_count, place);
}

TEST(MissionErrors, BrokenYaml) {
  expect_refusal("scene: {mesh: a", ErrorCode::yaml_syntax, ":");
  expect_refusal("scene:\n\tmesh: a\n", ErrorCode::yaml_syntax, ":2:");
  expect_refusal("scene: [1, 2\ntarget: 3\n", ErrorCode::yaml_syntax, ":");
  expect_refusal("scene: 'abc", ErrorCode::yaml_syntax, ":");
  expect_refusal("%YAML 9.9\n---\na: 1\n", ErrorCode::yaml_syntax, ":");
  expect_refusal(text_of_mission("---\n" + text_of_mission("")), ErrorCode::yaml_unsupported, ":8:1");
  expect_refusal(text_of_mission("? [a]\n: 1\n"), ErrorCode::yaml_syntax, ":7:3");
  expect_refusal(text_of_mission("? {a: 1}\n: 1\n"), ErrorCode::yaml_syntax, ":7:");
  expect_refusal(text_of_mission("~: 1\n"), ErrorCode::yaml_syntax, ":7:1");
}

TEST(MissionErrors, EmptyFiles) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "\xEF\xBB\xBF", "---\n", "...\n", "   "}) {
    const Error error = refusal(text);
    EXPECT_TRUE(error.problem().find("empty") != std::string::npos ||
                error.problem().find("nothing") != std::string::npos)
        << error.problem();
  }
}

TEST(MissionErrors, AliasesAndTags) {
  expect_refusal("a: &a [1, 1]\nb: *a\n", ErrorCode::yaml_unsupported, ":2:4");
  std::ostringstream bomb;
  bomb << "a0: &a0 [x, x]\n";
  for (int i = 1; i < 60; ++i) bomb << "a" << i << ": &a" << i << " [*a" << i - 1 << ", *a" << i - 1 << "]\n";
  expect_refusal(bomb.str(), ErrorCode::yaml_unsupported, ":2:");
  expect_refusal(with_sensor("max_range: !!float 3"), ErrorCode::yaml_unsupported, ":6:");
  expect_refusal(text_of_mission("exact: !mine {}"), ErrorCode::yaml_unsupported, ":7:");
}

TEST(MissionErrors, NotText) {
  expect_refusal(std::string("\x7F"
                             "ELF\x02\x01\x01\0\0\0",
                             10),
                 ErrorCode::not_utf8_text, ":1:1");
  expect_refusal(std::string("scene: \0", 8), ErrorCode::not_utf8_text, ":1:8");
  expect_refusal("scene:\n  mesh: caf\xE9\n", ErrorCode::not_utf8_text, ":2:12");
  expect_refusal("scene: \xC0\x80\n", ErrorCode::not_utf8_text, ":1:8");
  expect_refusal("scene: \xED\xA0\x80\n", ErrorCode::not_utf8_text, ":1:8");
  expect_refusal("scene: \xF5\x80\x80\x80\n", ErrorCode::not_utf8_text, ":1:8");
  expect_refusal("scene: \xE2\x82", ErrorCode::not_utf8_text, ":1:8");
  expect_refusal("scene: a\x04: b\n", ErrorCode::not_utf8_text,
                 ":1:9");  // yaml-cpp takes this byte for the end of the file
  expect_refusal(std::string("\xFF\xFE"
                             "s\0c\0",
                             6),
                 ErrorCode::not_utf8_text, "");
  expect_refusal(std::string("\xFE\xFF\0s\0c", 6), ErrorCode::not_utf8_text, "");
}

TEST(MissionErrors, DeepNestingEndsEarly) {
  const auto repeated = [](const std::string& unit, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += unit;
    return text;
  };
  for (const char* unit : {"[", "{", "- ", "? ", "[{", "{a: ", "{? ", "- - ? "}) {
    refusal(repeated(unit, 100000));
    refusal("a: " + repeated(unit, 100000));
  }
  expect_refusal("a: " + repeated("[", 17) + repeated("]", 17), ErrorCode::yaml_unsupported, ":1:");
}

TEST(MissionErrors, HugeFiles) {
  expect_refusal(std::string(app::kMaxYamlBytes + 1, ' '), ErrorCode::file_too_large, "");
  std::ostringstream many_keys;
  for (int i = 0; i < 90000; ++i) many_keys << "k" << i << ": 1\n";
  expect_refusal(many_keys.str(), ErrorCode::yaml_unsupported, ":1:1");
}

TEST(MissionUnits, AreUnderstood) {
  const MissionFile mission = parse(
      "scene: {mesh: city.obj, scale: 1 ft}\n"
      "target: {vertices: [[0, 0, 0], [10, 0, 0], [10, 10, 0]], offset: 2 ft}\n"
      "sensor: {max_range: 400 ft, min_range: 10ft, incidence: 60 deg, fov: [60\u00b0, 40], pixel: {size: 2 cm}, "
      "camera: {width: 4000, height: 3000}, gimbal: {pitch: [-90 deg, 10]}}\n"
      "navigation:\n  altitude: {agl: [100 ft, 0.1 km], z: [0, 1 mi]}\n  ground: 12 ft\n  clearance: 10 ft\n"
      "  keep_out:\n    - {polygon: [[0, 0], [9, 0], [9, 9]], z: [0, 400 ft]}\n"
      "exact: {tolerance: 5 mm}\n");
  EXPECT_EQ(mission.scene.mesh.scale, 0.3048);
  EXPECT_EQ(mission.targets[0].target.offset_m, 0.6096);
  EXPECT_EQ(mission.sensor.max_range_m, 121.92);
  EXPECT_EQ(mission.sensor.min_range_m, 3.048);
  EXPECT_EQ(mission.sensor.incidence_deg, 60);
  EXPECT_EQ(mission.sensor.pixel->size_m, 0.02);
  EXPECT_EQ(mission.sensor.mount.min_pitch_deg, -90);
  EXPECT_EQ(mission.navigation.above_ground->min_m, 30.48);
  EXPECT_EQ(mission.navigation.above_ground->max_m, 100);
  EXPECT_EQ(mission.navigation.altitude->max_m, 1609.344);
  EXPECT_NEAR(*mission.ground->plane_z_m, 3.6576, 1e-15);
  EXPECT_EQ(mission.navigation.clearance->distance_m, 3.048);
  EXPECT_EQ(mission.navigation.keep_out[0].max_z_m, 121.92);
  EXPECT_EQ(mission.exact.tolerance_m, 0.005);
  // In JSON a number with a unit has to be in quotes.
  const MissionFile json =
      parse(R"({"scene": {"mesh": "city.obj"}, "target": {"vertices": [[0, 0, 0], [10, 0, 0], [10, 10, 0]]},)"
            R"("sensor": {"max_range": "400 ft", "incidence": "60 deg"}, "navigation": {"clearance": "10 ft"}})");
  EXPECT_EQ(json.sensor.max_range_m, 121.92);
  EXPECT_EQ(json.sensor.incidence_deg, 60);
  EXPECT_EQ(json.navigation.clearance->distance_m, 3.048);
}

// Nothing that has a unit is taken for metres, or for anything else, without a word.
TEST(MissionUnits, OthersAreRefused) {
  expect_refusal(with_sensor("max_range: 400 yd"), ErrorCode::value_syntax, ":6:14");
  expect_refusal(with_sensor("max_range: 400 M"), ErrorCode::value_syntax, ":6:14");
  expect_refusal(with_sensor("max_range: 1,000 ft"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 60 deg"), ErrorCode::value_syntax, ":6:14");
  expect_refusal(with_sensor("max_range: ft"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: '400'"), ErrorCode::wrong_type, ":6:14");
  expect_refusal(with_sensor("max_range: '400 yd'"), ErrorCode::wrong_type, ":6:14");
  expect_refusal(with_sensor("max_range: nano"), ErrorCode::not_a_number, ":6:14");
  expect_refusal(with_sensor("max_range: 100\n  incidence: 60 m"), ErrorCode::value_syntax, ":7:14");
  expect_refusal(with_sensor("max_range: 100\n  visible: 80 %"), ErrorCode::not_a_number, ":7:12");
  expect_refusal(
      with_sensor("max_range: 100\n  camera: {width: 4000, height: 3000, focal_length: 35 mm, sensor_width: 36}"),
      ErrorCode::not_a_number, ":7:53");
  expect_refusal(with_sensor("max_range: 100\n  link: {frequency: 2.4 GHz}"), ErrorCode::not_a_number, ":7:21");
  expect_refusal(with_vertices("[[0, 0, 0], [30 ft, 0, 0], [30, 30, 0]]"), ErrorCode::value_syntax, ":4:26");
  expect_refusal(with_navigation("keep_out: [{polygon: [[0, 0], [30 ft, 0], [9, 9]], heights: any}]"),
                 ErrorCode::value_syntax, ":8:");
}

}  // namespace
}  // namespace vantage
