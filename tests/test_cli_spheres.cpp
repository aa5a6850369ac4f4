// The method of spheres as users of the program meet it: options, reports, stages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/cli_fixture.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CliSpheres : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write_mission("spheres: {cubemap: 12, max_splits: 1, device: cpu}\n");
  }
  void write_mission(const std::string& more) {
    write("mission.yaml", std::string(testing::kScene) + testing::kTarget + testing::kSensor + more);
  }
  json report() const { return json::parse(testing::content(folder_ / "volume.report.json")); }
};

TEST_F(CliSpheres, ComputesAndReports) {
  EXPECT_NE(output_of({"compute", "mission.yaml", "--method", "spheres", "-o", "volume.ply"}).find("spheres, CPU"),
            std::string::npos);
  const std::string said = output_of({"compute", "mission.yaml", "--method", "spheres", "-v", "-o", "volume.ply"});
  for (const char* expected :
       {"visibility spheres, CPU", "spheres", "pairs", "splits", "unresolved", "for intersections"})
    EXPECT_NE(said.find(expected), std::string::npos) << expected << " in\n" << said;
  const json r = report();
  EXPECT_EQ(r.at("method"), "spheres");
  EXPECT_EQ(r.at("outcome"), "computed");
  EXPECT_EQ(r.at("closed"), true);
  EXPECT_EQ(r.at("spheres").at("device").at("kind"), "cpu");
  EXPECT_EQ(r.at("spheres").at("cubemap"), 12);
  EXPECT_EQ(r.at("spheres").at("sphere"), "conservative");
  EXPECT_GE(r.at("spheres").at("spheres").get<int>(), 4);
  EXPECT_GE(r.at("spheres").at("pairs").get<int>(), 4);
  EXPECT_GT(r.at("spheres").at("boolean_seconds").get<double>(), 0);
  const Mesh volume = read_scene(folder_ / "volume.ply").mesh;
  EXPECT_TRUE(measure(volume).closed);

  output_of({"compute", "mission.yaml", "-o", "volume.ply"});
  EXPECT_EQ(report().at("method"), "exact");
  EXPECT_FALSE(report().contains("spheres"));
}

TEST_F(CliSpheres, TheMissionMayNameTheMethod) {
  write_mission(
      "method: spheres\nspheres: {resolution: [24, 12], sphere: centers, split: always, max_splits: 1, min_edge: 1}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "volume.ply"});
  const json r = report().at("spheres");
  EXPECT_EQ(r.at("resolution"), json({24, 12}));
  EXPECT_EQ(r.at("sphere"), "centers");
  EXPECT_EQ(r.at("split"), "always");
  EXPECT_EQ(r.at("splits"), 4);
  output_of({"compute", "mission.yaml", "-q", "--method", "exact", "-o", "volume.ply"});
  EXPECT_EQ(report().at("method"), "exact");
}

TEST_F(CliSpheres, QueriesSayThatTheyAreExact) {
  write_mission("method: spheres\n");
  write("points.csv", "0 0 10\n");
  const auto result = run({"query", "mission.yaml", "points.csv"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("answered exactly"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("true"), std::string::npos);
}

TEST_F(CliSpheres, RefusesWhatIsOutOfRangeWithItsPlace) {
  const auto refused = [&](const std::string& section, const std::string& where = "mission.yaml:") {
    expect_bad_mission(
        std::string(testing::kScene) + testing::kTarget + testing::kSensor + "method: spheres\n" + section, where);
  };
  refused("spheres: {cubemap: 0}\n", "mission.yaml:7:20");
  refused("spheres: {cubemap: 100000}\n");
  refused("spheres: {cubemap: 10.5}\n");
  refused("spheres: {cubemap: 1e300}\n");
  refused("spheres: {resolution: [0, 80]}\n");
  refused("spheres: {resolution: 160}\n");
  refused("spheres: {resolution: [160, 80, 3]}\n");
  refused("spheres: {max_splits: -1}\n");
  refused("spheres: {min_edge: 0}\n");
  refused("spheres: {merge: 0.5}\n");
  refused("spheres: {sphere: round}\n");
  refused("spheres: {split: never}\n");
  refused("spheres: {device: toaster}\n");
  refused("spheres: {cubemaps: 4}\n");
  expect_bad_mission(std::string(testing::kScene) + testing::kTarget + testing::kSensor + "method: sphere\n");
}

TEST_F(CliSpheres, RefusesItsOptionsForTheExactMethod) {
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply", "--stages", "stages"});
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply", "--device", "cpu"});
  expect_refused({"compute", "mission.yaml", "-o", "volume.ply", "--method", "spheres", "--device", "99"}, "0: CPU");
}

TEST_F(CliSpheres, WritesItsStages) {
  output_of({"compute", "mission.yaml", "--method", "spheres", "-o", "volume.ply", "--stages", "stages/"});
  const json story = json::parse(testing::content(folder_ / "stages" / "stages.json"));
  const json& stages = story.at("stages");
  ASSERT_GE(stages.size(), 9U);
  std::size_t files = 1;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    EXPECT_EQ(stages[i].at("order"), i);
    if (!stages[i].contains("file") || stages[i].at("file").is_null()) continue;
    ++files;
    const Mesh mesh = read_scene(folder_ / "stages" / stages[i].at("file").get<std::string>()).mesh;
    const MeshMeasures m = measure(mesh);
    EXPECT_TRUE(m.closed);
    EXPECT_EQ(m.euler, stages[i].at("euler"));
    EXPECT_NEAR(m.volume_m3, stages[i].at("volume_m3"), 1e-6 * m.volume_m3);
  }
  EXPECT_EQ(stages[0].at("kind"), "sphere");
  EXPECT_EQ(stages[0].at("file"), "000_sphere_0.ply");
  EXPECT_EQ(stages.back().at("kind"), "result");
  EXPECT_EQ(story.at("run").at("spheres"), report().at("spheres").at("spheres"));
  const auto count = [&] {
    return std::distance(fs::directory_iterator(folder_ / "stages"), fs::directory_iterator());
  };
  EXPECT_EQ(static_cast<std::size_t>(count()), files);

  // Again, with fewer: nothing of the old ones stays, and nothing beside the folder either.
  fs::copy_file(folder_ / "stages" / "000_sphere_0.ply", folder_ / "stages" / "999_sphere_999.ply");
  output_of({"compute", "mission.yaml", "--method", "spheres", "-q", "-o", "volume.ply", "--stages", "stages"});
  EXPECT_EQ(static_cast<std::size_t>(count()), files);
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().filename().string().find(".vantage"), std::string::npos) << entry.path();
}

TEST_F(CliSpheres, LeavesOtherFoldersAlone) {
  const std::vector<std::string> command = {"compute", "mission.yaml", "--method", "spheres",
                                            "-o",      "volume.ply",   "--stages"};
  const auto with = [&](const std::string& folder) {
    std::vector<std::string> arguments = command;
    arguments.push_back(folder);
    return arguments;
  };
  write("mine/letter.txt", "dear");
  expect_bad(with("mine"), "mine");
  expect_bad(with("city.obj"), "city.obj");
  expect_bad(with("no/such/place"), "no/such/place");
  // What somebody put beside older stages is not lost, be it an input of this very run.
  write("kept/stages.json", "{}");
  write("kept/000_sphere_0.ply", "old");
  write("kept/notes.txt", "dear");
  expect_bad(with("kept"), "kept");
  EXPECT_EQ(testing::content(folder_ / "kept" / "notes.txt"), "dear");
  EXPECT_EQ(testing::content(folder_ / "kept" / "000_sphere_0.ply"), "old");
  fs::remove(folder_ / "kept" / "notes.txt");
  fs::create_directory(folder_ / "kept" / "001_scans.ply");
  expect_bad(with("kept"), "kept");
  write("scans/001_scan.ply", "mine");
  expect_bad(with("scans"), "scans");
  // Nor is what has such a name, be it beside what --stages wrote.
  write("named/stages.json", "{}");
  expect_bad(with("named"), "named");
  output_of(with("stages"));
  write("stages/001_scan.ply", "mine");
  expect_bad(with("stages"), "stages");
  fs::remove(folder_ / "stages" / "001_scan.ply");
  // A run that fails leaves the older stages, and no traces.
  write("mission.yaml",
        std::string(testing::kScene) + testing::kSensor +
            "target: {vertices: [[22, -3, 5], [28, -3, 5], [25, 3, 15]]}\nspheres: {device: cpu, cubemap: 4}\n");
  expect_bad(with("stages"), "mission.yaml");
}

TEST_F(CliSpheres, KeepsTheOlderStagesWhenTheVolumeCannotBeWritten) {
  const auto command = [](const char* output, const char* folder) {
    return std::vector<std::string>{"compute", "mission.yaml", "--method", "spheres", "-q",
                                    "-o",      output,         "--stages", folder};
  };
  output_of(command("whole.obj", "stages"));
  std::uintmax_t largest = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "stages")) largest = std::max(largest, entry.file_size());
  const std::uintmax_t needed = fs::file_size(folder_ / "whole.obj");
  ASSERT_GT(needed, largest + 2000) << "there is no limit that stops the volume alone";
  fs::copy_file(folder_ / "stages" / "000_sphere_0.ply", folder_ / "stages" / "999_sphere_999.ply");
  options_.largest_file = (needed + largest) / 2;
  expect_bad(command("new.obj", "stages"), "new.obj");
  EXPECT_TRUE(fs::exists(folder_ / "stages" / "999_sphere_999.ply"));
  expect_bad(command("new.obj", "fresh"), "new.obj");
  EXPECT_FALSE(fs::exists(folder_ / "fresh"));
}

}  // namespace
}  // namespace vantage
