// The commands that look for places to fly at: stand and orbit.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/places.h"
#include "support/run_program.h"

namespace vantage {
namespace {

using Json = nlohmann::json;
using testing::kScene;
using testing::kSensor;
using testing::kTarget;

class CliFlight : public testing::Cli {
 protected:
  int code_of(const std::vector<std::string>& arguments) const { return run(arguments).exit_code; }
  Json json_of(const std::vector<std::string>& arguments) const { return Json::parse(run(arguments).out); }
};

constexpr const char* kTwo =
    "combine: each\n"
    "targets:\n"
    "  - {name: west, vertices: [[-5, -5, 0], [0, -5, 0], [0, 5, 0], [-5, 5, 0]]}\n"
    "  - {name: pierced, vertices: [[15, -3, 1], [25, -3, 1], [25, 3, 1], [15, 3, 1]]}\n";

TEST_F(CliFlight, StandPrintsWhereToHover) {
  const Json json = json_of({"stand", "mission.yaml", "--json", "--margin", "2"});
  ASSERT_EQ(json["targets"].size(), 1U);
  const Json& target = json["targets"][0];
  EXPECT_EQ(target["target"], "square");
  EXPECT_EQ(target["margin_m"], 2);
  EXPECT_EQ(target["standpoints"].size(), 4U);
  EXPECT_EQ(target["notes"].size(), 1U) << "there is no camera";
  for (const Json& point : target["standpoints"]) {
    EXPECT_GE(point["margin_m"], 2);
    EXPECT_EQ(point["obstacle"], "block");
    EXPECT_TRUE(point["longitude_deg"].is_null());
  }
  const std::string text = run({"stand", "mission.yaml", "-q"}).out;
  for (const char* kind : {"deepest", "nearest", "best_incidence", "farthest"}) {
    EXPECT_NE(text.find(kind), std::string::npos) << kind;
  }
  EXPECT_EQ(text.find("finest_pixel"), std::string::npos);
}

TEST_F(CliFlight, OrbitPrintsWhereToCircle) {
  const Json json = json_of({"orbit", "mission.yaml", "--radius", "20", "--counterclockwise", "--json"});
  const Json& orbits = json["targets"][0]["orbits"];
  ASSERT_EQ(orbits.size(), 2U);
  EXPECT_EQ(orbits[0]["kind"], "widest");
  EXPECT_EQ(orbits[0]["shape"], "circle");
  EXPECT_EQ(orbits[0]["clockwise"], false);
  EXPECT_GT(orbits[0]["radius_m"], 20);
  const std::string text = run({"orbit", "mission.yaml", "--radius", "20"}).out;
  EXPECT_NE(text.find("clockwise"), std::string::npos);
  EXPECT_NE(text.find("margin"), std::string::npos);
}

TEST_F(CliFlight, TheExitCodeSaysWhetherSomethingWasFound) {
  EXPECT_EQ(code_of({"stand", "mission.yaml"}), 0);
  EXPECT_EQ(code_of({"stand", "mission.yaml", "--margin", "100"}), 1);
  EXPECT_EQ(code_of({"stand", "mission.yaml", "--margin", "a lot"}), 2);
  EXPECT_EQ(code_of({"stand", "none.yaml"}), 2);
  EXPECT_EQ(code_of({"orbit", "mission.yaml", "--radius", "20"}), 0);
  EXPECT_EQ(code_of({"orbit", "mission.yaml", "--radius", "500"}), 1);
  EXPECT_EQ(code_of({"orbit", "mission.yaml", "--radius", "0"}), 2);
  EXPECT_EQ(code_of({"orbit", "mission.yaml", "--radius", "20", "--max-radius", "10"}), 2);
}

TEST_F(CliFlight, OrbitWritesAPlan) {
  write("old.csv", testing::kOldOutput);
  EXPECT_EQ(code_of({"orbit", "mission.yaml", "--radius", "20", "-q", "-o", "old.csv"}), 0);
  // All of it sees the target, as the judge of plans says.
  const Json check = json_of({"check", "mission.yaml", "old.csv", "--json", "--speed", "5"});
  ASSERT_EQ(check["targets"].size(), 1U);
  const Json& seen = check["targets"][0]["seen"];
  ASSERT_EQ(seen.size(), 1U) << check;
  EXPECT_NEAR(seen[0]["end_m"].get<double>() - seen[0]["begin_m"].get<double>(), check["length_m"].get<double>(), 1e-6);
  EXPECT_GT(check["length_m"], 2 * 3.14 * 19.9);
}

TEST_F(CliFlight, OrbitRefusesAnOutputBeforeItComputes) {
  write("old.csv", testing::kOldOutput);
  write("two.yaml", std::string(kScene) + kTwo + kSensor);
  expect_bad({"orbit", "mission.yaml", "-o", "orbit.plan"}, "QGroundControl");
  expect_bad({"orbit", "mission.yaml", "-o", "city.obj"}, "city.obj");
  expect_bad({"orbit", "mission.yaml", "-o", "orbit.txt"}, "orbit.txt");
  expect_bad({"orbit", "two.yaml", "-o", "old.csv"}, "command line, -o");
  expect_bad({"stand", "mission.yaml", "--clearance", "-2"}, "--clearance");
}

TEST_F(CliFlight, TheTourOfTheMissionSaysMarginClearanceAndRadius) {
  const std::string plain = std::string(kScene) + testing::kTarget + kSensor;
  write("tour.yaml",
        plain + "tour: {vehicle: {kind: fixed_wing, turn_radius: 22}, view: {margin: 2.5}, clearance: 7}\n");
  for (const Json& point : json_of({"stand", "tour.yaml", "--json"})["targets"][0]["standpoints"]) {
    EXPECT_GE(point["margin_m"], 2.5);
    EXPECT_GE(point["obstacle_distance_m"], 7);
  }
  EXPECT_EQ(json_of({"stand", "tour.yaml", "--json", "--margin", "1"})["targets"][0]["margin_m"], 1);
  const Json orbits = json_of({"orbit", "tour.yaml", "--json"})["targets"][0]["orbits"];
  ASSERT_FALSE(orbits.empty());
  for (const Json& orbit : orbits) {
    EXPECT_GE(orbit["radius_m"], 22);
    EXPECT_GE(orbit["margin_m"], 2.5);
    EXPECT_GE(orbit["obstacle_distance_m"], 6.9);
  }
  write("tour.yaml", plain + "tour: {vehicle: {kind: fixed_wing, turn_radius: 500}}\n");
  EXPECT_EQ(code_of({"orbit", "tour.yaml"}), 1);
  EXPECT_EQ(code_of({"orbit", "tour.yaml", "--radius", "20"}), 0);
}

TEST_F(CliFlight, OfSeveralTargetsEachHasItsAnswer) {
  write("two.yaml", std::string(kScene) + kTwo + kSensor);
  const Json json = json_of({"stand", "two.yaml", "--json"});
  ASSERT_EQ(json["targets"].size(), 2U);
  EXPECT_EQ(json["targets"][0]["reason"], "");
  EXPECT_NE(json["targets"][1]["reason"], "");
  EXPECT_EQ(code_of({"stand", "two.yaml"}), 1);
  EXPECT_EQ(code_of({"stand", "two.yaml", "--target", "west"}), 0);
  EXPECT_EQ(code_of({"stand", "two.yaml", "--target", "east"}), 2);
  EXPECT_EQ(code_of({"orbit", "two.yaml", "--radius", "15"}), 1);
}

TEST_F(CliFlight, AnswersSayWhatTheSceneLacks) {
  testing::MapText map({11, 48});
  map.area({{20, -5}, {30, 5}, {30, -5}, {20, 5}}, {{"building", "yes"}, {"name", "Bowtie"}});
  write("city.osm", map.text());
  write("map.yaml",
        "scene: {osm: city.osm, center: [48, 11], radius: 150}\nsensor: {max_range: 60}\n"
        "target: {center: [48, 11], width: 4, length: 4}\n");
  for (const char* const command : {"stand", "orbit"}) {
    const testing::ProgramRun found = run({command, "map.yaml", "--json"});
    const std::string told = Json::parse(found.out)["targets"][0]["notes"].dump();
    EXPECT_NE(told.find("Bowtie"), std::string::npos) << told;
    EXPECT_NE(found.err.find("Bowtie"), std::string::npos) << found.err;
  }
  run({"compute", "map.yaml", "-q", "-o", "v.ply"});
  run({"prove", "map.yaml", "v.ply", "--certificate", "v.cert"});
  write("tour.yaml",
        "scene: {osm: city.osm, center: [48, 11], radius: 150}\nsensor: {max_range: 60}\n"
        "targets: [{name: west, center: [48, 11], width: 4, length: 4}]\ntour: {gap: 0.5}\n");
  run({"tour", "tour.yaml", "--certificate", "t.cert"});
  const std::vector<std::pair<const char*, const char*>> checkers = {{"v.cert", "tools/check_certificate.py"},
                                                                     {"t.cert", "tools/check_tour.py"}};
  for (const auto& [certificate, checker] : checkers) {
    EXPECT_NE(Json::parse(testing::content(folder_ / certificate)).value("scene_incomplete", "").find("Bowtie"),
              std::string::npos);
    const testing::ProgramRun checked = testing::run_program(
        "/usr/bin/env", {"python3", (testing::source_folder() / checker).string(), (folder_ / certificate).string()});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_NE(checked.out.find("Bowtie"), std::string::npos) << checked.out;
  }
  EXPECT_NE(run({"verify-tour", "t.cert"}).out.find("Bowtie"), std::string::npos);
  EXPECT_NE(json_of({"verify-tour", "t.cert", "--json"})["scene_incomplete"].get<std::string>().find("Bowtie"),
            std::string::npos);
  const Json verified = json_of({"verify", "map.yaml", "v.ply", "--points", "200", "--json"});
  EXPECT_NE(verified["scene_incomplete"].get<std::string>().find("Bowtie"), std::string::npos);
}

}  // namespace
}  // namespace vantage
