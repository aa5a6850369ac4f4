// The command check and plans that are wrong: one message each, and no file is lost. What is wrong with plans in detail
// is tested with their reader.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/plan_texts.h"
#include "support/wording.h"

namespace vantage::testing {
namespace {

using Json = nlohmann::json;
using plan_texts::plan;
using plan_texts::simple;
using plan_texts::waypoint;

/// A map about 11 E, 48 N, with one building.
class CliCheck : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map({11, 48});
    map.box(30, 0, 40, 10, {{"building", "yes"}});
    write("city.osm", map.text());
    write("map.yaml",
          "scene: {osm: city.osm, center: [48, 11], radius: 150}\nsensor: {max_range: 80}\n"
          "target: {center: [48, 11], width: 4, length: 4}\n");
    write("old.json", kOldOutput);
  }

  void expect_bad_plan(const std::string& name, const std::string& text, const std::string& where) {
    SCOPED_TRACE(text);
    write(name, text);
    expect_bad({"check", "map.yaml", name, "-o", "old.json"}, where);
  }
};

TEST_F(CliCheck, PlansThatAreWrongCostNoFile) {
  expect_bad_plan("a.csv", "lat,lon,agl\n", "a.csv");
  expect_bad_plan("a.csv", "name,agl\nwest,20\n", "a.csv");
  expect_bad_plan("a.csv", "lat,lon,agl\n48,11,nan\n", "line 2");
  expect_bad_plan("a.csv", "lat,lon,alt\n48,11,20\n48,11.001,20\n", "line 2");  // above what?
  expect_bad_plan("a.csv", "lat,lon,agl\n48,11,20\n52.5,13.4,20\n", "line 3");  // another city
  expect_bad_plan("a.csv", "x,y,z\n1,2,1e300\n", "a.csv");
  expect_bad_plan("a.plan", plan({}), "a.plan");
  expect_bad_plan("a.plan", plan({simple(16, 3, "[0, 0, 0, 0, 0, 0, 50]")}), "item 1");
  expect_bad_plan("a.plan", plan({simple(177, 2, "[7, 1, 0, 0, 0, 0, 0]"), waypoint(48, 11, 20)}), "item 1");
  expect_bad_plan("a.plan", plan({waypoint(48, 11, 20, 3, 1), simple(177, 2, "[1, 900000, 0, 0, 0, 0, 0]")}), "item");
  expect_bad_plan("a.plan", plan({"{\"type\": \"ComplexItem\", \"complexItemType\": \"StructureScan\"}"}), "item 1");
  expect_bad_plan("a.kml", plan_texts::kml(""), "a.kml");
  write("a.csv", "lat,lon,agl\n48,11.0001,30\n48,11.0002,30\n");
  expect_bad({"check", "map.yaml", "a.csv", "-o", "a.csv"}, "a.csv");
  expect_bad({"check", "map.yaml", "a.csv", "-o", "old.txt"}, "old.txt");
  expect_bad({"check", "map.yaml", "none.plan", "-o", "old.json"}, "none.plan");
  expect_bad({"check", "map.yaml", "a.csv", "--speed", "0", "-o", "old.json"});
}

// `view` says of a plan what `check` does, before anything is served.
TEST_F(CliCheck, ViewRefusesTheSamePlans) {
  write("page.html", "<!--LIVE-->");
  write("other.csv", "lat,lon,agl\n48,11,20\n52.5,13.4,20\n");
  write("cut.plan", "{\"fileType\": \"Plan\", ");
  write("unknown.csv", "x,y,height\n1,2,30\n2,2,30\n");
  for (const char* const plan : {"other.csv", "cut.plan", "unknown.csv", "none.plan"}) {
    SCOPED_TRACE(plan);
    const ProgramRun check = run({"check", "map.yaml", plan}),
                     view = run({"view", "map.yaml", "--flight", plan, "--page", "page.html"});
    EXPECT_EQ(check.exit_code, 2);
    EXPECT_EQ(view.exit_code, 2);
    EXPECT_EQ(view.out, "");
    EXPECT_EQ(view.err, check.err);
  }
  expect_bad({"view", "map.yaml", "--heights", "scene", "--page", "page.html"}, "command line");
  expect_bad({"view", "map.yaml", "--flight", "-", "--page", "page.html"}, "--flight");
}

TEST_F(CliCheck, WhatIsNotFlownIsTold) {
  write("a.plan", plan({waypoint(48, 11, 30, 3, 1), simple(31010, 2, "[0, 0, 0, 0, 0, 0, 0]"),
                        waypoint(48.0002, 11, 30, 3, 2), simple(177, 2, "[1, 1, 0, 0, 0, 0, 0]")}));
  const ProgramRun check = run({"check", "map.yaml", "a.plan", "--json", "-o", "old.json"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.err.find("31010"), std::string::npos) << check.err;
  const Json answer = Json::parse(check.out);
  // There, back by the jump, and there again.
  EXPECT_NEAR(answer["length_m"].get<double>(), 3 * 0.0002 * 111200, 0.2);
  EXPECT_EQ(Json::parse(content(folder_ / "old.json")), answer);
}

// What moves the vehicle and cannot be followed: no answer passes, and each names it.
TEST_F(CliCheck, PlansThatCannotBeFollowedAreNotJudged) {
  write("a.plan",
        plan({waypoint(48, 11, 30), simple(94, 3, "[10, 0, 0, 0, 48.0001, 11, 30]"), waypoint(48.0002, 11, 30)}));
  const ProgramRun table = run({"check", "map.yaml", "a.plan", "--picture", "a.png"});
  EXPECT_EQ(table.exit_code, 4) << table.err;
  expect_wording(table.out);
  const ProgramRun check = run({"check", "map.yaml", "a.plan", "--json", "-o", "a.csv"});
  EXPECT_EQ(check.exit_code, 4) << check.err;
  const Json answer = Json::parse(check.out);
  EXPECT_EQ(answer["passes"], false);
  ASSERT_EQ(answer["not_judged"].size(), 1u);
  const std::string told = answer["not_judged"][0];
  EXPECT_NE(told.find("item 2"), std::string::npos) << told;
  EXPECT_NE(told.find("94"), std::string::npos) << told;
  EXPECT_NE(content(folder_ / "a.csv").find("\n,not_judged,"), std::string::npos);
  // Also where something fails.
  EXPECT_EQ(run({"check", "map.yaml", "a.plan", "--clearance", "1000"}).exit_code, 4);
  write("b.plan", plan({waypoint(48, 11, 30), waypoint(48.0002, 11, 30)}));
  EXPECT_EQ(run({"check", "map.yaml", "b.plan"}).exit_code, 0);
  // Above ground, and then a spline above the home.
  write("d.plan", plan({waypoint(48, 11, 30, 10), waypoint(48.0001, 11, 30, 10),
                        simple(82, 3, "[0, 0, 0, 0, 48.0002, 11, 30]")}));
  EXPECT_EQ(run({"check", "map.yaml", "d.plan"}).exit_code, 4);
}

// Onto the building, away from the home, and beside it.
TEST_F(CliCheck, LandingsElsewhereAreJudgedDownToTheGround) {
  const auto exit_code = [&](const std::string& at) {
    write("a.plan", plan({waypoint(48, 11, 30), simple(21, 3, "[0, 0, 0, 0, " + at + ", 0]")}));
    return run({"check", "map.yaml", "a.plan", "--clearance", "3"}).exit_code;
  };
  EXPECT_EQ(exit_code("48.00004, 11.00047"), 1);
  EXPECT_EQ(exit_code("48.00004, 11.0002"), 0);
}

// Eastward along an arc that leads 70 m to the north, where the target is out of range.
TEST_F(CliCheck, ArcsAreJudgedAsArcs) {
  const auto seen = [&](const std::string& angle) {
    write("a.plan", plan({waypoint(48, 10.9995, 30), simple(36, 3, "[" + angle + ", 0, 0, null, 48, 11.0005, 30]")}));
    const Json answer = Json::parse(run({"check", "map.yaml", "a.plan", "--json"}).out);
    double length = 0;
    for (const Json& span : answer["targets"][0]["seen"])
      length += span["end_m"].get<double>() - span["begin_m"].get<double>();
    return std::pair(length, answer["length_m"].get<double>());
  };
  EXPECT_EQ(seen("0").first, seen("0").second);
  const auto [length, whole] = seen("300");
  EXPECT_GT(length, 0);
  EXPECT_LT(length, whole / 2);
}

// A pilot behind the building, given as a place on the ground or in coordinates of a system: the same check.
TEST_F(CliCheck, LinksOfAMapAreJudged) {
  write("a.csv", "lat,lon,agl\n48.00004,10.9995,5\n48.00004,11.0007,5\n");
  std::vector<std::string> told;
  for (const std::string place : {"at: [48.00004, 11.0008], height: 1.7", "point: [649247.4322, 5318241.6083, 1.7]"}) {
    write("links.yaml",
          "crs: EPSG:32632\n" + content(folder_ / "map.yaml") + "links:\n  - {name: pilot, " + place + "}\n");
    const ProgramRun check = run({"check", "links.yaml", "a.csv"});
    EXPECT_EQ(check.exit_code, 1) << check.err;
    told.push_back(check.out);
  }
  EXPECT_EQ(told[0], told[1]);
  expect_wording(told[0]);
}

// Heights above a home that the mission puts on a roof.
TEST_F(CliCheck, TheHomeOfTheTourKeepsItsHeight) {
  write("a.csv", "lat,lon,height_home_m\n48.0001,11.0001,20\n48.0002,11.0001,20\n");
  for (const double z : {0.0, 4.0}) {
    write("home.yaml", content(folder_ / "map.yaml") + "tour: {home: [-20, -20, " + std::to_string(z) + "]}\n");
    const Json answer = Json::parse(run({"check", "home.yaml", "a.csv", "--json"}).out);
    EXPECT_NEAR(answer["points"][0]["position"]["z_m"].get<double>(), 20 + z, 1e-9) << answer["points"][0];
  }
}

TEST_F(CliCheck, WhatLiesBeyondTheMapIsTold) {
  write("a.csv", "lat,lon,agl\n48,11.0001,30\n48,11.0002,30\n");
  write("far.yaml", content(folder_ / "map.yaml") + "links:\n  - {name: mast, point: [2000, 0, 30]}\n");
  const ProgramRun check = run({"check", "far.yaml", "a.csv", "--json"});
  expect_wording(check.err);
  EXPECT_EQ(Json::parse(check.out)["notes"].size(), 1U);
}

TEST_F(CliCheck, AnswersSayWhatMissionAndPlanLeaveOut) {
  write("zones.json", R"({"type": "Polygon", "coordinates": [[[11, 48], [11.1, 48], [11.1, 48.1]]]})");
  write("zones.yaml",
        content(folder_ / "map.yaml") + "navigation: {keep_out: [{file: zones.json, heights: any, skip: true}]}\n");
  write("a.plan",
        plan({waypoint(48, 11, 30, 3, 1), simple(31010, 2, "[0, 0, 0, 0, 0, 0, 0]"), waypoint(48.0002, 11, 30, 3, 2)}));
  const ProgramRun check = run({"check", "zones.yaml", "a.plan", "--json", "-o", "a.json"});
  const Json notes = Json::parse(check.out)["notes"];
  EXPECT_EQ(Json::parse(content(folder_ / "a.json"))["notes"], notes);
  const std::string told = notes.dump();
  for (const char* const name : {"zones.json", "31010"}) {
    EXPECT_NE(told.find(name), std::string::npos) << told;
    EXPECT_NE(check.err.find(name), std::string::npos) << check.err;
  }
}

}  // namespace
}  // namespace vantage::testing
