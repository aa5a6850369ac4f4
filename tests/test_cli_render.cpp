// `vantage render` as its users run it.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "support/cli_fixture.h"
#include "support/opengl.h"

namespace vantage::testing {
namespace {

class CliRender : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("picture.png", kOldOutput);
  }

  /// Width and height that a PNG states.
  std::pair<int, int> size_of(const std::string& name) const {
    const std::string bytes = content(folder_ / name);
    if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG") return {0, 0};
    const auto number = [&](std::size_t i) {
      return (static_cast<unsigned char>(bytes[i + 2]) << 8) + static_cast<unsigned char>(bytes[i + 3]);
    };
    return {number(16), number(20)};
  }
};

TEST_F(CliRender, DrawsWhatItComputesOrIsGiven) {
  VANTAGE_REQUIRE_OPENGL();
  testing::expect_wording(output_of({"render", "mission.yaml", "-o", "picture.png", "--size", "200x150"}));
  EXPECT_EQ(size_of("picture.png"), std::pair(200, 150));
  output_of({"compute", "mission.yaml", "-o", "volume.ply"});
  output_of({"render", "mission.yaml", "-o", "other.png", "--size", "200x150", "--volume", "volume.ply", "-q"});
  EXPECT_EQ(content(folder_ / "other.png"), content(folder_ / "picture.png")) << "the same volume, the same picture";
}

TEST_F(CliRender, TakesItsViewInAnyOrder) {
  VANTAGE_REQUIRE_OPENGL();
  output_of({"render", "--view", "top", "mission.yaml", "-o", "a.png", "--size", "120x90"});
  output_of({"render", "mission.yaml", "--view", "top", "-o", "b.png", "--size", "120x90"});
  EXPECT_EQ(content(folder_ / "a.png"), content(folder_ / "b.png"));
  output_of({"render", "mission.yaml", "--view", "from", "-60,-50,40", "-o", "c.png", "--size", "120x90"});
  output_of({"render", "mission.yaml", "--view", "oblique", "10,30", "-o", "d.png", "--size", "120x90"});
  EXPECT_NE(content(folder_ / "c.png"), content(folder_ / "d.png"));
  output_of({"render", "--view", "from -60,-50,40", "mission.yaml", "-o", "e.png", "--size", "120x90"});
  EXPECT_EQ(content(folder_ / "c.png"), content(folder_ / "e.png")) << "quoted as one word";
  output_of({"render", "mission.yaml", "-o", "f.png", "--size", "120x90", "--view", "oblique  10,30"});
  EXPECT_EQ(content(folder_ / "d.png"), content(folder_ / "f.png"));
}

TEST_F(CliRender, TellsWhatMakesTheResultDoubtful) {
  VANTAGE_REQUIRE_OPENGL();
  write("far.yaml",
        std::string(kScene) + kSensor + "target: {vertices: [[9000, 0, 0], [9010, 0, 0], [9000, 10, 0]]}\n");
  const std::vector<std::string> draw = {"render", "far.yaml", "-o", "far.png", "--size", "320x240"};
  EXPECT_NE(run(draw).err.find("8.9 km"), std::string::npos);
  ASSERT_EQ(run({"compute", "far.yaml", "-o", "far.ply"}).exit_code, 0);
  std::vector<std::string> given = draw;
  given.insert(given.end(), {"--volume", "far.ply"});
  given[3] = "given.png";
  EXPECT_NE(run(given).err.find("8.9 km"), std::string::npos);
  EXPECT_EQ(content(folder_ / "given.png"), content(folder_ / "far.png"));
}

TEST_F(CliRender, NumbersMayHaveBlanksBetweenThem) {
  VANTAGE_REQUIRE_OPENGL();
  output_of({"render", "mission.yaml", "--view", "from", "-60,-50,40", "-o", "a.png", "--size", "120x90"});
  output_of({"render", "mission.yaml", "--view", "from", "-60, -50, 40", "-o", "b.png", "--size", "120x90"});
  output_of({"render", "--view", "from -60, -50, 40", "mission.yaml", "-o", "c.png", "--size", "120x90"});
  EXPECT_EQ(content(folder_ / "a.png"), content(folder_ / "b.png"));
  EXPECT_EQ(content(folder_ / "a.png"), content(folder_ / "c.png"));
}

TEST_F(CliRender, DrawsTheSceneWhereThereIsNoVolume) {
  VANTAGE_REQUIRE_OPENGL();
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [500, 600]}\n");
  const ProgramRun result = run({"render", "mission.yaml", "-o", "picture.png", "--size", "120x90"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("no volume"), std::string::npos) << result.err;
  EXPECT_EQ(size_of("picture.png"), std::pair(120, 90));
}

TEST_F(CliRender, MakesASheetOfStages) {
  VANTAGE_REQUIRE_OPENGL();
  write("mission.yaml", std::string(kScene) + kTarget + kSensor + "navigation: {altitude: [5, 30]}\n");
  output_of({"compute", "mission.yaml", "-o", "volume.ply"});
  write("stages/000.ply", content(folder_ / "volume.ply"));
  write("stages/stages.json",
        R"({"target": "square", "stages": [
  {"number": 0, "kind": "sphere", "name": "sphere 0", "points": [[0, 0, 0]], "file": "000.ply", "euler": 2},
  {"number": 1, "kind": "pair", "name": "pair 0-1", "file": "000.ply", "euler": 2, "volume_m3": 5.5},
  {"number": 2, "kind": "split", "name": "split 0-1"},
  {"number": 3, "kind": "result", "name": "result", "file": "000.ply", "euler": 2}]})");
  output_of({"render", "mission.yaml", "--stages", "stages", "-o", "sheet.png", "--size", "100x80"});
  const auto [width, height] = size_of("sheet.png");
  EXPECT_GT(width, 400);
  EXPECT_LT(width, 500);
  EXPECT_GT(height, 160) << "seven panels in two rows of four";
}

TEST_F(CliRender, RefusesStagesThatAreGarbled) {
  const std::vector<std::string> arguments = {"render", "mission.yaml", "--stages", "stages", "-o", "picture.png"};
  expect_bad(arguments, "stages.json");
  write("stages/stages.json", "{\"stages\": [{\"kind\": 7}]}");
  expect_bad(arguments, "stage 0");
  write("stages/stages.json", "{\"stages\": []}");
  expect_bad(arguments, "stages.json");
  write("stages/stages.json", "[1, 2");
  expect_bad(arguments, "stages.json");
}

TEST_F(CliRender, RefusesBadArguments) {
  const auto with = [](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", "mission.yaml", "-o", "picture.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_bad(with({"--view", "below"}), "--view");
  expect_bad(with({"--view", "from"}), "--view");
  expect_bad(with({"--view", "from", "1,2"}), "--view");
  expect_bad(with({"--view", "from", "1,2,x"}), "--view");
  expect_bad(with({"--view", "from", "1,2,nan"}), "--view");
  expect_bad(with({"--view", "oblique", "10,95"}), "--view");
  expect_bad(with({"--view", "top", "1"}), "--view");
  expect_bad(with({"--view", "from 1,2"}), "--view");
  expect_bad(with({"--view", "from 1,2,3 4"}), "--view");
  expect_bad(with({"--view", "from 1,2,3", "4,5,6"}), "--view");
  for (const char* size : {"0x100", "100", "100x", "x100", "100x100x100", "1e3x100", "100x5000", "-5x100"}) {
    expect_bad(with({"--size", size}), "--size");
  }
  expect_bad(with({"--volume", "missing.ply"}), "missing.ply");
  expect_bad(with({"--volume", "volume.ply"}), "volume.ply");
  expect_bad({"render", "missing.yaml", "-o", "picture.png"}, "missing.yaml");
}

TEST_F(CliRender, RefusesOutputsThatCannotBe) {
  expect_bad({"render", "mission.yaml", "-o", "picture.jpg"}, "picture.jpg");
  expect_bad({"render", "mission.yaml", "-o", "missing/picture.png"}, "missing");
  expect_bad({"render", "mission.yaml", "-o", "."}, ".");
  expect_bad({"render", "mission.yaml", "--volume", "picture.png", "-o", "picture.png"});
  fs::create_directory(folder_ / "closed");
  become_nobody();
  fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::others_read | fs::perms::others_exec);
  expect_bad({"render", "mission.yaml", "-o", "closed/picture.png"}, "closed");
}

TEST_F(CliRender, KeepsTheOldPictureWhenTheDiskIsFull) {
  VANTAGE_REQUIRE_OPENGL();
  options_.largest_file = 100;
  expect_bad({"render", "mission.yaml", "-o", "picture.png", "--size", "120x90"}, "picture.png");
}

TEST_F(CliRender, SaysWhatToInstallWhereThereIsNoOpenGL) {
  const char* name = "__EGL_VENDOR_LIBRARY_DIRS";  // where the dispatch library looks for drivers
  const char* set = std::getenv(name);
  const std::optional<std::string> old = set != nullptr ? std::optional<std::string>(set) : std::nullopt;
  ::setenv(name, folder_.c_str(), 1);
  if (const ProgramRun devices = run({"devices"}); devices.out.find("llvmpipe") != std::string::npos) {
    ::unsetenv(name);
    GTEST_SKIP() << "this machine's EGL does not look for its drivers where " << name << " says";
  }
  const std::string refused = expect_refused({"render", "mission.yaml", "-o", "picture.png"}, "OpenGL");
  EXPECT_EQ(refused.find("mission.yaml"), std::string::npos) << "the mission is not to blame: " << refused;
  old ? ::setenv(name, old->c_str(), 1) : ::unsetenv(name);
}

}  // namespace
}  // namespace vantage::testing
