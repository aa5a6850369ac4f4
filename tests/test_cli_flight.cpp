// The commands that look for places to fly at: stand and orbit.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/cli_fixture.h"

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

}  // namespace
}  // namespace vantage
