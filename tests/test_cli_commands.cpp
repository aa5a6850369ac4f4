// What the commands answer.
#include <numbers>
#include <utility>

#include "support/cli_fixture.h"
#include "support/formats.h"
#include "vantage/geometry.h"

namespace vantage::testing {
namespace {

using CliInspect = Cli;
using CliCompute = Cli;
using CliVerify = Cli;

TEST_F(CliInspect, ShowsWhatWasRead) {
  const std::string table = output_of({"inspect", "city.obj"});
  for (const char* expected : {"triangles", "12", "objects", "open edges", "fine: blockers are built per polygon"}) {
    EXPECT_NE(table.find(expected), std::string::npos) << table;
  }
  const auto json = nlohmann::json::parse(output_of({"inspect", "city.obj", "--json"}));
  EXPECT_EQ(json.at("triangles"), 12);
  EXPECT_EQ(json.at("vertices"), 12);
  EXPECT_EQ(json.at("objects"), 2);
  EXPECT_EQ(json.at("polygons"), 6);
  EXPECT_EQ(json.at("open_edges"), 8) << "of the ground, and of the block that has no floor";
  EXPECT_EQ(json.at("bounds").at("max"), nlohmann::json({100, 100, 12}));
}

TEST_F(CliInspect, TurnsAndScales) {
  const auto json = nlohmann::json::parse(output_of({"inspect", "city.obj", "--json", "--up", "y", "--scale", "2"}));
  EXPECT_EQ(json.at("bounds").at("min"), nlohmann::json({-200, -24, -200}));
  EXPECT_EQ(json.at("bounds").at("max"), nlohmann::json({200, 0, 200}));
}

TEST_F(CliCompute, WritesVolumeAndReport) {
  const std::string summary = output_of({"compute", "mission.yaml", "-o", "volume.ply"});
  for (const char* expected :
       {"volume", "1 piece", "facets", "max_range", "block", "time", "wrote volume.ply", "wrote volume.report.json"}) {
    EXPECT_NE(summary.find(expected), std::string::npos) << summary;
  }
  EXPECT_EQ(lines(summary).size(), 7U) << summary;
  EXPECT_EQ(content(folder_ / "volume.ply").substr(0, 4), "ply\n");
  const auto report = nlohmann::json::parse(content(folder_ / "volume.report.json"));
  EXPECT_EQ(report.at("outcome"), "computed");
  EXPECT_EQ(report.at("euler"), 2);
  EXPECT_EQ(report.at("pieces"), 1);
  // Within the half ball about the target's centre, and not without the air straight above.
  EXPECT_LT(report.at("volume_m3").get<double>(), 2.0 / 3 * std::numbers::pi * 60 * 60 * 60);
  EXPECT_GT(report.at("volume_m3").get<double>(), 0.5 * 2 / 3 * std::numbers::pi * 52 * 52 * 52);
  EXPECT_GT(report.at("seconds").at("total").get<double>(), 0.0);
  EXPECT_EQ(report.at("target"), "square");
}

TEST_F(CliCompute, TellsMoreWhenAsked) {
  const std::string summary = output_of({"compute", "mission.yaml", "-v", "-o", "volume.ply"});
  for (const char* expected :
       {"tolerance", "area", "vertices", "square metres", "start", "prepare", "engine", "total"}) {
    EXPECT_NE(summary.find(expected), std::string::npos) << expected << "\n" << summary;
  }
}

TEST_F(CliCompute, TellsTheLift) {
  EXPECT_EQ(output_of({"compute", "mission.yaml", "-v", "-o", "volume.ply"}).find("lift"), std::string::npos);
  write("low.yaml",
        std::string(kScene) + kSensor + "target: {vertices: [[-4, -4, -0.0015], [4, -4, -0.0015], [4, 4, -0.0015]]}\n");
  const std::string summary = output_of({"compute", "low.yaml", "-o", "volume.ply"});
  EXPECT_NE(summary.find("lift"), std::string::npos) << summary;
  EXPECT_NE(summary.find("1.50"), std::string::npos) << summary;
}

TEST_F(CliCompute, TheTotalHoldsTheStages) {
  output_of({"compute", "mission.yaml", "-o", "volume.ply"});
  const auto seconds = nlohmann::json::parse(content(folder_ / "volume.report.json")).at("seconds");
  double sum = 0;
  for (const char* stage : {"read", "prepare", "engine", "navigation", "write"}) sum += seconds.at(stage).get<double>();
  EXPECT_GT(seconds.at("total").get<double>(), sum + 1e-3) << "loading the program takes milliseconds";
}

TEST_F(CliCompute, WritesEveryFormatAndIsQuiet) {
  EXPECT_EQ(output_of({"compute", "mission.yaml", "-q", "-o", "a.ply", "-o", "a.obj", "-o", "a.stl", "-o", "b.GLB"}),
            "");
  for (const char* name : {"a.ply", "a.obj", "a.stl", "b.GLB", "a.report.json", "b.report.json"}) {
    EXPECT_GT(content(folder_ / name).size(), 500U) << name;
  }
  EXPECT_EQ(content(folder_ / "volume.ply"), kOldOutput) << "not asked for";
}

TEST_F(CliCompute, PrintsTheReportAsJson) {
  const auto printed = nlohmann::json::parse(output_of({"compute", "mission.yaml", "-o", "volume.ply", "--json"}));
  const auto written = nlohmann::json::parse(content(folder_ / "volume.report.json"));
  EXPECT_EQ(printed, written);
}

TEST_F(CliCompute, DoesNotDependOnThreads) {
  output_of({"compute", "mission.yaml", "--threads", "1", "-o", "one.ply"});
  output_of({"compute", "mission.yaml", "--threads", "4", "-o", "four.ply"});
  EXPECT_TRUE(content(folder_ / "one.ply") == content(folder_ / "four.ply"));
}

TEST_F(CliCompute, WarnsWhereStlIsCoarserThanTheTolerance) {
  std::string far_city;
  for (const std::string& line : lines(kCity)) {
    std::istringstream words(line);
    std::string keyword;
    double x = 0, y = 0, z = 0;
    const bool is_vertex = words >> keyword && keyword == "v" && words >> x >> y >> z;
    std::ostringstream moved;
    moved << std::fixed << "v " << x + 580000 << ' ' << y + 4785000 << ' ' << z;
    far_city += (is_vertex ? moved.str() : line) + "\n";
  }
  write("far.obj", far_city);
  write("far.yaml", std::string("scene: {mesh: far.obj}\n") + kSensor +
                        "target: {vertices: [[579995, 4784995, 0], [580005, 4784995, 0], [580000, 4785005, 0]]}\n");
  const ProgramRun warned = run({"compute", "far.yaml", "-o", "far.ply", "-o", "far.STL"});
  EXPECT_EQ(warned.exit_code, 0);
  ASSERT_EQ(lines(warned.err).size(), 1U) << warned.err;
  EXPECT_NE(warned.err.find("far.STL"), std::string::npos) << warned.err;
  testing::expect_wording(warned.err);
  output_of({"compute", "far.yaml", "-q", "-o", "far.STL"});
  output_of({"compute", "far.yaml", "-o", "far.ply"});
  output_of({"compute", "mission.yaml", "-o", "near.stl"});
}

TEST_F(CliCompute, TellsStagesWhenAsked) {
  const ProgramRun result = run({"compute", "mission.yaml", "--progress", "-o", "volume.ply"});
  EXPECT_EQ(result.exit_code, 0);
  ASSERT_GE(lines(result.err).size(), 2U) << result.err;
  for (const std::string& line : lines(result.err)) EXPECT_EQ(line.rfind("vantage: ", 0), 0U) << line;
}

TEST_F(CliCompute, ObjComesInTheAxesOfTheScene) {
  write("mission.yaml",
        "scene: {mesh: city.obj, up: y}\ntarget: {vertices: [[-5, -60, 5], [5, -60, 5], [0, -60, 15]],"
        " front: [0, 1, 0]}\nsensor: {max_range: 30}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "volume.obj", "-o", "volume.ply"});
  const auto obj = nlohmann::json::parse(output_of({"inspect", "volume.obj", "--up", "y", "--json"}));
  const auto ply = nlohmann::json::parse(output_of({"inspect", "volume.ply", "--json"}));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(obj.at("bounds").at("min")[axis].get<double>(), ply.at("bounds").at("min")[axis].get<double>(), 1e-4);
    EXPECT_NEAR(obj.at("bounds").at("max")[axis].get<double>(), ply.at("bounds").at("max")[axis].get<double>(), 1e-4);
  }
}

TEST_F(CliCompute, ObjComesInTheUnitOfTheScene) {
  std::string millimetres;
  for (const std::string& line : lines(kCity)) {
    std::istringstream words(line);
    std::string keyword;
    double x = 0, y = 0, z = 0;
    const bool is_vertex = words >> keyword && keyword == "v" && words >> x >> y >> z;
    std::ostringstream scaled;
    scaled << "v " << 1000 * x << ' ' << 1000 * y << ' ' << 1000 * z;
    millimetres += (is_vertex ? scaled.str() : line) + "\n";
  }
  write("millimetres.obj", millimetres);
  const std::string mission = std::string("scene: {mesh: millimetres.obj, scale: 0.001}\n") + kTarget + kSensor;
  write("mission.yaml", mission);
  output_of({"compute", "mission.yaml", "-q", "-o", "v.obj", "-o", "v.ply"});
  const auto obj = nlohmann::json::parse(output_of({"inspect", "v.obj", "--json"}));
  const auto ply = nlohmann::json::parse(output_of({"inspect", "v.ply", "--json"}));
  Box bounds;  // of the numbers in the file
  for (const std::string& line : lines(content(folder_ / "v.obj"))) {
    std::istringstream words(line);
    std::string keyword;
    Vec3 v;
    if (words >> keyword && keyword == "v" && words >> v.x() >> v.y() >> v.z()) bounds.extend(v);
  }
  for (const char* end : {"min", "max"}) {
    for (int axis = 0; axis < 3; ++axis) {
      const double metres = ply.at("bounds").at(end)[axis].get<double>();
      EXPECT_NEAR((end == std::string("min") ? bounds.min : bounds.max)[axis], 1000 * metres, 1e-6);
      EXPECT_NEAR(obj.at("bounds").at(end)[axis].get<double>(), metres, 1e-9) << "the file says its unit";
    }
  }
  const auto check =
      nlohmann::json::parse(output_of({"verify", "mission.yaml", "v.obj", "--points", "2000", "--json"}));
  EXPECT_EQ(check.at("right"), true);
  EXPECT_TRUE(check.at("scene_incomplete").is_null());
  EXPECT_EQ(check.at("under_claimed"), 0);
  EXPECT_GT(check.at("inside"), 100);
  // It limits the next mission where it was: the same volume, cut to itself.
  write("next.yaml", mission + "navigation: {meshes: [v.obj]}\n");
  output_of({"compute", "next.yaml", "-q", "-o", "next.ply"});
  const double before = nlohmann::json::parse(content(folder_ / "v.report.json")).at("volume_m3");
  const double after = nlohmann::json::parse(content(folder_ / "next.report.json")).at("volume_m3");
  EXPECT_NEAR(after, before, 1e-6 * before);
}

TEST_F(CliCompute, NamesEmptyOutcomesAndKeepsTheOldMesh) {
  const auto expect_empty = [&](const std::string& mission, const std::string& outcome) {
    write("mission.yaml", mission);
    const ProgramRun result = run({"compute", "mission.yaml", "-o", "volume.ply", "-o", "new.glb"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    const auto report = nlohmann::json::parse(content(folder_ / "volume.report.json"));
    EXPECT_EQ(report.at("outcome"), outcome) << report;
    EXPECT_NE(report.at("reason"), "");
    EXPECT_NE(result.out.find(report.at("reason").get<std::string>()), std::string::npos) << result.out;
    EXPECT_TRUE(content(folder_ / "volume.ply") == kOldOutput);
    EXPECT_FALSE(fs::exists(folder_ / "new.glb"));
    testing::expect_wording(result.err);
  };
  const std::string start = std::string(kScene) + kTarget;
  expect_empty(start + "sensor: {max_range: 5}\n", "out_of_range");
  expect_empty(start + kSensor + "navigation: {altitude: [200, 300]}\n", "outside_limits");
  expect_empty(std::string(kScene) + "target: {point: [25, 0, 12]}\nsensor: {max_range: 60, link: {frequency: 2.4}}\n",
               "blocked_at_once");
}

TEST_F(CliVerify, PassesWhatWasComputed) {
  std::vector<std::string> compute = {"compute", "mission.yaml", "-q"};
  for (const std::string& name : testing::in_each_format("v")) compute.insert(compute.end(), {"-o", name});
  output_of(compute);
  for (const std::string& name : testing::in_each_format("v")) {
    const ProgramRun result = run({"verify", "mission.yaml", name, "--points", "4000", "--json"});
    EXPECT_EQ(result.exit_code, 0) << name << result.err << result.out;
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report.at("right"), true);
    EXPECT_EQ(report.at("over_claimed"), 0);
    EXPECT_EQ(report.at("closed"), true);
    EXPECT_GE(report.at("points"), 4000);
    EXPECT_GT(report.at("inside"), 100);
    EXPECT_EQ(report.at("seed"), 1);
  }
  const std::string table = output_of({"verify", "mission.yaml", "v.ply", "--points", "1000", "--seed", "7"});
  for (const char* expected :
       {"over-claimed", "seed 7", "95 % confidence", "bound's points", "nothing wrong was found"}) {
    EXPECT_NE(table.find(expected), std::string::npos) << table;
  }
}

TEST_F(CliVerify, FailsAnOverClaimingVolume) {
  // A box over the square that reaches behind the block.
  write("box.obj",
        "v -4 -4 1\nv 50 -4 1\nv 50 4 1\nv -4 4 1\nv -4 -4 20\nv 50 -4 20\nv 50 4 20\nv -4 4 20\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const ProgramRun result = run({"verify", "mission.yaml", "box.obj", "--points", "2000"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("WRONG"), std::string::npos) << result.out;
  testing::expect_wording(lines(result.out).back());
  const auto report =
      nlohmann::json::parse(run({"verify", "mission.yaml", "box.obj", "--points", "2000", "--json"}).out);
  EXPECT_EQ(report.at("right"), false);
  EXPECT_GT(report.at("over_claimed"), 10);
  const double worst = report.at("worst_over_depth_m");
  EXPECT_GT(worst, 0.1);
}

/// A flat pyramid on the ground, half a millimetre high. Over the target it belongs to the surface that the target lies
/// on, beside it not; one point does not find it.
TEST_F(CliVerify, TheProofForgivesWhatTheRaysForgive) {
  write("low.obj",
        "v -40 -1 0.002\nv -30 -1 0.002\nv -30 1 0.002\nv -40 1 0.002\nv -40 -1 0.5\nv -30 -1 0.5\nv -30 1 0.5\n"
        "v -40 1 0.5\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto judge_with_bump = [&](const std::string& corners) {
    write("city.obj", kCity + ("o bump\n" + corners) + "f 13 14 17\nf 14 15 17\nf 15 16 17\nf 16 13 17\n");
    EXPECT_EQ(run({"prove", "mission.yaml", "low.obj"}).exit_code, 1);
    const std::vector<std::string> verify = {"verify", "mission.yaml", "low.obj", "--points", "1"};
    const ProgramRun table = run(verify);
    std::vector<std::string> as_json = verify;
    as_json.emplace_back("--json");
    const auto json = nlohmann::json::parse(run(as_json).out);
    EXPECT_EQ(json.at("over_claimed"), 0);
    EXPECT_EQ(json.at("right"), table.exit_code == 0);
    EXPECT_EQ(table.out.find("WRONG") == std::string::npos, table.exit_code == 0) << table.out;
    EXPECT_EQ(json.at("proof").at("verdict"), table.exit_code == 0 ? "not proved" : "wrong");
    return table.exit_code;
  };
  const std::string over = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 0.0005\n";
  const std::string beside = "v -9 -1 0\nv -7 -1 0\nv -7 1 0\nv -9 1 0\nv -8 0 0.0005\n";
  EXPECT_EQ(judge_with_bump(over), 0);
  EXPECT_EQ(judge_with_bump(beside), 1);
}

/// By a tenth of a micrometre a limit is broken for the proof alone, by a millimetre for both.
TEST_F(CliVerify, ForgivesALimitThatIsBrokenByAHair) {
  write("tent.obj", "v -2 -2 1\nv 2 -2 1\nv 0 2 1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto codes_with_floor_at = [&](const std::string& height) {
    write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [" + height + ", 20]}\n");
    return std::pair(run({"prove", "mission.yaml", "tent.obj"}).exit_code,
                     run({"verify", "mission.yaml", "tent.obj", "--points", "1"}).exit_code);
  };
  EXPECT_EQ(codes_with_floor_at("1.0000001"), std::pair(1, 0));
  EXPECT_EQ(codes_with_floor_at("1.001"), std::pair(1, 1));
}

TEST_F(CliVerify, FailsAMeshThatIsNoSolid) {
  write("open.obj", "v 0 0 1\nv 5 0 1\nv 0 5 1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  const ProgramRun result = run({"verify", "mission.yaml", "open.obj"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("WRONG"), std::string::npos) << result.out << result.err;
  testing::expect_wording(lines(result.out).back());
  const auto json = nlohmann::json::parse(run({"verify", "mission.yaml", "open.obj", "--json"}).out);
  EXPECT_EQ(json.at("open_edges"), 3);
  const auto witness = json.at("open_edge_at").get<std::vector<double>>();
  EXPECT_NEAR(witness.at(0), 0, 2.5);
  write("turned.obj", "v 0 0 1\nv 5 0 1\nv 0 5 1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\n");
  EXPECT_EQ(run({"verify", "mission.yaml", "turned.obj"}).exit_code, 1);
}

TEST_F(CliVerify, LooksFromWhereTheTargetWasRaisedTo) {
  const std::string low =
      "target: {vertices: [[-4, -4, -0.0015], [4, -4, -0.0015], [4, 4, -0.0015], [-4, 4, -0.0015]]}\n";
  write("low.yaml", std::string(kScene) + low + kSensor);
  output_of({"compute", "low.yaml", "-q", "-o", "low.ply"});
  const auto report = nlohmann::json::parse(output_of({"verify", "low.yaml", "low.ply", "--points", "500", "--json"}));
  EXPECT_NEAR(report.at("lift_m").get<double>(), 0.0015, 2e-6);
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500", "--lift", "0"}).exit_code, 1);
  fs::rename(folder_ / "low.ply", folder_ / "renamed.ply");
  EXPECT_EQ(run({"verify", "low.yaml", "renamed.ply", "--points", "500"}).exit_code, 0) << "the file says it";

  std::string bytes = content(folder_ / "renamed.ply");
  std::string raised = bytes;
  const std::size_t lift = raised.find("\"lift_m\":[0.0") + 10;
  raised.replace(lift, 3, "9.0");
  write("raised.ply", raised);
  expect_bad({"verify", "low.yaml", "raised.ply"}, "raised.ply");
  expect_bad({"prove", "low.yaml", "raised.ply"}, "raised.ply");

  // A file without the statement, as older ones: the report beside it says it.
  for (std::size_t at; (at = bytes.find("comment vantage volume: ")) != std::string::npos;) {
    bytes.erase(at, bytes.find('\n', at) + 1 - at);
  }
  write("low.ply", bytes);
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500"}).exit_code, 0);
  fs::remove(folder_ / "low.report.json");
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500"}).exit_code, 1);
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500", "--lift", "0.001501"}).exit_code, 0);
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500", "--lift", "1.501 mm"}).exit_code, 0);
  expect_bad({"verify", "low.yaml", "low.ply", "--lift", "1 yd"}, "command line");
  for (const char* text : {"", "[]", "{}", "{\"lift_m\": \"far\"}", "{\"lift_m\": -1}", "{\"lift_m\": 1}"}) {
    write("low.report.json", text);
    expect_bad({"verify", "low.yaml", "low.ply"}, "low.report.json");
  }
}

TEST_F(CliVerify, RefusesWhatIsNoMesh) {
  expect_bad({"verify", "mission.yaml", "none.ply"}, "none.ply");
  expect_bad({"verify", "mission.yaml", "volume.ply"}, "volume.ply");
}

TEST_F(Cli, TheExampleIsWhatItsScriptMakes) {
  options_.folder = testing::source_folder() / "examples" / "plaza";
  const ProgramRun made = run_program("/bin/sh", {"-c", "python3 make_scene.py"}, options_);
  if (made.exit_code == 127) GTEST_SKIP() << "no python3";
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(made.out == content(options_.folder / "plaza.obj"));
}

TEST_F(Cli, TheExampleWorks) {
  const fs::path example = testing::source_folder() / "examples" / "plaza";
  const std::string mission = (example / "mission.yaml").string();
  const auto report = nlohmann::json::parse(output_of({"compute", mission, "-o", "volume.ply", "--json"}));
  EXPECT_EQ(report.at("outcome"), "computed");
  EXPECT_GT(report.at("causes").size(), 10U);
  EXPECT_EQ(run({"verify", mission, "volume.ply", "--points", "5000"}).exit_code, 0);
  const std::vector<std::string> rows = lines(output_of({"query", mission, (example / "points.csv").string()}));
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_NE(rows[1].find(",true,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find("inn"), std::string::npos) << rows[2];
}

TEST_F(Cli, TheTownIsWhatItsScriptMakes) {
  options_.folder = testing::source_folder() / "examples" / "town";
  const ProgramRun made = run_program("/bin/sh", {"-c", "python3 make_map.py"}, options_);
  if (made.exit_code == 127) GTEST_SKIP() << "no python3";
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(made.out == content(options_.folder / "town.osm"));
}

TEST_F(Cli, TheTownWorks) {
  const fs::path example = testing::source_folder() / "examples" / "town";
  const auto scene =
      nlohmann::json::parse(output_of({"scene", (example / "town.osm").string(), "-o", "town.glb", "--json"}));
  EXPECT_EQ(scene.at("kinds").at("building"), 9) << "one has parts";
  EXPECT_EQ(scene.at("kinds").at("building part"), 2);
  EXPECT_EQ(scene.at("ledger").size(), 1U) << "a height that is none: " << scene.at("ledger");

  const std::string mission = (example / "mission.yaml").string();
  const auto report = nlohmann::json::parse(output_of({"compute", mission, "-o", "volume.ply", "--json", "-q"}));
  EXPECT_EQ(report.at("outcome"), "computed");
  EXPECT_NEAR(report.at("georeference").at("latitude_deg"), 48, 1e-9);
  EXPECT_GT(report.at("causes").size(), 5U);
  EXPECT_EQ(run({"verify", mission, "volume.ply", "--points", "5000"}).exit_code, 0);
}

}  // namespace
}  // namespace vantage::testing
