// The program as a user meets it: exit codes, what it says, and which files it touches.
#include <array>
#include <csignal>

#include "common/output.h"
#include "support/cli_fixture.h"
#include "vantage/version.h"

namespace vantage::testing {
namespace {

using CliUsage = Cli;
using CliBadMission = Cli;
using CliBadMesh = Cli;
using CliBadOutput = Cli;
using CliSignals = Cli;

constexpr std::array kCommands = {"scene",   "inspect", "compute", "query",   "verify",
                                  "compare", "devices", "cameras", "spheres", "render",
                                  "stand",   "orbit",   "check",   "tour",    "verify-tour"};

TEST_F(CliUsage, HelpShowsExamples) {
  EXPECT_NE(output_of({"--help"}).find("EXAMPLES"), std::string::npos);
  for (const char* command : kCommands) {
    const std::string help = output_of({command, "--help"});
    EXPECT_NE(help.find("EXAMPLES"), std::string::npos) << command;
    EXPECT_NE(help.find(std::string("vantage ") + command + " "), std::string::npos) << command;
    for (const char* option : {"--threads", "--quiet", "--progress"}) {
      EXPECT_NE(help.find(option), std::string::npos) << command << option;
    }
  }
}

TEST_F(CliUsage, Version) {
  EXPECT_EQ(output_of({"--version"}), "vantage " VANTAGE_VERSION "\n");
  EXPECT_EQ(output_of({"version"}), output_of({"--version"}));
}

TEST_F(CliUsage, HelpIsACommandToo) {
  EXPECT_EQ(output_of({"help"}), output_of({"--help"}));
  for (const char* command : kCommands) EXPECT_EQ(output_of({"help", command}), output_of({command, "--help"}));
  expect_bad({"help", "comptue"}, "command line");
  expect_bad({"comptue", "--help"}, "command line");
  EXPECT_NE(output_of({"help", "--help"}), output_of({"--help"}));
}

TEST_F(CliUsage, BatchIsOfThePythonPackage) { expect_bad({"batch", "targets.parquet"}, "command line"); }

TEST_F(CliUsage, MisspeltOptionsGetASuggestion) {
  const auto expect_suggestion = [&](const std::vector<std::string>& arguments, const std::string& suggestion) {
    const std::string said = expect_bad(arguments, "command line");
    EXPECT_NE(said.find(suggestion), std::string::npos) << said;
  };
  expect_suggestion({"compute", "mission.yaml", "--ouput", "v.ply"}, "'--output'");
  expect_suggestion({"compute", "mission.yaml", "--out", "v.ply"}, "'--output'");
  expect_suggestion({"compute", "mission.yaml", "--out=v.ply"}, "'--output'");
  expect_suggestion({"compute", "mission.yaml", "-output", "v.ply"}, "'--output'");
  expect_suggestion({"compute", "mission.yaml", "-o", "v.ply", "--jsn"}, "'--json'");
  expect_suggestion({"compute", "mission.yaml", "-o", "v.ply", "--thread", "2"}, "'--threads'");
  expect_suggestion({"verify", "mission.yaml", "v.ply", "-points", "9"}, "'--points'");
  expect_suggestion({"scene", "city.osm", "--centre", "1,2", "-o", "a.glb"}, "'--center'");
  expect_suggestion({"compute", "mission.yaml", "-o", "v.ply", "--points", "9"}, "'vantage verify'");
  expect_suggestion({"scene", "city.osm", "--center", "48.1,", "11.5", "-o", "a.glb"}, "48.1,11.5");
  expect_suggestion({"--verison"}, "'--version'");
  expect_suggestion({"compute", "mission.yaml", "-o", "v.ply", "--xyzzy"}, "vantage compute --help");
  expect_suggestion({"compute", "mission.yaml", "-o", "v.ply", "extra.ply"}, "vantage compute --help");
}

/// Rows of the table of exit codes, as "0 done", from a text whose words they are.
std::string words_of(const std::string& text) {
  std::string words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (word != "|") words += word + " ";
  }
  return words;
}

TEST_F(CliUsage, OneTableOfExitCodesForAll) {
  std::string table = output_of({"--help"});
  table = table.substr(table.find("EXIT CODES"));
  const std::string after = table.substr(0, table.find("After 2"));
  for (const char* command : kCommands) {
    EXPECT_TRUE(output_of({command, "--help"}).ends_with(table)) << command;
  }
  const std::string page = words_of(content(source_folder() / "docs" / "command-line.md"));
  EXPECT_NE(page.find(words_of(after.substr(std::string("EXIT CODES").size()))), std::string::npos)
      << "docs/command-line.md has another table than\n"
      << table;
}

TEST_F(CliUsage, EveryCommandObeysTheTable) {
  write("box.obj",
        "v -4 -4 1\nv 50 -4 1\nv 50 4 1\nv -4 4 1\nv -4 -4 20\nv 50 -4 20\nv 50 4 20\nv -4 4 20\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  write("near.yaml", std::string(kScene) + kTarget + "sensor: {max_range: 5}\n");
  write("config.yaml", "camera: []\n");
  const auto code = [&](const std::vector<std::string>& arguments) { return run(arguments).exit_code; };
  EXPECT_EQ(code({"scene", "city.obj", "-o", "scene.glb"}), 0);
  EXPECT_EQ(code({"scene", "none.osm", "-o", "scene.glb"}), 2);
  EXPECT_EQ(code({"inspect", "city.obj"}), 0);
  EXPECT_EQ(code({"inspect", "none.obj"}), 2);
  EXPECT_EQ(code({"compute", "mission.yaml", "-o", "v.ply"}), 0);
  EXPECT_EQ(code({"compute", "near.yaml", "-o", "none.ply"}), 1);
  EXPECT_EQ(code({"compute", "near.yaml", "-o", "none.ply", "--fail-empty"}), 1);
  EXPECT_EQ(code({"compute", "mission.yaml", "-o", "v.ply", "--fail-empty"}), 0);
  EXPECT_EQ(code({"compute", "none.yaml", "-o", "v.ply", "--fail-empty"}), 2);
  EXPECT_EQ(code({"query", "mission.yaml", "-"}), 0);
  EXPECT_EQ(code({"query", "mission.yaml", "none.csv"}), 2);
  EXPECT_EQ(code({"verify", "mission.yaml", "v.ply", "--points", "500"}), 0);
  EXPECT_EQ(code({"verify", "mission.yaml", "box.obj", "--points", "500"}), 1);
  EXPECT_EQ(code({"verify", "mission.yaml", "none.ply"}), 2);
  EXPECT_EQ(code({"compare", "v.ply", "box.obj"}), 0);
  EXPECT_EQ(code({"compare", "v.ply", "none.obj"}), 2);
  EXPECT_EQ(code({"devices"}), 0);
  EXPECT_EQ(code({"devices", "--device", "99"}), 2);
  EXPECT_EQ(code({"cameras"}), 0);
  EXPECT_EQ(code({"cameras", "none.json"}), 2);
  EXPECT_EQ(code({"spheres", "-c", "config.yaml"}), 2);
  EXPECT_EQ(code({"render", "none.yaml", "-o", "p.png"}), 2);
  for (const char* command : kCommands) {
    EXPECT_EQ(code({command, "--unknown"}), 2) << command;
    EXPECT_EQ(code({command, "--help"}), 0) << command;
  }
}

TEST_F(CliUsage, AMissionFromStandardInput) {
  output_of({"compute", "mission.yaml", "-q", "-o", "a.ply"});
  options_.input = content(folder_ / "mission.yaml");
  output_of({"compute", "-", "-q", "-o", "b.ply"});
  EXPECT_TRUE(content(folder_ / "a.ply") == content(folder_ / "b.ply"));
  EXPECT_EQ(nlohmann::json::parse(content(folder_ / "b.report.json")).at("mission"), "standard input");
  EXPECT_EQ(run({"verify", "-", "a.ply", "--points", "200"}).exit_code, 0);
  write("points.csv", "0,0,30\n");
  EXPECT_EQ(output_of({"query", "-", "points.csv"}), output_of({"query", "mission.yaml", "points.csv"}));
  expect_bad({"query", "-", "-"}, "command line");
  options_.input = std::string(kScene) + kTarget + "sensor: {max_rnage: 60}\n";
  expect_bad({"compute", "-", "-o", "volume.ply"}, "standard input:5:10");
  options_.input.assign(std::size_t{3} << 20, '#');
  expect_bad({"compute", "-", "-o", "volume.ply"}, "standard input");
  options_.input = "";
  expect_bad({"compute", "-", "-o", "volume.ply"}, "standard input");
}

TEST_F(CliUsage, AVolumeToStandardOutput) {
  for (const std::string& format : mesh_format_words()) {
    output_of({"compute", "mission.yaml", "-q", "-o", "v." + format});
    const auto before = files();
    EXPECT_TRUE(output_of({"compute", "mission.yaml", "-q", "-o", "-", "--format", format}) ==
                content(folder_ / ("v." + format)));
    EXPECT_TRUE(files() == before) << "a file was left";
  }
  const ProgramRun told = run({"compute", "mission.yaml", "-o", "-", "--format", "ply", "--report", "r.json"});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_TRUE(told.out == content(folder_ / "v.ply"));
  EXPECT_NE(told.err.find("cubic metres"), std::string::npos) << told.err;
  auto report = nlohmann::json::parse(content(folder_ / "r.json"));
  auto expected = nlohmann::json::parse(content(folder_ / "v.report.json"));
  for (auto* json : {&report, &expected}) {
    json->erase("seconds");
    json->erase("volume");
  }
  EXPECT_EQ(report, expected);
  const std::string both = output_of({"compute", "mission.yaml", "-q", "-o", "-", "--format", "ply", "-o", "w.ply"});
  EXPECT_TRUE(both == content(folder_ / "w.ply"));

  expect_bad({"compute", "mission.yaml", "-o", "-"}, "-o -");
  expect_bad({"compute", "mission.yaml", "-o", "-", "--format", "xyz"}, "command line");
  expect_bad({"compute", "mission.yaml", "-o", "v.ply", "--format", "ply"}, "--format");
  expect_bad({"compute", "mission.yaml", "-o", "v.ply", "--report", "r.json"}, "--report");
  expect_bad({"compute", "mission.yaml", "-o", "-", "--format", "ply", "--json"}, "--json");
  expect_bad({"compute", "mission.yaml", "-o", "-", "--format", "ply", "-o", "-"}, "-");
  write("near.yaml", std::string(kScene) + kTarget + "sensor: {max_range: 5}\n");
  const ProgramRun empty = run({"compute", "near.yaml", "-q", "-o", "-", "--format", "ply"});
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_NE(empty.err.find("what to try: "), std::string::npos) << empty.err;
  EXPECT_EQ(empty.out, "");
}

TEST_F(CliUsage, RefusesStandardStreamsWhereTheyMeanNothing) {
  expect_bad({"inspect", "-"}, "-");
  expect_bad({"verify", "mission.yaml", "-"}, "-");
  expect_bad({"compare", "city.obj", "-"}, "-");
  expect_bad({"spheres", "-c", "-"}, "-");
  expect_bad({"compare", "city.obj", "city.obj", "--only-a", "-"}, "-");
}

TEST_F(CliUsage, Mistakes) {
  expect_bad({}, "command line");
  expect_bad({"comptue"}, "command line");
  expect_bad({"inspect", "city.obj", "--sacle", "2"}, "command line");
  expect_bad({"--colour", "inspect"}, "command line");
  expect_bad({"inspect"}, "command line");
  expect_bad({"inspect", "city.obj", "--up", "x"}, "command line");
  expect_bad({"inspect", "city.obj", "--scale", "nan"}, "--scale");
  expect_bad({"inspect", "city.obj", "--scale", "-1"}, "--scale");
  expect_bad({"inspect", "city.obj", "--threads", "-1"}, "command line");
  expect_bad({"compute", "mission.yaml"}, "command line");
  expect_bad({"verify", "mission.yaml"}, "command line");
  expect_bad({"verify", "mission.yaml", "volume.ply", "--points", "0"}, "command line");
  expect_bad({"query", "mission.yaml"}, "command line");
}

TEST_F(CliBadMission, MissingOrUnreadable) {
  expect_bad({"compute", "none.yaml", "-o", "volume.ply"}, "none.yaml");
  expect_bad({"compute", ".", "-o", "volume.ply"}, ".");
  expect_bad({"query", "none.yaml", "-"}, "none.yaml");
  expect_bad({"verify", "none.yaml", "city.obj"}, "none.yaml");
  become_nobody();
  if (!run({"--version"}).was_started) GTEST_SKIP() << "the program is out of reach of a user without rights";
  fs::permissions(folder_ / "mission.yaml", fs::perms::none);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "mission.yaml");
  fs::permissions(folder_ / "mission.yaml", fs::perms::all);
  fs::permissions(folder_ / "city.obj", fs::perms::none);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "city.obj");
  expect_bad({"inspect", "city.obj"}, "city.obj");
}

TEST_F(CliBadMission, MissingScene) {
  expect_bad_mission(std::string("scene: {mesh: none.obj}\n") + kTarget + kSensor, "mission.yaml:1:15");
  expect_bad_mission(std::string("scene: {mesh: .}\n") + kTarget + kSensor, "mission.yaml:1:15");
}

TEST_F(CliBadMission, KeysAndTypes) {
  const std::string start = std::string(kScene) + kTarget;
  expect_bad_mission(start + "sensor: {max_rnage: 60}\n", "mission.yaml:5:10");
  expect_bad_mission(start + "sensor: {max_range: far}\n", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: .nan}\n", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: .inf}\n", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {}\n", "mission.yaml:5:9");
  expect_bad_mission(start + "sensor: {max_range: 0}\n", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: -60}\n", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: 1,000}\n", "mission.yaml:5:23");
  expect_bad_mission(start + "sensor: {max_range: 60, camera: dji_mini_4_pro}\n", "mission.yaml:5:33");
  expect_bad_mission(start + kSensor + "navigation: {altitude: [120, 20]}\n", "mission.yaml:6:24");
  expect_bad_mission(start + kSensor + "navigation: {boxes: [{min: [0, 0, 9], max: [1, 1, 8]}]}\n",
                     "mission.yaml:6:22");
}

TEST_F(CliBadMission, Vertices) {
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0]]");
  expect_bad_vertices("[[0, 0, 0], [9, 0, .nan], [9, 9, 0]]", "mission.yaml:4:32");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [9, 9, 0.5], [0, 9, 0]]");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [2, 2, 0], [0, 9, 0]]");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [9, 0, 0], [0, 9, 0]]");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [4, 0, 0]]");
}

TEST_F(CliBadMission, Edges) {
  expect_bad_mission(std::string(kScene) + kTarget + "  edges: [[0, 2], [2, 1], [1, 3], [3, 0]]\n" + kSensor,
                     "mission.yaml:5:11");
}

TEST_F(CliBadMission, TargetsThatTheSceneRefuses) {
  const auto expect_bad_square = [&](const std::string& centre_x, const std::string& z) {
    const std::string mission = std::string(kScene) + kSensor + "target:\n  vertices: [";
    const double x = std::stod(centre_x);
    std::string vertices;
    for (const auto& [dx, dy] : {std::pair(-9, -9), {9, -9}, {9, 9}, {-9, 9}}) {
      vertices +=
          (vertices.empty() ? "[" : ", [") + std::to_string(x + dx) + ", " + std::to_string(dy) + ", " + z + "]";
    }
    expect_bad_mission(mission + vertices + "]\n", "mission.yaml:4:13, target \"target\"");
  };
  expect_bad_square("25", "0");
  expect_bad_square("25", "6");
  expect_bad_square("25", "10");
}

using CliNotes = Cli;

TEST_F(CliNotes, ATargetUnderTheGroundIsToldAndComputed) {
  write("buried.yaml",
        std::string(kScene) + kSensor + "target:\n  vertices: [[-5, -5, -2], [5, -5, -2], [5, 5, -2], [-5, 5, -2]]\n");
  const ProgramRun shown = run({"compute", "buried.yaml", "-o", "out.ply"});
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_NE(shown.err.find("offset: 2.00"), std::string::npos) << shown.err;
  const auto report = nlohmann::json::parse(run({"compute", "buried.yaml", "-o", "out.ply", "--json"}).out);
  ASSERT_EQ(report.at("notes").size(), 1U);
  EXPECT_EQ(report.at("note_codes"), nlohmann::json({name_of(WarningCode::target_underground)}));
  testing::expect_wording(report.at("notes")[0].get<std::string>());
  EXPECT_EQ(report.at("outcome"), "computed");
}

TEST_F(CliBadMission, NavigationMeshes) {
  const std::string mission = std::string(kScene) + kTarget + kSensor + "navigation: {meshes: [zone.obj]}\n";
  expect_bad_mission(mission, "mission.yaml:6:23");
  const std::string corners = "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nv 0 0 40\n";
  write("zone.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n");  // a side is missing
  expect_bad_mission(mission, "mission.yaml:6:23, zone.obj");
  const std::string solid = corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  write("zone.obj",
        solid + "v -9 -9 5\nv 9 -9 5\nv 0 9 5\nv 0 0 45\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");  // two that meet
  expect_bad_mission(mission, "mission.yaml:6:23, zone.obj");
  write("zone.obj", solid);
  EXPECT_EQ(run({"compute", "mission.yaml", "-o", "volume.ply"}).exit_code, 0) << "the solid alone is fine";
}

TEST_F(CliBadMesh, EmptyAndGarbage) {
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf", "a.obj.gz", "a.txt"}) {
    expect_bad_scene(name, "");
    std::string garbage;
    for (unsigned i = 0, state = 12345; i < 5000; ++i) {
      state = state * 1103515245U + 12345U;
      garbage += static_cast<char>(state >> 16);
    }
    expect_bad_scene(name, garbage);
  }
}

TEST_F(CliBadMesh, Truncated) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  expect_bad_scene("a.ply", header + std::string(20, '\1'));
  expect_bad_scene("a.ply", header.substr(0, 60));
  expect_bad_scene("a.stl", std::string(80, ' ') + std::string("\x05\0\0\0", 4) + std::string(60, '\0'));
  expect_bad_scene("a.glb", std::string("glTF\x02\0\0\0\x00\x10\0\0", 12));
  expect_bad_scene("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [");
  expect_bad_scene("a.obj.gz", std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\x4b", 11));
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n");
}

TEST_F(CliBadMesh, HugeIndicesAndCounts) {
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999999\n");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n");
  expect_bad_scene("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n");
  expect_bad_scene(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
}

TEST_F(CliBadMesh, NotFinite) {
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 1e999\nv 0 1 0\nf 1 2 3\n");
}

TEST_F(CliBadOutput, IsFoundBeforeComputing) {
  fs::create_directory(folder_ / "folder");
  fs::create_directory(folder_ / "folder.ply");
  expect_bad({"compute", "mission.yaml", "-o", "folder"}, "folder");
  expect_bad({"compute", "mission.yaml", "-o", "folder.ply"}, "folder.ply");
  expect_bad({"compute", "mission.yaml", "-o", "none/volume.ply"}, "none/volume.ply");
  expect_bad({"compute", "mission.yaml", "-o", "volume.xyz"}, "volume.xyz");
  expect_bad({"compute", "mission.yaml", "-o", "volume"}, "volume");
  expect_bad({"compute", "mission.yaml", "-o", "/dev/null"}, "/dev/null");
  expect_bad({"compute", "mission.yaml", "-o", "a.ply", "-o", "./a.ply"}, "a.ply");
  expect_bad({"compute", "mission.yaml", "-o", "a.ply", "-o", "none/b.ply"}, "none/b.ply");
  fs::create_directory(folder_ / "b.report.json");
  expect_bad({"compute", "mission.yaml", "-o", "b.ply"}, "b.report.json");
  expect_bad({"query", "mission.yaml", "-", "-o", "folder"}, "folder");
}

TEST_F(CliBadOutput, WouldDestroyAnInput) {
  expect_bad({"compute", "mission.yaml", "-o", "city.obj"}, "city.obj");
  expect_bad({"compute", "mission.yaml", "-o", "./folder/../city.obj"}, "city.obj");
  write("points.csv", "0,0,9\n");
  expect_bad({"query", "mission.yaml", "points.csv", "-o", "points.csv"}, "points.csv");
  expect_bad({"query", "mission.yaml", "points.csv", "-o", "mission.yaml"}, "mission.yaml");
}

TEST_F(CliBadOutput, WriteProtected) {
  become_nobody();
  if (!run({"--version"}).was_started) GTEST_SKIP() << "the program is out of reach of a user without rights";
  fs::permissions(folder_ / "volume.ply", fs::perms::owner_read | fs::perms::others_read);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "volume.ply");
  fs::permissions(folder_, fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec);
  fs::permissions(folder_, fs::perms::owner_write, ::geteuid() == 0 ? fs::perm_options::add : fs::perm_options::remove);
  expect_bad({"compute", "mission.yaml", "-o", "new.ply"}, "new.ply");
  fs::permissions(folder_, fs::perms::all);
}

TEST_F(CliBadOutput, FullDisk) {
  options_.largest_file = 2000;  // enough for messages, not for a volume
  expect_bad({"compute", "mission.yaml", "-q", "-o", "volume.ply"}, "volume.ply");
  expect_bad({"compute", "mission.yaml", "-q", "-o", "volume.glb"}, "volume.glb");
  options_.largest_file.reset();
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  options_.out_file = "/dev/full";
  expect_bad({"inspect", "city.obj"}, "standard output");
}

/// So many blocks that reading and preparing them takes a while.
std::string large_city() {
  std::ostringstream text;
  for (int block = 0; block < 5000; ++block) {
    const int x = 20 + block % 70 * 10, y = 20 + block / 70 * 10;
    for (int z : {0, 9}) {
      text << "v " << x << ' ' << y << ' ' << z << "\nv " << x + 5 << ' ' << y << ' ' << z << "\nv " << x + 5 << ' '
           << y + 5 << ' ' << z << "\nv " << x << ' ' << y + 5 << ' ' << z << '\n';
    }
    text << "f -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
  }
  return text.str();
}

TEST_F(CliSignals, AskTheProgramToEnd) {
  write("large.obj", large_city());
  write("mission.yaml", std::string("scene: {mesh: large.obj}\n") + kTarget + kSensor);
  options_.signal_when = [](const std::string& err) { return !err.empty(); };
  const auto before = files();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    options_.signal = signal;
    const ProgramRun result = run({"compute", "mission.yaml", "--progress", "-o", "volume.ply"});
    EXPECT_EQ(result.exit_code, 128 + signal);
    testing::expect_wording(lines(result.err).back());
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(files() == before) << "signal " << signal;
  }
}

TEST_F(CliSignals, LeaveAllFilesOrNone) {
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "exact: {tolerance: 0.001}\n");
  const std::vector<std::string> names = {"a.ply", "a.obj", "a.stl", "a.glb", "a.report.json"};
  const auto old = [](const std::string& name) { return name.ends_with(".json") ? kOldReport : kOldOutput; };
  for (const std::string& name : names) write(name, old(name));
  options_.signal = SIGTERM;
  options_.signal_when = [&](const std::string&) {  // while files are tried or put in place
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (entry.path().filename().string().rfind(".a.ply.", 0) == 0) return true;
    }
    return false;
  };
  const std::size_t count = files().size();
  const ProgramRun result =
      run({"compute", "mission.yaml", "-q", "-o", "a.ply", "-o", "a.obj", "-o", "a.stl", "-o", "a.glb"});
  // Before the program notes signals, and when all is done and it is about to end, one ends it.
  const bool is_ended = result.exit_code == -SIGTERM;
  ASSERT_TRUE(is_ended || result.exit_code == 0 || result.exit_code == 128 + SIGTERM) << result.exit_code << result.err;
  const bool is_done = is_ended ? content(folder_ / "a.ply") != old("a.ply") : result.exit_code == 0;
  for (const std::string& name : names) EXPECT_EQ(content(folder_ / name) == old(name), !is_done) << name;
  const std::size_t place_of_stl = is_done ? 1 : 0;
  std::string left;
  for (const auto& [name, text] : files()) left += name + " ";
  EXPECT_EQ(files().size(), count + place_of_stl) << "exit " << result.exit_code << ", left: " << left;
}

}  // namespace
}  // namespace vantage::testing
