// The program as its users run it, in a folder of its own with a small city, a mission and an old volume.
#pragma once

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

#include "support/places.h"
#include "support/run_program.h"
#include "support/wording.h"

namespace vantage::testing {

namespace fs = std::filesystem;

// A ground of 200 m, and on it a block of 10 x 10 x 12 m named "block".
inline constexpr const char* kCity =
    "o ground\nv -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n"
    "o block\nv 20 -5 0\nv 30 -5 0\nv 30 5 0\nv 20 5 0\nv 20 -5 12\nv 30 -5 12\nv 30 5 12\nv 20 5 12\n"
    "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
inline constexpr const char* kScene = "scene: {mesh: city.obj}\n";
inline constexpr const char* kTarget =
    "target:\n  name: square\n  vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]\n";
inline constexpr const char* kSensor = "sensor: {max_range: 60}\n";
inline constexpr const char* kOldOutput = "an old volume, precious\n";
/// What an earlier run wrote: a report that vantage did not write is never replaced.
inline constexpr const char* kOldReport =
    R"({"version": "0.0.1", "method": "exact", "outcome": "computed", "causes": [], "bounding_box": null, "lift_m": 0})";

inline std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline std::vector<std::string> lines(const std::string& text) {
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
    write("volume.report.json", kOldReport);
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
    ProgramRun result = run_program(program_file(), arguments, options_);
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

  /// expect_refused, and compares the words with the golden file.
  std::string expect_bad(const std::vector<std::string>& arguments, const std::string& where = "") {
    std::string said = expect_refused(arguments, where);
    expect_wording(said);
    return said;
  }

  /// Expects exit code 2, the three lines, `where` in the second, nothing on standard output, and every file as it was.
  /// Returns the lines.
  std::string expect_refused(const std::vector<std::string>& arguments, const std::string& where = "") {
    const auto before = files();
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> said = lines(result.err);
    EXPECT_EQ(said.size(), 3U) << result.err;
    if (said.size() != 3) return result.err;
    EXPECT_EQ(said[0].rfind("vantage: ", 0), 0U) << result.err;
    EXPECT_EQ(said[1].rfind("  where: ", 0), 0U) << result.err;
    EXPECT_EQ(said[2].rfind("  what to do: ", 0), 0U) << result.err;
    EXPECT_GT(said[1].size(), 9U);
    EXPECT_GT(said[2].size(), 14U);
    EXPECT_NE(said[1].find(where), std::string::npos) << result.err;
    EXPECT_TRUE(files() == before) << "a file was touched";
    return result.err;
  }

  /// expect_bad of computing a mission with this text over the old output.
  void expect_bad_mission(const std::string& text, const std::string& where = "mission.yaml") {
    write("mission.yaml", text);
    expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, where);
  }
  void expect_bad_vertices(const std::string& vertices, const std::string& where = "mission.yaml:4:13") {
    expect_bad_mission(std::string(kScene) + kSensor + "target:\n  vertices: " + vertices + "\n", where);
  }

  /// expect_bad of a mission whose scene is a file with this content.
  void expect_bad_scene(const std::string& name, const std::string& bytes) {
    write(name, bytes);
    expect_bad_mission("scene: {mesh: " + name + "}\n" + kTarget + kSensor, name);
    expect_bad({"inspect", name}, name);
  }

  fs::path folder_;
  RunOptions options_;
};

}  // namespace vantage::testing
