// What the page asks of a scene and a mission in it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/output.h"
#include "live/access_control.h"
#include "live/page_text.h"
#include "live/report_page.h"
#include "live/request.h"
#include "live/session.h"
#include "support/limit_samples.h"
#include "support/live_session.h"
#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/tile_files.h"
#include "vantage/camera.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::live {
namespace {

TEST_F(LiveSession, ComputesWhatRunMissionDoes) {
  const Message message = ask({{"call", "compute"}, {"text", kSquare}});
  const Result expected = run_mission(resolve_mission(read_mission(folder_ / "mission.yaml")));
  ASSERT_EQ(message.header["id"], 7);
  const Json& value = message.header["value"];
  EXPECT_EQ(value["facets"], expected.volume.mesh.triangles.size());
  EXPECT_EQ(value["volume_m3"], measure(expected.volume.mesh).volume_m3);
  const Json& counts = message.header["mesh"];
  ASSERT_EQ(counts[0], 3 * expected.volume.mesh.vertices.size());
  ASSERT_EQ(message.rest.size(),
            4 * (counts[0].get<std::size_t>() + counts[1].get<std::size_t>() + counts[2].get<std::size_t>()));
  std::uint32_t corner = 0;
  std::memcpy(&corner, message.rest.data() + 4 * counts[0].get<std::size_t>(), sizeof corner);
  EXPECT_EQ(corner, expected.volume.mesh.triangles[0][0]);
}

TEST_F(LiveSession, AnswersWithoutAVolumeSayWhatIsMissing) {
  for (const char* const call : {"query", "prove", "slice"}) {
    EXPECT_EQ(code_of({{"call", call}, {"points", {{0, 0, 20}}}, {"z", 5}}), name_of(ErrorCode::nothing_given)) << call;
  }
  EXPECT_EQ(code_of({{"call", "save"}, {"format", "ply"}}), name_of(ErrorCode::nothing_given));
  EXPECT_EQ(code_of({{"call", "fly"}}), name_of(ErrorCode::unknown_choice));
}

TEST_F(LiveSession, AMissionThatFailsKeepsTheLastVolume) {
  const std::size_t facets = ask({{"call", "compute"}, {"text", kSquare}}).header["value"]["facets"];
  const std::string one_corner = "target: {vertices: [[0, 0, 0]]}\nsensor: {max_range: 60}\n", no_yaml = "target: [";
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", one_corner}}), name_of(ErrorCode::target_vertex_count));
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", no_yaml}}), name_of(ErrorCode::yaml_syntax));
  EXPECT_EQ(session_.volume_view().triangles.size(), 3 * facets);
  EXPECT_EQ(ask({{"call", "prove"}}).header["value"]["verdict"], "proved");
}

TEST_F(LiveSession, NamesNoFileThatTheMissionDidNotName) {
  write("zones.geojson", R"({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]})");
  const std::string mission = std::string(kSquare) + "navigation: {meshes: [volume.ply]}\n";
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", mission}}), name_of(ErrorCode::not_applicable));
  const std::string zones = std::string(kSquare) + "navigation: {keep_out: [{file: zones.geojson, heights: any}]}\n";
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", zones}}), name_of(ErrorCode::not_applicable));
}

// In a map the ground is extended out to where a target needs it: that is no part of what other missions are computed
// in.
TEST_F(LiveSession, ATargetFarOutLeavesTheSceneAsItIs) {
  testing::MapText map;
  map.box(0, 0, 30, 30, {{"building", "yes"}, {"height", "9"}});
  write("map.osm", map.text());
  const std::string near = "target: {outline: [[40, 0], [50, 0], [50, 10]]}\nsensor: {max_range: 60}\n";
  const std::string far = "target: {outline: [[110, 0], [120, 0], [120, 10]]}\nsensor: {max_range: 60}\n";
  write("map.yaml", "scene: {osm: map.osm}\n" + near);
  session_.open_file(folder_ / "map.yaml");
  const auto facets = [&](const std::string& mission) { return Json::parse(session_.compute(mission))["facets"]; };
  const Json before = facets(near), hash = Json::parse(session_.hello())["scene"]["hash"];
  EXPECT_NE(facets(far), before);
  EXPECT_EQ(ask({{"call", "prove"}}).header["value"]["verdict"], "proved");
  EXPECT_EQ(facets(near), before);
  EXPECT_EQ(Json::parse(session_.hello())["scene"]["hash"], hash);
  write("edited.yaml", "scene: {osm: map.osm}\n" + near);
  EXPECT_EQ(run_mission(resolve_mission(read_mission(folder_ / "edited.yaml"))).volume.mesh.triangles.size(), before);
}

// An error of the disk or of this program would be told else.
TEST_F(LiveSession, AnEmptyVolumeHasNothingToSave) {
  ask({{"call", "compute"}, {"text", std::string(kSquare) + "navigation: {altitude: [500, 600]}\n"}});
  for (const std::string& format : mesh_format_words()) {
    const Json error = ask({{"call", "save"}, {"format", format}}).header["error"];
    EXPECT_EQ(error["code"], name_of(ErrorCode::nothing_given)) << format;
    testing::expect_wording(error["problem"].get<std::string>() + "\n" + error["fix"].get<std::string>());
  }
}

// Whoever may ask the page's session must not learn by its answers what lies on the disk.
TEST_F(LiveSession, DoesNotTellWhetherAFileExists) {
  write("there.ply", "ply\n");
  write("folder/there.ply", "ply\n");
  const auto told_of = [&](const std::string& text) {
    Json error = ask({{"call", "compute"}, {"text", text}}).header["error"];
    std::string where = error["where"];
    for (const char* const name : {"there.ply", "gone.ply", "link.ply", "folder", "nowhere", "linked"}) {
      for (std::size_t at; (at = where.find(name)) != std::string::npos;)
        where.replace(at, std::string(name).size(), "X");
    }
    error["where"] = where;
    return error;
  };
  const auto told = [&](const std::string& more) { return told_of(kSquare + more); };
  const auto mesh = [&](const std::string& name) { return told("navigation: {meshes: [" + name + "]}\n"); };
  const auto zones = [&](const std::string& name) {
    return told("navigation: {keep_out: [{file: " + name + ", heights: any}]}\n");
  };
  EXPECT_EQ(mesh("there.ply")["code"], name_of(ErrorCode::not_applicable));
  EXPECT_EQ(mesh("there.ply"), mesh("gone.ply"));
  EXPECT_EQ(mesh("folder/there.ply"), mesh("nowhere/there.ply"));
  EXPECT_EQ(mesh("/etc/passwd")["code"], name_of(ErrorCode::not_applicable));
  EXPECT_EQ(zones("there.ply"), zones("gone.ply"));
  const auto target = [&](const std::string& name) {
    return told_of("target: {file: " + name + "}\nsensor: {max_range: 60}\n");
  };
  EXPECT_EQ(target("there.ply")["code"], name_of(ErrorCode::not_applicable));
  EXPECT_EQ(target("there.ply"), target("gone.ply"));
  EXPECT_EQ(target("folder/there.ply"), target("nowhere/there.ply"));
  // Links, and folders in the place of files, are none of its business either.
  std::filesystem::create_symlink("there.ply", folder_ / "link.ply");
  std::filesystem::create_directory_symlink("folder", folder_ / "linked");
  for (const auto& ask_for : {std::function(mesh), std::function(zones), std::function(target)}) {
    EXPECT_EQ(ask_for("link.ply"), ask_for("gone.ply"));
    EXPECT_EQ(ask_for("folder"), ask_for("gone.ply"));
    EXPECT_EQ(ask_for("linked/there.ply"), ask_for("nowhere/there.ply"));
    EXPECT_EQ(ask_for("folder/../there.ply"), ask_for("nowhere/../there.ply"));
  }
  // PROJ opens files that a text names.
  const auto crs = [&](const std::string& text) { return told("crs: \"" + text + "\"\n"); };
  EXPECT_EQ(crs("/etc/passwd")["code"], name_of(ErrorCode::not_applicable));
  EXPECT_EQ(crs("+proj=longlat +nadgrids=/etc/passwd +type=crs"), crs("+proj=longlat +nadgrids=/etc/gone +type=crs"));
  EXPECT_EQ(crs("EPSG:4326")["code"], name_of(ErrorCode::not_georeferenced));
}

TEST_F(LiveSession, TakesTheFilesThatTheOpenedMissionNames) {
  ask({{"call", "compute"}, {"text", kSquare}});
  const Message saved = ask({{"call", "save"}, {"format", "ply"}});
  write("deep/air.ply", saved.rest);
  const std::string limits = "navigation: {meshes: [deep/air.ply]}\n";
  write("limited.yaml", testing::kScene + std::string(kSquare) + limits);
  session_.open_file(folder_ / "limited.yaml");
  for (const char* const name : {"deep/air.ply", "./deep/air.ply", "gone/../deep/air.ply"}) {
    const std::string again = std::string("navigation: {meshes: [") + name + "]}\n";
    const Json header = ask({{"call", "compute"}, {"text", kSquare + again}}).header;
    EXPECT_EQ(header.contains("error"), false) << header.dump(1).substr(0, 500);
  }
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", std::string(kSquare) + "navigation: {meshes: [air.ply]}\n"}}),
            name_of(ErrorCode::not_applicable));
}

TEST_F(LiveSession, TakesTheTargetFilesThatTheOpenedMissionNames) {
  testing::MapText map;
  map.box(0, 0, 30, 30, {{"building", "yes"}, {"height", "9"}});
  write("map.osm", map.text());
  const auto square = [](const std::string& west, const std::string& east) {
    return R"({"type": "Polygon", "coordinates": [[[)" + west + ", 48.1370], [" + east + ", 48.1370], [" + east +
           ", 48.1371], [" + west + ", 48.1371], [" + west + ", 48.1370]]]}";
  };
  write("deep/a.geojson", square("11.5750", "11.5752"));
  write("b.geojson", square("11.5740", "11.5742"));
  write("other.geojson", square("11.5740", "11.5742"));
  std::filesystem::create_directory_symlink("deep", folder_ / "linked");
  const auto text_of = [](const std::string& target) { return target + "\nsensor: {max_range: 60}\n"; };
  const auto expect_answers = [&](const std::string& opened, const std::vector<std::string>& targets) {
    write("map.yaml", "scene: {osm: map.osm}\n" + text_of(opened));
    session_.open_file(folder_ / "map.yaml");
    for (const std::string& target : targets) {
      const Json header = ask({{"call", "compute"}, {"text", text_of(target)}}).header;
      EXPECT_FALSE(header.contains("error")) << target << header.dump(1).substr(0, 500);
    }
    for (const std::string name : {"other.geojson", "gone.geojson", "/etc/passwd"}) {
      EXPECT_EQ(code_of({{"call", "compute"}, {"text", text_of("target: {file: " + name + "}")}}),
                name_of(ErrorCode::not_applicable))
          << name;
    }
  };
  expect_answers("target: {file: linked/a.geojson}",
                 {"target: {file: linked/a.geojson}", "target: {file: ./linked/a.geojson, name: a}"});
  const std::string both = "targets: [{name: a, file: deep/a.geojson}, {name: b, file: b.geojson}]";
  expect_answers(both, {both, "target: {file: b.geojson}", "target: {file: deep/a.geojson}"});
}

// Whatever the page has no control for is told, and drawn.
TEST_F(LiveSession, ListsEveryLimitOfTheMission) {
  const std::string more =
      "sensor: {max_range: 60, min_range: 2, incidence: 70, fov: [60, 40], gimbal: {pitch: [-90, 10]}, "
      "sun: {azimuth: 180, elevation: 40, exclude: 20}, visible: 0.9}\n"
      "navigation:\n  altitude: {z: [2, 50], agl: [1, 45]}\n  ground: ground\n  clearance: 2.5\n"
      "  keep_in:\n    - {min: [-60, -60, 0], max: [60, 60, 60]}\n"
      "    - {polygon: [[-60, -60], [60, -60], [60, 60], [-60, 60]], z: [0, 55]}\n"
      "  keep_out:\n    - {min: [40, 40, 0], max: [50, 50, 20]}\n"
      "    - {polygon: [[-30, 10], [-20, 10], [-20, 20]], holes: [[[-23, 12], [-22, 12], [-22, 13]]], heights: any}\n"
      "    - {polygon: [[-30, -10], [-20, -10], [-20, -20]], agl: [0, 12]}\n";
  const std::string target = "target: {name: square, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}\n";
  const Json limits = ask({{"call", "compute"}, {"text", target + more}}).header["value"]["limits"];
  std::vector<std::string> lines;
  for (const Json& line : limits["all"])
    lines.push_back(line["name"].get<std::string>() + ": " + line["text"].get<std::string>());
  testing::expect_wording(lines);
  const Json& zones = limits["zones"];
  ASSERT_EQ(zones.size(), 4u);  // a box and a zone to stay in, two zones to stay out of
  EXPECT_EQ(zones[0]["kept_out"], false);
  EXPECT_EQ(zones[0]["high"], 60);
  EXPECT_EQ(zones[1]["rings"][0].size(), 4u);
  EXPECT_EQ(zones[2]["kept_out"], true);
  EXPECT_EQ(zones[2]["rings"].size(), 2u);
  EXPECT_LE(zones[2]["low"].get<double>(), 0);
  EXPECT_GE(zones[2]["high"].get<double>(), 60);
  EXPECT_EQ(zones[3]["low"], 0);
  EXPECT_EQ(zones[3]["high"], 12);
}

/// Each limit alone makes the list longer.
TEST_F(LiveSession, ListsEachLimitThatThereIs) {
  const auto lines = [&](const std::string& text) {
    write("mission.yaml", text);
    session_.open_file(folder_ / "mission.yaml");
    std::vector<std::string> told;
    const Message answer = ask({{"call", "compute"}, {"text", text.substr(text.find("target:"))}});
    for (const Json& line : answer.header["value"]["limits"]["all"]) told.push_back(line["name"]);
    return told;
  };
  write_scene(testing::world_of_samples().scene, folder_ / "scene.obj");
  const std::vector<std::string> free = lines(testing::mission_text_without_limit());
  ASSERT_FALSE(free.empty());
  for (const testing::LimitSample& sample : testing::limit_samples()) {
    SCOPED_TRACE(name_of(sample.limit));
    const std::vector<std::string> told = lines(testing::mission_text_of(sample, folder_));
    EXPECT_GT(told.size(), free.size());
    for (const std::string& line : free) EXPECT_EQ(std::count(told.begin(), told.end(), line), 1) << line;
  }
}

TEST_F(LiveSession, SaysWhereTheSceneLiesAndWhomToName) {
  EXPECT_TRUE(Json::parse(session_.hello())["scene"]["place"].is_null());
  EXPECT_EQ(Json::parse(session_.hello())["scene"]["attribution"], "");
  testing::MapText map;
  map.box(0, 0, 30, 30, {{"building", "yes"}, {"height", "9"}});
  write("map.osm", map.text());
  write("map.yaml", "scene: {osm: map.osm}\ntarget: {osm: way/1, part: roof}\nsensor: {max_range: 60}\n");
  session_.open_file(folder_ / "map.yaml");
  const Json scene = Json::parse(session_.hello())["scene"];
  EXPECT_NEAR(scene["place"]["latitude_deg"].get<double>(), 48.137, 0.01);
  EXPECT_EQ(scene["attribution"], kOpenStreetMapCredit);
}

TEST_F(LiveSession, SavesOnlyFormatsOfVolumes) {
  ask({{"call", "compute"}, {"text", kSquare}});
  for (const std::string& format : mesh_format_words()) {
    const Message message = ask({{"call", "save"}, {"format", format}});
    EXPECT_EQ(message.header["bytes"], message.rest.size());
    EXPECT_GT(message.rest.size(), 1000u) << format;
  }
  EXPECT_EQ(code_of({{"call", "save"}, {"format", "/../../etc/passwd"}}), name_of(ErrorCode::output_format_unknown));
}

TEST_F(LiveSession, AsksOfAPointWhatHidesTheTarget) {
  ask({{"call", "compute"}, {"text", kSquare}});
  const Json answers =
      ask({{"call", "query"}, {"points", {{0, 0, 20}, {40, 0, 5}, {0, 0, 500}}}}).header["value"]["answers"];
  EXPECT_TRUE(answers[0]["inside"]);
  EXPECT_EQ(answers[1]["blocked_by"], Json({"block"}));
  const bool is_too_far = answers[2]["out_of_range"];
  EXPECT_TRUE(is_too_far);
  EXPECT_GT(ask({{"call", "slice"}, {"z", 20}}).header["value"]["area_m2"], 100.0);
}

// The page and the program stand on one definition. They differed: over both targets the page told the margin of the
// first alone, and where neither is seen what is wrong with the first alone.
TEST_F(LiveSession, OfSeveralTargetsItAnswersWhatTheProgramDoes) {
  const std::string targets =
      "targets:\n  - {name: a, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n"
      "  - {name: b, point: [-30, 0, 1]}\nsensor: {max_range: 70}\n"
      "navigation: {altitude: [2, 60]}\n";
  const Vec3 inside(5, 0, 40), behind_the_block(38, 0, 4), too_high(0, 0, 65);
  for (const char* const combine : {"combine: all\n", "combine: any\n"}) {
    SCOPED_TRACE(combine);
    write("several.yaml", testing::kScene + targets + combine);
    session_.open_file(folder_ / "several.yaml");
    ask({{"call", "compute"}, {"text", targets + combine}});
    const Mission mission = resolve_mission(read_mission(folder_ / "several.yaml"));
    const std::vector<std::vector<PreparedTarget>> views = prepare_views(mission, PreparedScene(mission.scene()));
    const std::vector<Vec3> points = {inside, behind_the_block, too_high};
    const std::vector<PointAnswer> expected = ViewsQuery(views, mission.navigation).answer(points);
    Json coordinates = Json::array();
    for (const Vec3& point : points) coordinates.push_back({point.x(), point.y(), point.z()});
    const Json answers = ask({{"call", "query"}, {"points", coordinates}}).header["value"]["answers"];
    for (std::size_t i = 0; i < points.size(); ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(answers[i]["inside"], expected[i].inside);
      EXPECT_EQ(answers[i]["blocked_by"], Json(expected[i].blocked_by));
      EXPECT_EQ(answers[i]["out_of_range"], expected[i].out_of_range);
      EXPECT_EQ(answers[i]["outside_of"], Json(expected[i].outside_of));
      if (std::isfinite(expected[i].margin_m)) {
        EXPECT_EQ(answers[i]["margin_m"], expected[i].margin_m);
      }
    }
    // What the program prints, too.
    options_.input = "5 0 40\n";
    const Json printed = Json::parse(run({"query", "several.yaml", "-", "--json", "-q"}).out);
    EXPECT_EQ(printed[0]["margin_m"], answers[0]["margin_m"]);
    if (std::string(combine) != "combine: all\n") continue;
    ASSERT_EQ(views.size(), 2u);
    // The second target's margin is the smaller one: the first one's was told.
    const double first = PointQuery(views[0][0], mission.navigation).answer(points)[0].margin_m;
    const double second = PointQuery(views[1][0], mission.navigation).answer(points)[0].margin_m;
    ASSERT_TRUE(expected[0].inside);
    ASSERT_NE(first, second);
    EXPECT_EQ(answers[0]["margin_m"], std::min(first, second));
  }
}

TEST_F(LiveSession, OfSeveralTargetsEachMustBeSeenOrOne) {
  const std::string targets =
      "targets:\n  - {name: a, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n"
      "  - {name: b, vertices: [[50, -5, 0], [60, -5, 0], [60, 5, 0]]}\nsensor: {max_range: 30}\n";
  for (const bool is_any : {false, true}) {
    ask({{"call", "compute"}, {"text", targets + (is_any ? "combine: any\n" : "combine: all\n")}});
    const Json answers = ask({{"call", "query"}, {"points", {{0, 0, 20}}}}).header["value"]["answers"];
    EXPECT_EQ(answers[0]["inside"], is_any);
  }
}

TEST_F(LiveSession, TellsWhereTheTargetIsAndWhatTheFileAndTheVolumeSay) {
  const std::string raised =
      "target: {vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]], offset: 2}\n"
      "sensor: {max_range: 30000, visible: 0.5, pixel: {size: 0.02}, camera: {model: " +
      known_cameras().front().name + "}}\n";
  const Json answer = ask({{"call", "compute"}, {"text", raised}}).header;
  const Json& value = answer["value"];
  for (const Json& corner : value["target"][0]) EXPECT_EQ(corner[2], 2.0);
  EXPECT_EQ(value["limits"]["max_range"], 30000.0) << answer;
  EXPECT_LT(value["range_m"], 30000.0);
  EXPECT_EQ(value["claim"]["visible"], 0.5);
  EXPECT_EQ(value["claim"]["combine"], "all");
}

TEST_F(LiveSession, ShowsTheVolumeOfSeveralTargets) {
  const std::string targets =
      "scene: {mesh: city.obj}\ntargets:\n  - {name: a, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n"
      "  - {name: b, vertices: [[-5, 6, 0], [5, 6, 0], [5, 9, 0]]}\nsensor: {max_range: 60}\ncombine: any\n";
  write("several.yaml", targets);
  Session first, second;
  first.open_file(folder_ / "several.yaml");
  first.compute(targets.substr(targets.find("targets:")));
  first.save("ply");
  write("several.ply", first.bytes());
  second.open_file(folder_ / "several.yaml");
  second.show_volume(folder_ / "several.ply");
  const Json volume = Json::parse(second.hello())["volume"];
  EXPECT_EQ(volume["claim"]["combine"], "any");
  EXPECT_GT(volume["causes"].size(), 1U);
  first.save("stl");
  write("several.stl", first.bytes());
  second.show_volume(folder_ / "several.stl");
  const Json causes = Json::parse(second.hello())["volume"]["causes"];
  ASSERT_EQ(causes.size(), 1U);
  EXPECT_EQ(causes[0]["kind"], "unknown");
}

TEST_F(LiveSession, AVolumeOfAFileHasTheWarningsOfAComputedOne) {
  write("far.yaml",
        "scene: {mesh: city.obj}\ntarget: {vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n"
        "sensor: {max_range: 3000, camera: {width: 4000, height: 3000, focal_length: 35, sensor_width: 36},\n"
        "  pixel: {size: 2, kind: perpendicular}}\n");
  Session computed, shown;
  computed.open_file(folder_ / "far.yaml");
  computed.run();
  computed.save("ply");
  write("far.ply", computed.bytes());
  shown.open_file(folder_ / "far.yaml");
  shown.show_volume(folder_ / "far.ply");
  const std::vector<Warning>& notes = computed.result()->volume.notes;
  EXPECT_NE(
      std::find_if(notes.begin(), notes.end(), [](const Warning& w) { return w.code == WarningCode::pixel_in_metres; }),
      notes.end());
  EXPECT_EQ(shown.result()->volume.notes, notes);
}

TEST_F(LiveSession, AVolumeIsKeptWhileALimitIsDragged) {
  std::string text = kSquare;
  ask({{"call", "compute"}, {"text", text}});
  text += "navigation: {altitude: [5, 30]}\n";
  const double kept = ask({{"call", "compute"}, {"text", text}}).header["value"]["volume_m3"];
  Session other;
  other.open_file(folder_ / "mission.yaml");
  EXPECT_EQ(Json::parse(other.compute(text))["volume_m3"], kept);
}

TEST_F(LiveSession, FindsTheAreaOfTheMapAtAPoint) {
  EXPECT_EQ(code_of({{"call", "area"}, {"points", {{0, 0, 0}}}}), name_of(ErrorCode::not_applicable));
  testing::MapText map;
  map.box(0, 0, 60, 60, {{"leisure", "park"}, {"name", "Green"}});
  map.box(20, 20, 40, 40, {{"leisure", "pitch"}});
  map.box(30, 30, 35, 35, {{"building", "yes"}, {"height", "4"}});
  map.box(80, 0, 90, 10, {{"building", "yes"}, {"height", "8"}});
  write("map.osm", map.text());
  write("map.yaml", "scene: {osm: map.osm}\ntarget: {osm: way/1, offset: 5}\nsensor: {max_range: 60}\n");
  session_.open_file(folder_ / "map.yaml");
  const std::vector<MapArea> areas = read_areas(folder_ / "map.osm");
  const auto place_in = [&](std::size_t area, double east) {
    const auto [latitude, longitude] = areas.at(area).center_deg;
    const Eigen::Vector2d at = scene_position(*session_.scene().georeference, longitude, latitude);
    return Json{{"call", "area"}, {"points", {{at.x() + east, at.y(), 0}}}};
  };
  const auto found = [&](const Json& request) { return ask(request).header["value"]["area"]; };
  EXPECT_EQ(found(place_in(0, -25)), (Json{{"osm", "way/1"}, {"name", "Green"}}));
  EXPECT_EQ(found(place_in(0, 0)), (Json{{"osm", "way/2"}, {"name", ""}}));
  EXPECT_EQ(found(place_in(2, 0)), (Json{{"osm", "way/2"}, {"name", ""}}));  // not the building
  EXPECT_EQ(found(place_in(0, 500)), Json());
  EXPECT_EQ(code_of({{"call", "area"}}), name_of(ErrorCode::value_syntax));
}

TEST_F(LiveSession, RequestsOfOthersAreRefused) {
  for (const char* const text :
       {"", "{", "[]", "7", R"({"id": -1, "request": {"call": "prove"}})", R"({"id": 1})", R"({"id": 1, "request": 3})",
        R"({"id": 1, "request": {"call": 3}})", R"({"id": 1, "request": {"call": "query", "points": [[1, 2]]}})",
        R"({"id": 1, "request": {"call": "query", "points": [[1, 2, "x"]]}})",
        R"({"id": 1, "request": {"call": "slice", "z": "high"}})"}) {
    EXPECT_THROW(parse_request(text), vantage::Error) << text;
  }
  const std::string more = R"({"id": 1, "x": [[1], {}], "request": {"call": "prove", "y": [2]}})";
  EXPECT_EQ(parse_request(more).call, "prove");
  std::string points = R"({"id": 1, "request": {"call": "query", "points": [[0, 0, 0])";
  for (int i = 0; i < 1000; ++i) points += ", [0, 0, 0]";
  EXPECT_THROW(parse_request(points + "]}}"), vantage::Error);
  EXPECT_THROW(parse_request(std::string(100000, '[')), vantage::Error);
  // What is more than a request is not even held, whatever its key.
  std::string objects = "{}", nested = "1";
  for (int i = 0; i < 1000000; ++i) objects += ",{}";
  nested = std::string(100000, '[') + nested + std::string(100000, ']');
  for (const char* const key : {"points", "other"}) {
    for (const std::string& value : {"[" + objects + "]", nested}) {
      EXPECT_THROW(
          parse_request(R"({"id": 1, "request": {"call": "query", ")" + std::string(key) + R"(": )" + value + "}}"),
          vantage::Error);
    }
  }
}

TEST(LiveAccessControl, AllowsTheTokenAndTheOwnHostAlone) {
  const std::string token = random_token();
  ASSERT_EQ(token.size(), 32u);
  EXPECT_NE(token, random_token());
  const AccessControl access(token);
  EXPECT_TRUE(access.allows("/?token=" + token, "/"));
  EXPECT_FALSE(access.allows("/?token=" + token + "0", "/"));
  EXPECT_FALSE(access.allows("/?token=" + token.substr(1) + "x", "/"));
  EXPECT_FALSE(access.allows("/?token=", "/"));
  EXPECT_FALSE(access.allows("/", "/"));
  EXPECT_FALSE(access.allows("/socket?token=" + token, "/"));
  for (const char* const host : {"127.0.0.1:8090", "localhost:8090", "127.0.0.1", "localhost:9000"})
    EXPECT_TRUE(AccessControl::is_own_host(host)) << host;
  for (const char* const host : {"evil.example:8090", "evil.example", "127.0.0.1:8090.evil.example", "127.0.0.1:", "",
                                 "127.0.0.1.evil.example", "localhost:1:2", "[::1]:8090"})
    EXPECT_FALSE(AccessControl::is_own_host(host)) << host;
  const std::string own = "127.0.0.1:8090";
  EXPECT_TRUE(AccessControl::is_own_origin("http://" + own, own));
  for (const char* const origin :
       {"https://127.0.0.1:8090", "http://evil.example", "null", "", "http://127.0.0.1:8091", "http://localhost:8090"})
    EXPECT_FALSE(AccessControl::is_own_origin(origin, own)) << origin;
  const std::string other = "evil.example";
  EXPECT_FALSE(AccessControl::is_own_origin("http://" + other, other));
}

TEST_F(LiveSession, ATilesetAloneTakesTargets) {
  write("tileset.json", testing::tileset_json(testing::tile_json(0, "a.glb")).dump());
  write("a.glb", testing::box_glb({{{20, 0, 0}}}));
  session_ = {};
  session_.open_tileset(folder_ / "tileset.json");
  const Json hello = ask({{"call", "hello"}}).header["value"];
  EXPECT_EQ(hello["mission"], "scene: {tiles: \"tileset.json\"}\n");
  EXPECT_EQ(hello["scene"]["objects"].size(), 1u);
  EXPECT_TRUE(hello["volume"].is_null());
  EXPECT_EQ(code_of({{"call", "prove"}}), name_of(ErrorCode::nothing_given));
  EXPECT_GT(ask({{"call", "compute"}, {"text", kSquare}}).header["value"]["volume_m3"], 1000);
  const std::string with_file = std::string(kSquare) + "navigation: {meshes: [volume.ply]}\n";
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", with_file}}), name_of(ErrorCode::not_applicable));
}

TEST_F(LiveSession, AVolumeThatIsShownMustBeClosed) {
  const auto code_of_shown = [&](const std::string& file) {
    try {
      session_.show_volume(folder_ / file);
    } catch (const vantage::Error& error) {
      return error.code();
    }
    return ErrorCode::internal_defect;
  };
  write("open.obj", "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n");
  EXPECT_EQ(code_of_shown("open.obj"), ErrorCode::mesh_not_closed);
}

TEST_F(LiveSession, AReportHoldsTheVolumeAndItsProof) {
  session_.run();
  const std::string empty = "<html><!--LIVE--></html>";
  const std::string page = report_page(session_, empty, true);
  for (const char* const part : {"hello:\"", "shown:\"", "prove:\"", "<script>", "</html>"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(report_page(session_, empty, false).find("prove:"), std::string::npos);
  EXPECT_THROW(report_page(session_, "<html></html>", false), vantage::Error);
  EXPECT_THROW(report_page(session_, empty, true, [](std::string_view, double) { return false; }), vantage::Error);
}

/// The mission that a report holds, of the city of these tests, whose mission says of its scene that it came from
/// there.
std::string mission_of_report(const std::string& scene_section, const Scene& city) {
  MissionFile file = read_mission_text(scene_section + kSquare, "mission.yaml");
  LoadedScene loaded{.scene = city};
  loaded.scene.source = "https://a.example/ok/tileset.json";  // as reading it says
  const auto shared = std::make_shared<const LoadedScene>(std::move(loaded));
  const Mission mission = resolve_mission(file, shared);
  const Volume volume = run_mission(mission).volume;
  Session session;
  session.show({.mission = &mission,
                .volume = &volume,
                .loaded = shared,
                .prepared = PreparedScene(shared->scene),
                .source = file.scene,
                .name = "mission.yaml"});
  report_page(session, "<html><!--LIVE--></html>", false);
  const std::string hello = session.hello();
  EXPECT_EQ(hello.find("SECRET"), std::string::npos) << scene_section;
  return Json::parse(hello)["mission"];
}

TEST_F(LiveSession, AReportHasNoKeysOfServers) {
  const Scene city = read_scene(folder_ / "city.obj");
  for (const std::string address :
       {R"("https:\/\/a.example/ok/tileset.json?key=SECRET")",
        "\"https://a.example/ok/tileset.json?\\\n   key=SECRET\"",
        R"("https://a.example/ok/tileset.json\x3Fkey=SECRET")",
        R"("https://user:SECRET@a.example/ok/tileset.json?key=x")",
        R"("https://user:SECRET%40@a.example/ok/tileset.json")",
        R"("https://a.example/ok/tileset.json%3Ftoken=SECRET")",
        R"(&tiles https://a.example/ok/tileset.json?a=1&key=SECRET)", R"('https://a.example/ok/tileset.json#SECRET')",
        "https://a.example/ok/tileset.json?key=SECRET # ?key=SECRET",
        ">-\n    https://a.example/ok/tileset.json?key=SECRET",
        "|-\n    https://a.example/ok/tileset.json?key=SECRET"}) {
    const std::string text = mission_of_report("scene:\n  tiles: " + address + "\n", city);
    EXPECT_NE(text.find("tiles: \"https://a.example/ok/tileset.json\"\n"), std::string::npos) << text;
  }
  mission_of_report("? scene\n: {? tiles\n  : 'https://a.example/ok/tileset.json?key=SECRET'}\n", city);
}

TEST_F(LiveSession, AReportHasTheMissionAsItWasRead) {
  write("deep/mission.yaml", "# https://b.example/?key=SECRET\nscene: {mesh: ../city.obj}\n" + std::string(kSquare) +
                                 "navigation: {altitude: [3, 40], clearance: 2}\n");
  Session session;
  session.open_file(folder_ / "deep/mission.yaml");
  session.run();
  EXPECT_NE(session.hello().find("SECRET"), std::string::npos);  // the page's own user has the file as it is
  report_page(session, "<html><!--LIVE--></html>", false);
  const std::string hello = session.hello();
  EXPECT_EQ(hello.find("SECRET"), std::string::npos);
  EXPECT_EQ(hello.find(folder_.string()), std::string::npos);
  const std::string text = Json::parse(hello)["mission"];
  const auto hash = [&](const MissionFile& file) { return mission_hash(resolve_mission(file)); };
  EXPECT_EQ(hash(read_mission_text(text, folder_ / "deep/again.yaml")),
            hash(read_mission(folder_ / "deep/mission.yaml")));
}

TEST_F(LiveSession, ReadsAMissionWhoseTargetIsRefused) {
  const std::string limits =
      "sensor: {max_range: 60, incidence: 70}\n"
      "navigation: {altitude: [3, 50], clearance: 2, keep_out: [{min: [9, 9, 0], max: [12, 12, 9]}]}\n";
  const std::string pierced = "target: {vertices: [[18, -2, 0], [22, -2, 0], [22, 2, 0], [18, 2, 0]]}\n" + limits;
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", pierced}}), name_of(ErrorCode::target_pierced));
  const Json told = ask({{"call", "read"}, {"text", pierced}}).header["value"];
  EXPECT_EQ(told["target"][0][0], Json({18, -2, 0}));
  EXPECT_EQ(told["normal"], Json({0, 0, 1}));
  EXPECT_EQ(told["limits"]["max_range"], 60);
  EXPECT_EQ(told["limits"]["incidence"], 70);
  EXPECT_EQ(told["limits"]["altitude"], Json({3, 50}));
  EXPECT_EQ(told["limits"]["keep_out"].size(), 1u);
  EXPECT_EQ(told["limits"]["all"].size(), 5u);
  EXPECT_TRUE(session_.volume_view().triangles.empty());

  const std::string square = std::string(kSquare).substr(0, std::string(kSquare).find('\n') + 1) + limits;
  const Json computed = ask({{"call", "compute"}, {"text", square}}).header["value"];
  const Json read = ask({{"call", "read"}, {"text", square}}).header["value"];
  for (const auto& [key, value] : read.items()) EXPECT_EQ(value, computed[key]) << key;
  EXPECT_EQ(code_of({{"call", "read"}, {"text", "target: ["}}), name_of(ErrorCode::yaml_syntax));
  EXPECT_EQ(code_of({{"call", "read"}, {"text", square + "links: [{mesh: volume.ply}]\n"}}),
            name_of(ErrorCode::unknown_key));
  EXPECT_EQ(code_of({{"call", "read"}, {"text", std::string(kSquare) + "navigation: {meshes: [volume.ply]}\n"}}),
            name_of(ErrorCode::not_applicable));
}

TEST_F(LiveSession, TellsWhatIsNotBuiltTheWorstFirst) {
  LoadedScene loaded{.scene = read_scene(folder_ / "city.obj")};
  Scene& scene = loaded.scene;
  scene.objects[1].kind = ObjectKind::stand_in;
  scene.ledger = {{.object = {.name = "mill", .source_id = "way/7"},
                   .what = "building=yes",
                   .reason = "its ring is open",
                   .box = Box{Vec3(20, -5, 0), Vec3(30, 5, 12)},
                   .stand_in = 1,
                   .instead = "its outline"},
                  {.object = {}, .what = "void posts", .reason = "they are void"},
                  {.object = {.source_id = "relation/9"},
                   .what = "relation",
                   .reason = "a member is missing",
                   .box = Box{Vec3(40, 40, -std::numeric_limits<double>::infinity()),
                              Vec3(60, 50, std::numeric_limits<double>::infinity())},
                   .height_m = 20}};
  const auto shared = std::make_shared<const LoadedScene>(std::move(loaded));
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"), shared);
  const Volume volume = run_mission(mission).volume;
  session_.show({.mission = &mission,
                 .volume = &volume,
                 .loaded = shared,
                 .prepared = PreparedScene(shared->scene),
                 .source = mission.as_written.scene,
                 .name = "mission.yaml"});
  const Json told = Json::parse(session_.hello())["scene"];
  EXPECT_EQ(told["objects"][1]["kind"], "stand-in");
  const Json& ledger = told["ledger"];
  EXPECT_EQ(ledger["count"], 3);
  EXPECT_EQ(ledger["held"], 1);
  ASSERT_EQ(ledger["worst"].size(), 3u);
  EXPECT_EQ(ledger["worst"][0]["name"], "relation/9");
  EXPECT_EQ(ledger["worst"][0]["rings"], Json::parse("[[[40,40],[60,40],[60,50],[40,50]]]"));
  EXPECT_EQ(ledger["worst"][0]["low"], 0);
  EXPECT_EQ(ledger["worst"][0]["high"], 20);
  EXPECT_EQ(ledger["worst"][1]["name"], "void posts");
  EXPECT_EQ(ledger["worst"][1]["rings"], Json::array());
  EXPECT_EQ(ledger["worst"][2]["name"], "way/7 mill");
  EXPECT_EQ(ledger["worst"][2]["instead"], "its outline");
  EXPECT_EQ(ledger["worst"][2]["held"], true);
}

}  // namespace
}  // namespace vantage::live
