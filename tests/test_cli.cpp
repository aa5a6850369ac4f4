// The program as a user meets it: exit codes, what it says, and which files it touches.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace {

namespace fs = std::filesystem;
using vantage::testing::ProgramRun;
using vantage::testing::RunOptions;

// A ground of 200 m, and on it a block of 10 x 10 x 12 m named "block".
constexpr const char* kCity =
    "o ground\nv -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n"
    "o block\nv 20 -5 0\nv 30 -5 0\nv 30 5 0\nv 20 5 0\nv 20 -5 12\nv 30 -5 12\nv 30 5 12\nv 20 5 12\n"
    "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
constexpr const char* kScene = "scene: {mesh: city.obj}\n";
constexpr const char* kTarget =
    "target:\n  name: square\n  vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]\n";
constexpr const char* kSensor = "sensor: {max_range: 60}\n";
constexpr const char* kOldOutput = "an old volume, precious\n";

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "vantage-cli-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    write("city.obj", kCity);
    write("mission.yaml", std::string(kScene) + kTarget + kSensor);
    write("volume.ply", kOldOutput);
    write("volume.report.json", kOldOutput);
    options_.folder = folder_;
  }
  void TearDown() override {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  ProgramRun run(const std::vector<std::string>& arguments) const {
    ProgramRun result = vantage::testing::run_program(VANTAGE_CLI, arguments, options_);
    EXPECT_FALSE(result.timed_out);
    return result;
  }

  /// From here on permissions count, whoever runs the tests.
  void become_nobody() {
    options_.as_nobody = true;
    fs::permissions(folder_, fs::perms::all);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      fs::permissions(entry.path(), fs::perms::all);
    }
  }

  /// Runs, and expects success with nothing on standard error.
  std::string output_of(const std::vector<std::string>& arguments) const {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }

  /// All files of the folder and what they hold.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> result;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
      result[entry.path().string()] = entry.is_regular_file() ? content(entry.path()) : "";
    }
    return result;
  }

  /// Expects exit code 2, the three lines, nothing on standard output, and every file as it was.
  void expect_bad(const std::vector<std::string>& arguments, const std::string& what, const std::string& where = "",
                  const std::string& fix = "") {
    const auto before = files();
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> said = lines(result.err);
    ASSERT_EQ(said.size(), 3U) << result.err;
    EXPECT_EQ(said[0].rfind("vantage: ", 0), 0U) << result.err;
    EXPECT_EQ(said[1].rfind("  where: ", 0), 0U) << result.err;
    EXPECT_EQ(said[2].rfind("  what to do: ", 0), 0U) << result.err;
    EXPECT_GT(said[1].size(), 9U);
    EXPECT_GT(said[2].size(), 14U);
    EXPECT_NE(said[0].find(what), std::string::npos) << result.err;
    EXPECT_NE(said[1].find(where), std::string::npos) << result.err;
    EXPECT_NE(said[2].find(fix), std::string::npos) << result.err;
    EXPECT_TRUE(files() == before) << "a file was touched";
  }

  /// expect_bad of computing a mission with this text over the old output.
  void expect_bad_mission(const std::string& text, const std::string& what, const std::string& where = "mission.yaml",
                          const std::string& fix = "") {
    write("mission.yaml", text);
    expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, what, where, fix);
  }
  void expect_bad_vertices(const std::string& vertices, const std::string& what,
                           const std::string& where = "mission.yaml:4:13") {
    expect_bad_mission(std::string(kScene) + kSensor + "target:\n  vertices: " + vertices + "\n", what, where);
  }

  /// expect_bad of a mission whose scene is a file with this content.
  void expect_bad_scene(const std::string& name, const std::string& bytes, const std::string& what) {
    write(name, bytes);
    expect_bad_mission("scene: {mesh: " + name + "}\n" + kTarget + kSensor, what, name);
    expect_bad({"inspect", name}, what, name);
  }

  fs::path folder_;
  RunOptions options_;
};

using CliUsage = Cli;
using CliBadMission = Cli;
using CliBadMesh = Cli;
using CliBadOutput = Cli;
using CliCompute = Cli;
using CliInspect = Cli;
using CliQuery = Cli;
using CliVerify = Cli;

TEST_F(CliUsage, HelpShowsExamples) {
  EXPECT_NE(output_of({"--help"}).find("EXAMPLES"), std::string::npos);
  for (const char* command : {"inspect", "compute", "query", "verify"}) {
    const std::string help = output_of({command, "--help"});
    EXPECT_NE(help.find("EXAMPLES"), std::string::npos) << command;
    EXPECT_NE(help.find(std::string("vantage ") + command + " "), std::string::npos) << command;
    for (const char* option : {"--threads", "--quiet", "--progress"}) {
      EXPECT_NE(help.find(option), std::string::npos) << command << option;
    }
  }
}

TEST_F(CliUsage, Version) { EXPECT_EQ(output_of({"--version"}), "vantage " VANTAGE_VERSION "\n"); }

TEST_F(CliUsage, Mistakes) {
  expect_bad({}, "no command is given", "command line", "vantage --help");
  expect_bad({"comptue"}, "there is no command 'comptue'", "command line", "did you mean 'compute'?");
  expect_bad({"inspect", "city.obj", "--sacle", "2"}, "--sacle", "command line", "vantage inspect --help");
  expect_bad({"--colour", "inspect"}, "", "command line");
  expect_bad({"inspect"}, "scene", "command line", "vantage inspect --help");
  expect_bad({"inspect", "city.obj", "--up", "x"}, "--up", "command line");
  expect_bad({"inspect", "city.obj", "--scale", "nan"}, "--scale must be a positive number, not 'nan'", "--scale");
  expect_bad({"inspect", "city.obj", "--scale", "-1"}, "--scale must be a positive number, not '-1'", "--scale");
  expect_bad({"inspect", "city.obj", "--threads", "-1"}, "--threads", "command line");
  expect_bad({"compute", "mission.yaml"}, "--output", "command line", "vantage compute --help");
  expect_bad({"verify", "mission.yaml"}, "volume", "command line", "vantage verify --help");
  expect_bad({"verify", "mission.yaml", "volume.ply", "--points", "0"}, "--points", "command line");
  expect_bad({"query", "mission.yaml"}, "points", "command line", "vantage query --help");
}

TEST_F(CliBadMission, MissingOrUnreadable) {
  expect_bad({"compute", "none.yaml", "-o", "volume.ply"}, "the mission file does not exist", "none.yaml");
  expect_bad({"compute", ".", "-o", "volume.ply"}, "the mission file is a folder", ".");
  expect_bad({"query", "none.yaml", "-"}, "the mission file does not exist", "none.yaml");
  expect_bad({"verify", "none.yaml", "city.obj"}, "the mission file does not exist", "none.yaml");
  become_nobody();
  if (!run({"--version"}).was_started) GTEST_SKIP() << "the program is out of reach of a user without rights";
  fs::permissions(folder_ / "mission.yaml", fs::perms::none);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "the mission file cannot be read", "mission.yaml");
  fs::permissions(folder_ / "mission.yaml", fs::perms::all);
  fs::permissions(folder_ / "city.obj", fs::perms::none);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "the scene's mesh file cannot be read", "city.obj");
  expect_bad({"inspect", "city.obj"}, "the scene file cannot be read", "city.obj");
}

TEST_F(CliBadMission, MissingScene) {
  expect_bad_mission(std::string("scene: {mesh: none.obj}\n") + kTarget + kSensor,
                     "the scene's mesh file does not exist", "mission.yaml:1:15");
  expect_bad_mission(std::string("scene: {mesh: .}\n") + kTarget + kSensor, "the scene's mesh file is a folder",
                     "mission.yaml:1:15");
}

TEST_F(CliBadMission, KeysAndTypes) {
  const std::string start = std::string(kScene) + kTarget;
  expect_bad_mission(start + "sensor: {max_rnage: 60}\n", "unknown key 'max_rnage' in sensor", "mission.yaml:5:10",
                     "did you mean 'max_range'?");
  expect_bad_mission(start + "sensor: {max_range: far}\n", "must be a number, not 'far'", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: .nan}\n", "is not finite", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: .inf}\n", "is not finite", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {}\n", "sensor lacks the key 'max_range'", "mission.yaml:5:9", "max_range: 100");
  expect_bad_mission(start + "sensor: {max_range: 0}\n", "must be greater than 0", "mission.yaml:5:21");
  expect_bad_mission(start + "sensor: {max_range: -60}\n", "must be greater than 0", "mission.yaml:5:21");
  expect_bad_mission(start + kSensor + "navigation: {altitude: [120, 20]}\n", "altitude is reversed",
                     "mission.yaml:6:24", "[20, 120]");
  expect_bad_mission(start + kSensor + "navigation: {boxes: [{min: [0, 0, 9], max: [1, 1, 8]}]}\n", "reversed in z",
                     "mission.yaml:6:22");
}

TEST_F(CliBadMission, Vertices) {
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0]]", "at least 3 vertices");
  expect_bad_vertices("[[0, 0, 0], [9, 0, .nan], [9, 9, 0]]", "vertices[1].z is not finite", "mission.yaml:4:32");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [9, 9, 0.5], [0, 9, 0]]", "vertex 2 is off by 0.1249 m");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [2, 2, 0], [0, 9, 0]]", "vertex 2");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [9, 0, 0], [0, 9, 0]]", "same point");
  expect_bad_vertices("[[0, 0, 0], [9, 0, 0], [4, 0, 0]]", "area");
}

TEST_F(CliBadMission, Edges) {
  expect_bad_mission(std::string(kScene) + kTarget + "  edges: [[0, 2], [2, 1], [1, 3], [3, 0]]\n" + kSensor,
                     "edge [0, 2] joins vertices that are not neighbours", "mission.yaml:5:11");
}

TEST_F(CliBadMission, TargetsThatTheSceneRefuses) {
  const auto expect_bad_square = [&](const std::string& centre_x, const std::string& z, const std::string& what,
                                     const std::string& fix) {
    const std::string mission = std::string(kScene) + kSensor + "target:\n  vertices: [";
    const double x = std::stod(centre_x);
    std::string vertices;
    for (const auto& [dx, dy] : {std::pair(-9, -9), {9, -9}, {9, 9}, {-9, 9}}) {
      vertices +=
          (vertices.empty() ? "[" : ", [") + std::to_string(x + dx) + ", " + std::to_string(dy) + ", " + z + "]";
    }
    expect_bad_mission(mission + vertices + "]\n", what, "mission.yaml:4:13, target \"target\"", fix);
  };
  expect_bad_square("25", "0", "\"block\" stands on or passes through the target", "offset: 12.001");
  expect_bad_square("25", "6", "\"block\" stands on or passes through the target", "offset: 6.001");
  expect_bad_square("0", "-0.5", "the target is under the ground", "raise the target");
}

TEST_F(CliBadMission, NavigationMeshes) {
  const std::string mission = std::string(kScene) + kTarget + kSensor + "navigation: {meshes: [zone.obj]}\n";
  expect_bad_mission(mission, "the navigation mesh does not exist", "mission.yaml:6:23");
  const std::string corners = "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nv 0 0 40\n";
  write("zone.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n");  // a side is missing
  expect_bad_mission(mission, "the mesh is open", "mission.yaml:6:23, zone.obj");
  const std::string solid = corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  write("zone.obj",
        solid + "v -9 -9 5\nv 9 -9 5\nv 0 9 5\nv 0 0 45\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");  // two that meet
  expect_bad_mission(mission, "the mesh intersects itself", "mission.yaml:6:23, zone.obj");
  write("zone.obj", solid);
  EXPECT_EQ(run({"compute", "mission.yaml", "-o", "volume.ply"}).exit_code, 0) << "the solid alone is fine";
}

TEST_F(CliBadMesh, EmptyAndGarbage) {
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf", "a.obj.gz", "a.txt"}) {
    expect_bad_scene(name, "", "");
    std::string garbage;
    for (unsigned i = 0, state = 12345; i < 5000; ++i) {
      state = state * 1103515245U + 12345U;
      garbage += static_cast<char>(state >> 16);
    }
    expect_bad_scene(name, garbage, "");
  }
}

TEST_F(CliBadMesh, Truncated) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  expect_bad_scene("a.ply", header + std::string(20, '\1'), "");
  expect_bad_scene("a.ply", header.substr(0, 60), "");
  expect_bad_scene("a.stl", std::string(80, ' ') + std::string("\x05\0\0\0", 4) + std::string(60, '\0'), "");
  expect_bad_scene("a.glb", std::string("glTF\x02\0\0\0\x00\x10\0\0", 12), "");
  expect_bad_scene("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [", "");
  expect_bad_scene("a.obj.gz", std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\x4b", 11), "");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "");
}

TEST_F(CliBadMesh, HugeIndicesAndCounts) {
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n", "");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999999\n", "");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", "");
  expect_bad_scene("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
                   "");
  expect_bad_scene("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
                   "");
}

TEST_F(CliBadMesh, NotFinite) {
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "");
  expect_bad_scene("a.obj", "v 0 0 0\nv 1 0 1e999\nv 0 1 0\nf 1 2 3\n", "");
}

TEST_F(CliBadOutput, IsFoundBeforeComputing) {
  fs::create_directory(folder_ / "folder");
  fs::create_directory(folder_ / "folder.ply");
  expect_bad({"compute", "mission.yaml", "-o", "folder"}, "the output is a folder", "folder");
  expect_bad({"compute", "mission.yaml", "-o", "folder.ply"}, "the output is a folder", "folder.ply");
  expect_bad({"compute", "mission.yaml", "-o", "none/volume.ply"}, "the output folder does not exist",
             "none/volume.ply", "mkdir -p none");
  expect_bad({"compute", "mission.yaml", "-o", "volume.xyz"}, "no format is known for the extension '.xyz'",
             "volume.xyz", ".ply, .obj, .stl or .glb");
  expect_bad({"compute", "mission.yaml", "-o", "volume"}, "no extension", "volume");
  expect_bad({"compute", "mission.yaml", "-o", "/dev/null"}, "", "/dev/null");
  expect_bad({"compute", "mission.yaml", "-o", "a.ply", "-o", "./a.ply"}, "named twice", "a.ply");
  expect_bad({"compute", "mission.yaml", "-o", "a.ply", "-o", "none/b.ply"}, "folder does not exist", "none/b.ply");
  fs::create_directory(folder_ / "b.report.json");
  expect_bad({"compute", "mission.yaml", "-o", "b.ply"}, "the output is a folder", "b.report.json");
  expect_bad({"query", "mission.yaml", "-", "-o", "folder"}, "the output is a folder", "folder");
}

TEST_F(CliBadOutput, WouldDestroyAnInput) {
  expect_bad({"compute", "mission.yaml", "-o", "city.obj"}, "overwrite an input", "city.obj", "another name");
  expect_bad({"compute", "mission.yaml", "-o", "./folder/../city.obj"}, "", "city.obj");
  write("points.csv", "0,0,9\n");
  expect_bad({"query", "mission.yaml", "points.csv", "-o", "points.csv"}, "overwrite an input", "points.csv");
  expect_bad({"query", "mission.yaml", "points.csv", "-o", "mission.yaml"}, "overwrite an input", "mission.yaml");
}

TEST_F(CliBadOutput, WriteProtected) {
  become_nobody();
  if (!run({"--version"}).was_started) GTEST_SKIP() << "the program is out of reach of a user without rights";
  fs::permissions(folder_ / "volume.ply", fs::perms::owner_read | fs::perms::others_read);
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "the output file is write-protected", "volume.ply");
  fs::permissions(folder_, fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec);
  fs::permissions(folder_, fs::perms::owner_write, ::geteuid() == 0 ? fs::perm_options::add : fs::perm_options::remove);
  expect_bad({"compute", "mission.yaml", "-o", "new.ply"}, "no file can be made in the output folder", "new.ply");
  fs::permissions(folder_, fs::perms::all);
}

TEST_F(CliBadOutput, FullDisk) {
  options_.largest_file = 2000;  // enough for messages, not for a volume
  expect_bad({"compute", "mission.yaml", "-q", "-o", "volume.ply"}, "", "volume.ply");
  expect_bad({"compute", "mission.yaml", "-q", "-o", "volume.glb"}, "", "volume.glb");
  options_.largest_file.reset();
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  options_.out_file = "/dev/full";
  expect_bad({"inspect", "city.obj"}, "could not be written", "standard output");
}

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
       {"volume", "pieces", "facets", "max_range", "block", "total", "wrote volume.ply", "wrote volume.report.json"}) {
    EXPECT_NE(summary.find(expected), std::string::npos) << summary;
  }
  EXPECT_EQ(content(folder_ / "volume.ply").substr(0, 4), "ply\n");
  const auto report = nlohmann::json::parse(content(folder_ / "volume.report.json"));
  EXPECT_EQ(report.at("outcome"), "computed");
  EXPECT_EQ(report.at("euler"), 2);
  EXPECT_EQ(report.at("pieces"), 1);
  // Within the half ball about the target's centre, and not without the air straight above.
  EXPECT_LT(report.at("volume_m3").get<double>(), 2.0 / 3 * 3.14159266 * 60 * 60 * 60);
  EXPECT_GT(report.at("volume_m3").get<double>(), 0.5 * 2 / 3 * 3.14159266 * 52 * 52 * 52);
  EXPECT_GT(report.at("seconds").at("total").get<double>(), 0.0);
  EXPECT_EQ(report.at("target"), "square");
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
  EXPECT_EQ(printed, nlohmann::json::parse(content(folder_ / "volume.report.json")));
}

TEST_F(CliCompute, DoesNotDependOnThreads) {
  output_of({"compute", "mission.yaml", "--threads", "1", "-o", "one.ply"});
  output_of({"compute", "mission.yaml", "--threads", "4", "-o", "four.ply"});
  EXPECT_TRUE(content(folder_ / "one.ply") == content(folder_ / "four.ply"));
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
  output_of({"compute", "mission.yaml", "-o", "volume.obj", "-o", "volume.ply"});
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
  for (const char* end : {"min", "max"}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(obj.at("bounds").at(end)[axis].get<double>(), 1000 * ply.at("bounds").at(end)[axis].get<double>(),
                  1e-6);
    }
  }
  const auto check =
      nlohmann::json::parse(output_of({"verify", "mission.yaml", "v.obj", "--points", "2000", "--json"}));
  EXPECT_EQ(check.at("right"), true);
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
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(content(folder_ / "volume.report.json"));
    EXPECT_EQ(report.at("outcome"), outcome) << report;
    EXPECT_NE(report.at("reason"), "");
    EXPECT_NE(result.out.find(report.at("reason").get<std::string>()), std::string::npos) << result.out;
    EXPECT_TRUE(content(folder_ / "volume.ply") == kOldOutput);
    EXPECT_FALSE(fs::exists(folder_ / "new.glb"));
    EXPECT_NE(result.err.find("volume.ply is of an earlier run and was left as it was"), std::string::npos);
    EXPECT_NE(result.err.find("new.glb was not written"), std::string::npos);
  };
  const std::string start = std::string(kScene) + kTarget;
  expect_empty(start + "sensor: {max_range: 5}\n", "out_of_range");
  expect_empty(start + kSensor + "navigation: {altitude: [200, 300]}\n", "outside_limits");
  // On one side of a panel 5 cm thick, looked at from the panel's inside.
  write("panel.obj", std::string(kCity) +
                         "o panel\nv 40 -99 0\nv 40 99 0\nv 40 99 99\nv 40 -99 99\nf 13 14 15 16\n"
                         "v 40.05 -99 0\nv 40.05 99 0\nv 40.05 99 99\nv 40.05 -99 99\nf 17 18 19 20\n");
  expect_empty(std::string("scene: {mesh: panel.obj}\n") + kSensor +
                   "target: {vertices: [[40, -2, 2], [40, 2, 2], [40, 0, 6]], front: [1, 0, 0]}\n",
               "blocked_at_once");
}

TEST_F(CliQuery, Answers) {
  write("points.csv", "x,y,z\n0,0,30\n60,0,5\n0,0,80\n0,0,-3\n");
  const std::vector<std::string> rows = lines(output_of({"query", "mission.yaml", "points.csv"}));
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[0], "x,y,z,inside,margin_m,blocked_by,out_of_range,behind_target,outside_of");
  EXPECT_EQ(rows[1].rfind("0,0,30,true,", 0), 0U) << rows[1];
  EXPECT_NE(rows[1].find(",,false,false,"), std::string::npos) << rows[1];
  EXPECT_EQ(rows[2].rfind("60,0,5,false,-", 0), 0U) << rows[2];
  EXPECT_NE(rows[2].find(",block,true,false,"), std::string::npos) << rows[2];
  EXPECT_EQ(rows[3].rfind("0,0,80,false,-", 0), 0U) << rows[3];
  EXPECT_NE(rows[3].find(",,true,false,"), std::string::npos) << rows[3];
  EXPECT_NE(rows[4].find(",true,"), std::string::npos) << rows[4];
}

TEST_F(CliQuery, NamesBrokenLimits) {
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [10, 20]}\n");
  options_.input = "0 0 15\n0 0 5\n0 0 25\n";
  const std::vector<std::string> rows = lines(output_of({"query", "mission.yaml", "-"}));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_NE(rows[1].find("true"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find("altitude min"), std::string::npos) << rows[2];
  EXPECT_NE(rows[3].find("altitude max"), std::string::npos) << rows[3];
}

TEST_F(CliQuery, TakesAnyTable) {
  const std::string expected = output_of({"query", "mission.yaml", "-"});
  EXPECT_EQ(lines(expected).size(), 1U) << "no points, only the header";
  options_.input = "1,2,30\n";
  const std::string answers = output_of({"query", "mission.yaml", "-"});
  for (const char* text :
       {"1 2 30\n", "1\t2\t30", "1;2;30\r\n", " 1 , 2 , 30 , more\n", "x,y,z\n1,2,30\n", "id;Z;X;Y\np 1;30;1;2\n",
        "\xEF\xBB\xBF\"x\",\"y\",\"z\"\n\"1\",\"2\",\"30\"\n", "# note\n\n  \n1,2,30",
        "name,x,y,z\n\"a, \"\"b\"\"\",1,2,30\n", "x y z\n1 2 30\n", "1.0,2e0,+30"}) {
    options_.input = text;
    EXPECT_EQ(output_of({"query", "mission.yaml", "-"}), answers) << text;
  }
}

TEST_F(CliQuery, WritesAFile) {
  write("points.csv", "0,0,30\n");
  const std::string answers = output_of({"query", "mission.yaml", "points.csv"});
  EXPECT_EQ(output_of({"query", "mission.yaml", "points.csv", "-o", "answers.csv"}), "");
  EXPECT_EQ(content(folder_ / "answers.csv"), answers);
}

TEST_F(CliQuery, RefusesBadRows) {
  const auto expect_bad_points = [&](const std::string& text, const std::string& what, const std::string& line) {
    write("points.csv", text);
    expect_bad({"query", "mission.yaml", "points.csv", "-o", "volume.ply"}, what, "points.csv:" + line);
  };
  expect_bad_points("1,2,3\n4,5\n", "the row has 2 columns, but z is column 3", "2");
  expect_bad_points("1,2,3\n\n4,five,6\n", "y is not a number: 'five'", "3");
  expect_bad_points("x,y,z\n1,2,\n", "z is not a number: ''", "2");
  expect_bad_points("1,2,nan\n", "z is not finite: 'nan'", "1");
  expect_bad_points("1,2,-inf\n", "z is not finite: '-inf'", "1");
  expect_bad_points("1,2,1e999\n", "z", "1");
  expect_bad_points("1;2,5;3\n", "y is not a number: '2,5'", "1");
  expect_bad_points("a,b,c\n1,2,3\n", "neither a point nor a header with a column x", "1");
  expect_bad_points("x,y\n1,2\n", "with a column z", "1");
  expect_bad({"query", "mission.yaml", "none.csv"}, "the points file does not exist", "none.csv");
  expect_bad({"query", "mission.yaml", "."}, "the points file is a folder", ".");
}

TEST_F(CliVerify, PassesWhatWasComputed) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "-o", "v.obj", "-o", "v.stl", "-o", "v.glb"});
  for (const char* name : {"v.ply", "v.obj", "v.stl", "v.glb"}) {
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
  for (const char* expected : {"over-claimed", "seed 7", "95 % confidence", "nothing wrong was found"}) {
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
  EXPECT_NE(result.out.find("WRONG: the volume over-claims"), std::string::npos) << result.out;
  const auto report =
      nlohmann::json::parse(run({"verify", "mission.yaml", "box.obj", "--points", "2000", "--json"}).out);
  EXPECT_EQ(report.at("right"), false);
  EXPECT_GT(report.at("over_claimed"), 10);
  EXPECT_GT(report.at("worst_over_depth_m"), 0.1);
}

TEST_F(CliVerify, FailsAMeshThatIsNoSolid) {
  write("open.obj", "v 0 0 1\nv 5 0 1\nv 0 5 1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  const ProgramRun result = run({"verify", "mission.yaml", "open.obj"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("WRONG: the mesh is not a closed solid"), std::string::npos) << result.out << result.err;
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
  fs::remove(folder_ / "low.report.json");
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500"}).exit_code, 1);
  EXPECT_EQ(run({"verify", "low.yaml", "low.ply", "--points", "500", "--lift", "0.001501"}).exit_code, 0);
  for (const char* text : {"", "[]", "{}", "{\"lift_m\": \"far\"}", "{\"lift_m\": -1}", "{\"lift_m\": 1}"}) {
    write("low.report.json", text);
    expect_bad({"verify", "low.yaml", "low.ply"}, "lift_m", "low.report.json");
  }
}

TEST_F(CliVerify, RefusesWhatIsNoMesh) {
  expect_bad({"verify", "mission.yaml", "none.ply"}, "the volume does not exist", "none.ply");
  expect_bad({"verify", "mission.yaml", "volume.ply"}, "", "volume.ply");
}

TEST_F(Cli, TheExampleIsWhatItsScriptMakes) {
  options_.folder = fs::path(VANTAGE_SOURCE_DIR) / "examples" / "plaza";
  const ProgramRun made = vantage::testing::run_program("/bin/sh", {"-c", "python3 make_scene.py"}, options_);
  if (made.exit_code == 127) GTEST_SKIP() << "no python3";
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(made.out == content(options_.folder / "plaza.obj"));
}

TEST_F(Cli, TheExampleWorks) {
  const fs::path example = fs::path(VANTAGE_SOURCE_DIR) / "examples" / "plaza";
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

}  // namespace
