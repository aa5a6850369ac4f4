#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/internals.h"
#include "support/solids.h"
#include "vantage/result.h"
#include "vantage/version.h"

namespace vantage::internal::app {
namespace {

using nlohmann::json;

TEST(Report, TellsWhatWasComputed) {
  Volume volume = vantage::testing::make_hemisphere(Vec3(1, 2, 3), 10);
  volume.causes[1].area_m2 = 12.5;
  volume.tolerance_m = 0.02;
  volume.lift_m = {1e-5, 1e-4};
  volume.counts = {11, 12, 13, 14, 15, 16};
  volume.seconds = {0.1, 0.2, 0.3, 0.4, 0.5, 1.5};
  const MeshMeasures measures = measure(volume.mesh);
  const std::string text = report_json(volume, measures, {"m.yaml", "city.obj", "plaza", "v.ply"});
  EXPECT_EQ(text.back(), '\n');
  const json report = json::parse(text);
  EXPECT_EQ(report.at("version"), VANTAGE_VERSION);
  EXPECT_EQ(report.at("mission"), "m.yaml");
  EXPECT_EQ(report.at("scene"), "city.obj");
  EXPECT_EQ(report.at("target"), "plaza");
  EXPECT_EQ(report.at("volume"), "v.ply");
  EXPECT_EQ(report.at("outcome"), "computed");
  EXPECT_EQ(report.at("reason"), "");
  EXPECT_EQ(report.at("hint"), "");
  EXPECT_EQ(report.at("volume_m3"), measures.volume_m3);  // to the last bit
  EXPECT_EQ(report.at("area_m2"), measures.area_m2);
  EXPECT_EQ(report.at("pieces"), 1);
  EXPECT_EQ(report.at("vertices"), measures.vertices);
  EXPECT_EQ(report.at("facets"), measures.facets);
  EXPECT_EQ(report.at("euler"), 2);
  EXPECT_EQ(report.at("closed"), true);
  EXPECT_EQ(report.at("oriented"), true);
  EXPECT_EQ(report.at("tolerance_m"), 0.02);
  EXPECT_EQ(report.at("lift_m"), 1e-4);  // the largest
  EXPECT_EQ(report.at("lift_of_part_m"), json({1e-5, 1e-4}));
  EXPECT_EQ(report.at("bounding_box").at("min"), json({-9.0, -8.0, 3.0}));
  EXPECT_EQ(report.at("bounding_box").at("max"), json({11.0, 12.0, 13.0}));
  ASSERT_EQ(report.at("causes").size(), volume.causes.size());
  EXPECT_EQ(report.at("causes")[1], json({{"name", "way/17"}, {"kind", "scene"}, {"area_m2", 12.5}}));
  EXPECT_EQ(report.at("causes")[3].at("kind"), "range");
  EXPECT_EQ(report.at("causes")[4].at("kind"), "target_plane");
  EXPECT_EQ(report.at("counts"), json({{"scene_polygons", 11},
                                       {"candidate_blockers", 12},
                                       {"visible_blockers", 13},
                                       {"visible_facets", 14},
                                       {"constraint_edges", 15},
                                       {"boolean_fallbacks", 16}}));
  EXPECT_EQ(
      report.at("seconds"),
      json({{"read", 0.1}, {"prepare", 0.2}, {"engine", 0.3}, {"navigation", 0.4}, {"write", 0.5}, {"total", 1.5}}));
}

TEST(Report, TellsWhyThereIsNoVolume) {
  Volume volume;
  volume.reason = "because";
  volume.hint = "try this";
  const std::vector<std::pair<Outcome, std::string>> outcomes = {{Outcome::out_of_range, "out_of_range"},
                                                                 {Outcome::blocked_at_once, "blocked_at_once"},
                                                                 {Outcome::outside_limits, "outside_limits"}};
  for (const auto& [outcome, name] : outcomes) {
    volume.outcome = outcome;
    const json report = json::parse(report_json(volume, measure(volume.mesh)));
    EXPECT_EQ(report.at("outcome"), name);
    EXPECT_EQ(report.at("reason"), "because");
    EXPECT_EQ(report.at("hint"), "try this");
    EXPECT_EQ(report.at("volume_m3"), 0);
    EXPECT_TRUE(report.at("bounding_box").is_null());
    EXPECT_EQ(report.at("causes"), json::array());
    EXPECT_FALSE(report.contains("mission"));
  }
}

TEST(Report, SurvivesNamesThatAreNotUtf8) {
  Volume volume;
  volume.causes = {{CauseKind::scene, "caf\xe9 \"x\"\n"}, {CauseKind::navigation, "zone 0"}};
  const json report = json::parse(report_json(volume, measure(volume.mesh), {"caf\xe9.yaml", "", "", ""}));
  EXPECT_EQ(report.at("causes")[0].at("name"), "caf\xEF\xBF\xBD \"x\"\n");
  EXPECT_EQ(report.at("causes")[1].at("kind"), "navigation");
}

}  // namespace
}  // namespace vantage::internal::app
