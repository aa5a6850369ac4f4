// Plans of ground stations: what is read of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "io/write_zip.h"
#include "support/plan_texts.h"
#include "support/shared_data.h"
#include "support/wording.h"
#include "vantage/flight.h"

namespace vantage::testing {
namespace {

using namespace plan_texts;

// ---- reading ----

TEST(ReadFlightPlan, TakesTheItemsOfQGroundControl) {
  const FlightPlan read = parsed_plan(plan({
      simple(22, 3, "[0, 0, 0, null, null, null, 20]", 1),
      simple(178, 2, "[1, 8, -1, 0, 0, 0, 0]", 2),
      simple(195, 3, "[0, 0, 0, 0, 48.002, 11.002, 7]", 3),
      simple(16, 3, "[2.5, 3, 0, 90, 48.001, 11.001, 40]", 4),
      simple(2000, 2, "[0, 0, 1, 0, 0, 0, 0]", 5),
      simple(197, 2, "[0, 0, 0, 0, 0, 0, 0]", 6),
      simple(205, 2, "[-30, 0, 15, 0, 0, 0, 2]", 7),
      simple(16, 0, "[0, 0, 0, null, 48.002, 11.001, 560]", 8),
      simple(1000, 2, "[-45, 200, null, null, 16, 0, 0]", 9),
      simple(18, 3, "[2, 0, -30, 0, 48.003, 11.001, 50]", 10),
      simple(19, 10, "[7, 0, 0, 0, 48.003, 11.002, 60]", 11),
      simple(16, 10, "[0, 0, 0, null, 48.004, 11.002, 70]", 12),
      simple(93, 2, "[4, 0, 0, 0, 0, 0, 0]", 13),
      simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]", 14),
  }));
  EXPECT_EQ(read.format, PlanFormat::qgroundcontrol);
  EXPECT_EQ(read.vehicle, PlanVehicle::multirotor);
  EXPECT_EQ(read.speed_m_s, 5);
  ASSERT_TRUE(read.home);
  EXPECT_EQ(read.home->horizontal, Eigen::Vector2d(11, 48));
  EXPECT_EQ(read.home->datum, HeightDatum::sea_level);
  ASSERT_EQ(read.items.size(), 7u);
  EXPECT_EQ(read.items[0].kind, PlanItemKind::takeoff);
  EXPECT_FALSE(read.items[0].position.horizontal.allFinite());
  EXPECT_TRUE(std::isnan(read.items[0].speed_m_s));
  const PlanItem& first = read.items[1];
  EXPECT_EQ(first.position.horizontal, Eigen::Vector2d(11.001, 48.001));
  EXPECT_EQ(first.position.height_m, 40);
  EXPECT_EQ(first.position.datum, HeightDatum::home);
  EXPECT_EQ(first.hold_s, 2.5);
  EXPECT_EQ(first.acceptance_radius_m, 3);
  EXPECT_EQ(first.yaw_deg, 90);
  EXPECT_EQ(first.speed_m_s, 8);
  EXPECT_EQ(first.place, "/data/flight.plan: item 4");
  ASSERT_TRUE(first.look_at);
  EXPECT_EQ(first.look_at->horizontal, Eigen::Vector2d(11.002, 48.002));
  EXPECT_EQ(read.items[2].position.datum, HeightDatum::sea_level);
  EXPECT_FALSE(read.items[2].look_at);
  EXPECT_EQ(read.items[2].gimbal_pitch_deg, -30);
  EXPECT_EQ(read.items[2].gimbal_yaw_deg, 15);
  EXPECT_FALSE(read.items[2].gimbal_yaw_from_north);
  EXPECT_EQ(read.items[3].kind, PlanItemKind::loiter);
  EXPECT_EQ(read.items[3].turns, 2);
  EXPECT_EQ(read.items[3].loiter_radius_m, -30);
  EXPECT_TRUE(read.items[3].gimbal_yaw_from_north);
  EXPECT_EQ(read.items[4].turns, 0);  // a multirotor stays
  EXPECT_EQ(read.items[4].hold_s, 7);
  EXPECT_EQ(read.items[4].position.datum, HeightDatum::ground);
  EXPECT_FALSE(read.items[4].follows_ground);  // what comes before is not above ground
  EXPECT_TRUE(read.items[5].follows_ground);
  EXPECT_EQ(read.items[5].hold_s, 4);
  EXPECT_EQ(read.items[6].kind, PlanItemKind::return_home);
  EXPECT_TRUE(read.notes.empty());
}

TEST(ReadFlightPlan, TakesHeightsThatAreComputedFromTerrain) {
  const auto item = [](const std::string& height, const std::string& above_sea) {
    return simple(16, 0, "[0, 0, 0, null, 48, 11, " + height + "]", 1,
                  ", \"AltitudeMode\": 3, \"Altitude\": 30, \"AMSLAltAboveTerrain\": " + above_sea);
  };
  const FlightPlan read = parsed_plan(plan({item("531", "531"), item("null", "532"), item("null", "null")}));
  ASSERT_EQ(read.items.size(), 3u);
  EXPECT_EQ(read.items[0].position.height_m, 531);
  EXPECT_EQ(read.items[1].position.height_m, 532);
  EXPECT_EQ(read.items[1].position.datum, HeightDatum::sea_level);
  EXPECT_EQ(read.items[2].position.height_m, 30);
  EXPECT_EQ(read.items[2].position.datum, HeightDatum::ground);
  EXPECT_FALSE(read.items[2].follows_ground);
}

TEST(ReadFlightPlan, FollowsJumps) {
  const auto jump = [](int to, int repeat) {
    return simple(177, 2, "[" + std::to_string(to) + ", " + std::to_string(repeat) + ", 0, 0, 0, 0, 0]");
  };
  const std::vector<std::string> two{waypoint(48, 11, 10, 3, 1), waypoint(48.001, 11, 20, 3, 2)};
  const auto heights = [&](const std::string& last) {
    std::vector<double> found;
    for (const PlanItem& item : parsed_plan(plan({two[0], two[1], last, waypoint(48, 11, 30)})).items) {
      found.push_back(item.position.height_m);
    }
    return found;
  };
  EXPECT_EQ(heights(jump(1, 2)), (std::vector<double>{10, 20, 10, 20, 10, 20, 30}));
  EXPECT_EQ(heights(jump(2, 1)), (std::vector<double>{10, 20, 20, 30}));
  EXPECT_EQ(heights(jump(1, 0)), (std::vector<double>{10, 20, 30}));
  EXPECT_EQ(heights(jump(1, -1)), (std::vector<double>{10, 20, 10, 20, 30}));
  EXPECT_TRUE(has_note(parsed_plan(plan({two[0], two[1], jump(1, -1)})).notes, WarningCode::plan_assumed));
  expect_error([&] { parsed_plan(plan({two[0], jump(7, 1)})); }, ErrorCode::index_out_of_range, "item 2");
  expect_error([&] { parsed_plan(plan({two[0], jump(1, 1000000)})); }, ErrorCode::value_out_of_range, "item");
  // A jump onto itself comes to an end, too.
  EXPECT_EQ(parsed_plan(plan({two[0], simple(177, 2, "[5, 3, 0, 0, 0, 0, 0]", 5)})).items.size(), 1u);
}

TEST(ReadFlightPlan, TakesWhatSurveysStore) {
  const auto complex = [](const std::string& type, const std::string& style) {
    return "{\"type\": \"ComplexItem\", \"complexItemType\": \"" + type + "\"" + style + "}";
  };
  const auto style = [](const std::string& members) { return ", \"TransectStyleComplexItem\": {" + members + "}"; };
  const FlightPlan stored = parsed_plan(plan(
      {complex("survey", style("\"Items\": [" + waypoint(48, 11, 40) + ", " + simple(206, 2, "[9, 0, 1, 0, 0, 0, 0]") +
                               ", " + waypoint(48.001, 11, 40) + "]"))}));
  ASSERT_EQ(stored.items.size(), 2u);
  EXPECT_EQ(stored.items[1].place, "/data/flight.plan: item 1 (survey), item 3");
  const std::string points = "\"VisualTransectPoints\": [[48, 11], [48.001, 11]]";
  const auto camera = [](const std::string& more) {
    return ", \"CameraCalc\": {\"DistanceToSurface\": 45" + more + "}";
  };
  const FlightPlan drawn =
      parsed_plan(plan({complex("CorridorScan", style(points + camera(", \"DistanceToSurfaceRelative\": true")))}));
  ASSERT_EQ(drawn.items.size(), 2u);
  EXPECT_EQ(drawn.items[0].position.height_m, 45);
  EXPECT_EQ(drawn.items[0].position.datum, HeightDatum::home);
  EXPECT_EQ(
      parsed_plan(plan({complex("survey", style(points + camera(", \"DistanceMode\": 2")))})).items[0].position.datum,
      HeightDatum::sea_level);
  expect_error(
      [&] {
        parsed_plan(plan({waypoint(48, 11, 40), complex("StructureScan", "")}));
      },
      ErrorCode::value_unsupported, "item 2");
  // The height is over a terrain that the plan does not hold.
  expect_code([&] { parsed_plan(plan({complex("survey", style(points + camera(", \"DistanceMode\": 3")))})); },
              ErrorCode::value_unsupported, "item 1");
  expect_code(
      [&] {
        parsed_plan(plan({complex(
            "survey", style(points + ", \"FollowTerrain\": true" + camera(", \"DistanceToSurfaceRelative\": true")))}));
      },
      ErrorCode::value_unsupported, "item 1");
}

TEST(ReadFlightPlan, TakesPatternsOfLanding) {
  const FlightPlan read = parsed_plan(
      plan({waypoint(48, 11, 40),
            "{\"type\": \"ComplexItem\", \"complexItemType\": \"fwLandingPattern\", \"altitudesAreRelative\": true, "
            "\"landCoordinate\": [48.01, 11, 0], \"landingApproachCoordinate\": [48.02, 11, 30], \"loiterRadius\": 80, "
            "\"loiterClockwise\": false}"},
           1));
  ASSERT_EQ(read.items.size(), 3u);
  EXPECT_EQ(read.items[1].loiter_radius_m, -80);
  EXPECT_EQ(read.items[1].position.height_m, 30);
  EXPECT_EQ(read.items[2].kind, PlanItemKind::land);
  EXPECT_TRUE(has_note(read.notes, WarningCode::plan_assumed));
}

// Flags may be numbers. Without a radius the vehicle has its own; below 0 it circles the other way round.
TEST(ReadFlightPlan, TakesCirclesOfLandingsAsTheyAreStated) {
  const auto approach = [](const std::string& members) {
    return parsed_plan(plan({waypoint(48, 11, 40),
                             "{\"type\": \"ComplexItem\", \"complexItemType\": \"vtolLandingPattern\", "
                             "\"landCoordinate\": [48.01, 11, 0], \"landingApproachCoordinate\": [48.02, 11, 30]" +
                                 members + "}"},
                            20))
        .items.at(1);
  };
  EXPECT_EQ(approach("").kind, PlanItemKind::loiter);
  EXPECT_EQ(approach("").loiter_radius_m, 0);
  EXPECT_EQ(approach(", \"loiterRadius\": -80").loiter_radius_m, -80);
  EXPECT_EQ(approach(", \"loiterRadius\": -80, \"loiterClockwise\": 0").loiter_radius_m, 80);
  EXPECT_EQ(approach(", \"loiterRadius\": 80, \"useLoiterToAlt\": 0").kind, PlanItemKind::waypoint);
  EXPECT_EQ(approach(", \"loiterRadius\": 80, \"useLoiterToAlt\": 1").kind, PlanItemKind::loiter);
  EXPECT_EQ(approach(", \"altitudesAreRelative\": 0").position.datum, HeightDatum::sea_level);
  EXPECT_EQ(approach(", \"loiterAltitudeRelative\": false").position.datum, HeightDatum::sea_level) << "version 1";
  expect_code([&] { approach(", \"altitudesAreRelative\": \"no\""); }, ErrorCode::plan_syntax, "item 2");
}

TEST(ReadFlightPlan, CountsWhatItDoesNotKnow) {
  const FlightPlan read = parsed_plan(
      plan({waypoint(48, 11, 10), simple(31010, 2, "[0, 0, 0, 0, 0, 0, 0]"), simple(40, 3, "[0, 0, 0, 0, 48, 11, 5]"),
            simple(31010, 2, "[0, 0, 0, 0, 0, 0, 0]"), simple(82, 3, "[0, 0, 0, 0, 48.001, 11, 5]"),
            simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]"), waypoint(48, 11, 10)}));
  EXPECT_EQ(read.items.size(), 3u);
  std::vector<std::string> texts = read.not_judged;
  for (const Warning& note : read.notes) texts.push_back(note.text);
  expect_wording(texts);
  EXPECT_EQ(read.not_judged.size(), 1u);
  EXPECT_TRUE(has_note(read.notes, WarningCode::plan_left_out));
  EXPECT_TRUE(has_note(read.notes, WarningCode::plan_assumed));
}

TEST(ReadFlightPlan, NamesWhatMovesTheVehicleElsewhere) {
  const auto not_judged = [](const std::string& item) {
    return parsed_plan(plan({waypoint(48, 11, 10, 3, 1), item, waypoint(48.001, 11, 10)})).not_judged;
  };
  const std::string nowhere = "[2, 0, 0, 0, 0, 0, 0]", somewhere = "[0, 0, 0, null, 48.002, 11, 30]";
  for (const int command : {25,  30,  32,  35,  37,  83,  91,  92,  94,  113,  176,  185,   186,  192,
                            208, 212, 218, 223, 224, 246, 420, 601, 611, 3000, 4001, 42703, 43001}) {
    const std::vector<std::string> told = not_judged(simple(command, 3, nowhere));
    ASSERT_EQ(told.size(), 1u) << command;
    EXPECT_NE(told[0].find("item 2"), std::string::npos) << told[0];
    EXPECT_NE(told[0].find(std::to_string(command)), std::string::npos) << told[0];
    EXPECT_EQ(not_judged(simple(command, 3, somewhere)).size(),
              command == 92 || command == 208 || command == 212 ? 0u : 1u)
        << command;
  }
  EXPECT_TRUE(not_judged(simple(223, 2, "[1, 0, 0, 0, 0, 0, 0]")).empty()) << "the engine starts";
  // Not known: it depends on whether they have a position.
  for (const int command : {31000, 30001, 43000}) {
    EXPECT_EQ(not_judged(simple(command, 3, somewhere)).size(), 1u) << command;
    EXPECT_TRUE(not_judged(simple(command, 2, nowhere)).empty()) << command;
  }
  for (const int command : {112, 189, 206, 2000, 4501, 5001, 5100, 31005}) {
    EXPECT_TRUE(not_judged(simple(command, 3, somewhere)).empty()) << command;
  }
  EXPECT_EQ(not_judged(simple(179, 3, somewhere)).size(), 1u) << "another home in flight";
  const std::string first = simple(179, 0, "[0, 0, 0, 0, 48.01, 11, 500]"),
                    here = simple(179, 0, "[1, 0, 0, 0, 48.01, 11, 500]");
  const FlightPlan home = parsed_plan(plan({first, waypoint(48, 11, 10)}));
  ASSERT_EQ(home.not_judged.size(), 1u) << "it takes off elsewhere than there";
  expect_wording(home.not_judged);
  EXPECT_TRUE(parsed_plan(plan({here, waypoint(48, 11, 10)})).not_judged.empty());
  const std::string disarms = simple(400, 2, "[0, 0, 0, 0, 0, 0, 0]"), lands = simple(21, 3, somewhere) + ", ";
  EXPECT_EQ(not_judged(disarms).size(), 1u);
  EXPECT_TRUE(not_judged(lands + disarms).empty());
  EXPECT_TRUE(not_judged(simple(400, 2, "[1, 0, 0, 0, 0, 0, 0]")).empty()) << "it arms";
  // Each item once, however often it is come to; and of very many the first.
  EXPECT_EQ(not_judged(simple(94, 3, somewhere) + ", " + simple(177, 2, "[1, 3, 0, 0, 0, 0, 0]")).size(), 1u);
  std::string many = simple(94, 3, somewhere);
  for (int i = 0; i < 30; ++i) many += ", " + simple(192, 3, somewhere);
  const std::vector<std::string> told = not_judged(many);
  ASSERT_EQ(told.size(), 21u);
  EXPECT_NE(told.back().find("11 items more"), std::string::npos) << told.back();
}

TEST(ReadFlightPlan, NamesWaypointsThatItPassesBy) {
  const auto read = [](const std::string& radius) {
    return parsed_plan(plan({waypoint(48, 11, 10), simple(16, 3, "[0, 0, " + radius + ", null, 48.001, 11, 10]")}))
        .not_judged;
  };
  ASSERT_EQ(read("80").size(), 1u);
  expect_wording(read("80"));
  EXPECT_EQ(read("-5").size(), 1u);
  EXPECT_TRUE(read("0").empty());
  EXPECT_TRUE(read("null").empty());
}

// The time of a circle replaces its turns; that of a delay is a stay behind it. Nothing with wings stays.
TEST(ReadFlightPlan, TakesDelaysAsStays) {
  const auto read = [](const std::string& before, int vehicle) {
    return parsed_plan(plan({waypoint(48, 11, 50), before, simple(93, 2, "[4, -1, -1, -1, 0, 0, 0]")}, vehicle));
  };
  const std::string turns = simple(18, 3, "[2, 0, 60, 0, 48.001, 11, 50]"),
                    timed = simple(19, 3, "[7, 0, 60, 0, 48.001, 11, 50]"),
                    lands = simple(21, 3, "[0, 0, 0, 0, 48.001, 11, 0]");
  for (const int vehicle : {0, 2}) {
    const PlanItem circle = read(turns, vehicle).items.at(1);
    EXPECT_EQ(circle.hold_s, 4);
    EXPECT_EQ(circle.turns, 2);
    EXPECT_FALSE(circle.is_timed);
    EXPECT_EQ(read(timed, vehicle).items.at(1).is_timed, vehicle == 0);
    EXPECT_EQ(read(timed, vehicle).items[1].hold_s, 11);
    EXPECT_TRUE(read(turns, vehicle).not_judged.empty());
  }
  for (const int vehicle : {1, 20}) {
    const FlightPlan circle = read(turns, vehicle);
    EXPECT_EQ(circle.items.at(1).hold_s, 0);
    ASSERT_EQ(circle.not_judged.size(), 1u);
    EXPECT_EQ(read(waypoint(48.001, 11, 50), vehicle).not_judged.size(), 1u);
    EXPECT_EQ(read(timed, vehicle).items.at(1).hold_s, 7);
    EXPECT_TRUE(read(timed, vehicle).items[1].is_timed);
    EXPECT_TRUE(read(lands, vehicle).not_judged.empty()) << "it stands on the ground";
    EXPECT_EQ(read(lands, vehicle).items.at(1).hold_s, 4);
    if (vehicle == 1) expect_wording(circle.not_judged);
  }
}

// Where the vehicle stops it comes to the waypoint.
TEST(ReadFlightPlan, TellsOfCornersThatMayBeCut) {
  const auto notes = [](const std::string& hold, int vehicle) {
    return parsed_plan(plan({waypoint(48, 11, 10), simple(16, 3, "[" + hold + ", 80, 0, null, 48.001, 11, 10]"),
                             simple(16, 3, "[0, 5, 0, null, 48.002, 11, 10]"), waypoint(48.003, 11, 10)},
                            vehicle))
        .notes;
  };
  ASSERT_EQ(notes("0", 2).size(), 1u);
  expect_wording({notes("0", 2)[0].text, notes("3", 2).at(0).text});
  EXPECT_EQ(notes("3", 1).at(0).text, notes("0", 1).at(0).text);
}

TEST(ReadFlightPlan, TellsOfSettingsTimesOfTheDayAndLandingsInsteadOfReturns) {
  const auto read = [](const std::string& item) {
    return parsed_plan(plan({waypoint(48, 11, 10), item, simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]")}));
  };
  const FlightPlan settings = read(simple(180, 2, "[5, 2, 0, 0, 0, 0, 0]")),
                   until = read(simple(93, 2, "[-1, 12, 30, 0, 0, 0, 0]"));
  ASSERT_EQ(settings.notes.size(), 1u);
  EXPECT_EQ(settings.notes[0].code, WarningCode::plan_left_out);
  ASSERT_EQ(until.notes.size(), 1u);
  EXPECT_EQ(until.notes[0].code, WarningCode::plan_assumed);
  expect_wording({settings.notes[0].text, until.notes[0].text});
  EXPECT_TRUE(read(simple(93, 2, "[1, 0, 0, 0, 0, 0, 0]")).notes.empty());
  const std::vector<std::string> lands = read(simple(189, 3, "[0, 0, 0, 0, 48.001, 11, 5]")).not_judged;
  ASSERT_EQ(lands.size(), 1u);
  expect_wording(lands);
}

// Also behind the return.
TEST(ReadFlightPlan, NamesLandingsThatItMayReturnTo) {
  const auto read = [](const std::string& item, int autopilot = 12) {
    std::string text = plan({waypoint(48, 11, 10), simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]"), item}, 1);
    const std::string key = "\"firmwareType\": ";
    return parsed_plan(text.replace(text.find(key) + key.size(), 2, std::to_string(autopilot))).not_judged;
  };
  const std::string pattern =
      "{\"type\": \"ComplexItem\", \"complexItemType\": \"fwLandingPattern\", \"landCoordinate\": [48.01, 11, 0], "
      "\"landingApproachCoordinate\": [48.02, 11, 30], \"loiterRadius\": 80}";
  const std::string place = "[0, 0, 0, 0, 48.001, 11, 5]";
  std::vector<std::string> told;
  for (const std::string& item : {pattern, simple(188, 3, place), simple(21, 3, place)}) {
    const std::vector<std::string> texts = read(item);
    ASSERT_EQ(texts.size(), 1u) << item;
    told.push_back(texts[0]);
  }
  expect_wording(told);
  constexpr int kArduPilot = 3;
  EXPECT_EQ(read(pattern, kArduPilot).size(), 1u);
  EXPECT_EQ(read(simple(188, 3, place), kArduPilot).size(), 1u);
  EXPECT_TRUE(read(simple(21, 3, place), kArduPilot).empty());
}

// One with a circle before it lands somewhere on that.
TEST(ReadFlightPlan, TakesThePlaceBeforeForItemsWithoutOne) {
  const std::string up = simple(22, 3, "[0, 0, 0, null, 0, 0, 100]"), down = simple(21, 3, "[0, 0, 0, null, 0, 0, 0]"),
                    circle = simple(18, 3, "[1, 0, 60, 0, 48.001, 11, 50]");
  const FlightPlan read = parsed_plan(plan({waypoint(48.001, 11, 50), up, down}));
  EXPECT_EQ(read.items[1].position.horizontal, Eigen::Vector2d(11, 48.001));
  EXPECT_EQ(read.items[2].position.horizontal, Eigen::Vector2d(11, 48.001));
  EXPECT_TRUE(read.not_judged.empty());
  const std::vector<std::string> somewhere = parsed_plan(plan({circle, down})).not_judged;
  ASSERT_EQ(somewhere.size(), 1u);
  expect_wording(somewhere);
}

TEST(ReadFlightPlan, CirclesOnceAtLeast) {
  const auto turns = [](const std::string& number) {
    return parsed_plan(plan({simple(18, 3, "[" + number + ", 0, 60, 0, 48.001, 11, 50]")})).items.at(0).turns;
  };
  EXPECT_EQ(turns("0"), 1);
  EXPECT_EQ(turns("null"), 1);
  EXPECT_EQ(turns("-3"), 3);
  EXPECT_EQ(turns("0.25"), 0.25);
  EXPECT_EQ(turns("2"), 2);
}

TEST(ReadFlightPlan, NamesRallyPointsThatItMayReturnTo) {
  const auto with = [](const std::string& points, const std::vector<std::string>& items) {
    std::string text = plan(items);
    text.insert(1, "\"rallyPoints\": {\"points\": [" + points + "], \"version\": 2}, ");
    return parsed_plan(text).not_judged;
  };
  const std::string home = simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]");
  const std::vector<std::string> told = with("[48, 11, 30], [48.001, 11, 30]", {waypoint(48, 11, 10), home});
  ASSERT_EQ(told.size(), 1u);
  expect_wording(told);
  EXPECT_TRUE(with("", {waypoint(48, 11, 10), home}).empty());
  EXPECT_TRUE(with("[48, 11, 30]", {waypoint(48, 11, 10)}).empty());
  // As rows of a table, also behind the return.
  const std::string way =
                        "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t500\t1\n"
                        "1\t0\t3\t16\t0\t0\t0\t0\t48\t11\t30\t1\n",
                    back = "1\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1\n",
                    rally = "2\t0\t3\t5100\t0\t0\t0\t0\t48.001\t11\t30\t1\n";
  const std::vector<std::string> rows = parsed_plan(way + back + rally).not_judged;
  ASSERT_EQ(rows.size(), 1u);
  expect_wording(rows);
  EXPECT_EQ(parsed_plan(way + rally + back).not_judged.size(), 1u);
  EXPECT_TRUE(parsed_plan(way + rally).not_judged.empty());
  EXPECT_TRUE(parsed_plan(way + back).not_judged.empty());
}

TEST(ReadFlightPlan, TellsThatFencesAreNotJudged) {
  const auto with = [](const std::string& members) {
    std::string text = plan({waypoint(48, 11, 10)});
    text.insert(1, "\"geoFence\": {" + members + "}, ");
    return parsed_plan(text).notes;
  };
  const std::string square = "\"polygons\": [{\"inclusion\": true, \"polygon\": [[48, 11], [48, 12], [49, 12]]}]";
  const std::vector<Warning> polygon = with(square), circle = with("\"circles\": [{\"inclusion\": false}]");
  ASSERT_EQ(polygon.size(), 1u);
  EXPECT_EQ(polygon[0].code, WarningCode::plan_left_out);
  expect_wording(polygon[0].text);
  EXPECT_TRUE(has_note(circle, WarningCode::plan_left_out));
  EXPECT_TRUE(has_note(with("\"polygon\": [[48, 11], [48, 12], [49, 12]]"), WarningCode::plan_left_out)) << "old";
  EXPECT_TRUE(with("\"circles\": [], \"polygons\": [], \"breachReturn\": [48, 11, 30]").empty());
  const std::string way =
      "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t500\t1\n"
      "1\t0\t3\t16\t0\t0\t0\t0\t48\t11\t30\t1\n";
  for (const std::string command : {"5001", "5002", "5003", "5004"}) {
    const FlightPlan read = parsed_plan(way + "1\t0\t3\t" + command + "\t3\t0\t0\t0\t48.001\t11\t0\t1\n");
    EXPECT_TRUE(has_note(read.notes, WarningCode::plan_left_out)) << command;
    EXPECT_EQ(read.notes.size(), 2u) << command << ", and the home";
  }
  EXPECT_EQ(parsed_plan(way + "1\t0\t3\t5000\t0\t0\t0\t0\t48.001\t11\t0\t1\n").notes.size(), 1u);
}

// Of the ground station's own samples nothing is left out but a fence; one has rally points, and returns.
TEST(ReadFlightPlan, ReadsRealPlansWhole) {
  VANTAGE_REQUIRE_SHARED("missions/simple.plan");
  for (const std::string name : {"qgroundcontrol_sample", "qgroundcontrol_sample_with_survey", "simple"}) {
    const FlightPlan read = read_flight_plan(shared_data("missions/" + name + ".plan"));
    EXPECT_EQ(read.not_judged.size(), name == "simple" ? 1u : 0u) << name;
    EXPECT_EQ(has_note(read.notes, WarningCode::plan_left_out), name == "simple") << name;
  }
}

TEST(ReadFlightPlan, TakesArcsAndOrbits) {
  const auto read = [](const std::string& arc, const std::string& before = waypoint(48, 11, 10)) {
    return parsed_plan(plan({before, arc, waypoint(48.002, 11, 10)}));
  };
  const auto arc = [](const std::string& first, const std::string& second) {
    return simple(36, 3, "[" + first + ", " + second + ", 0, null, 48.001, 11, 30]");
  };
  const FlightPlan standard = read(arc("-270", "0"));
  ASSERT_EQ(standard.items.size(), 3u);
  EXPECT_EQ(standard.items[1].kind, PlanItemKind::waypoint);
  EXPECT_EQ(standard.items[1].arc_deg, -270);
  EXPECT_EQ(standard.items[1].position.height_m, 30);
  EXPECT_TRUE(standard.not_judged.empty());
  EXPECT_TRUE(standard.notes.empty());
  const FlightPlan early = read(arc("0", "180"));
  EXPECT_EQ(early.items[1].arc_deg, 180);
  EXPECT_TRUE(early.not_judged.empty());
  ASSERT_EQ(early.notes.size(), 1u);
  expect_wording(early.notes[0].text);
  EXPECT_TRUE(read(arc("0", "null")).not_judged.empty()) << "a straight leg";
  const std::string takeoff = simple(22, 3, "[0, 0, 0, null, null, null, 20]");
  EXPECT_TRUE(read(arc("0", "0"), takeoff).not_judged.empty()) << "a straight leg";
  std::vector<std::string> told;
  for (const FlightPlan& plan :
       {read(arc("90", "90")), read(arc("720", "0")), read(arc("90", "0"), takeoff), read(arc("1e9", "0")),
        read(arc("90", "0"), simple(82, 3, "[0, 0, 0, 0, 48, 11, 5]"))}) {
    ASSERT_EQ(plan.not_judged.size(), 1u);
    EXPECT_EQ(plan.items.size(), 3u);
    told.push_back(plan.not_judged[0]);
  }
  expect_wording(told);
  const FlightPlan orbit = read(simple(34, 3, "[-25, 3, 0, 4.71238898038469, 48.001, 11, 30]"));
  EXPECT_TRUE(orbit.not_judged.empty());
  EXPECT_EQ(orbit.items[1].kind, PlanItemKind::loiter);
  EXPECT_EQ(orbit.items[1].loiter_radius_m, -25);
  EXPECT_NEAR(orbit.items[1].turns, 0.75, 1e-12);
  EXPECT_EQ(orbit.items[1].speed_m_s, 3);
  const FlightPlan endless = read(simple(34, 3, "[25, null, 0, null, 48.001, 11, 30]"));
  EXPECT_EQ(endless.items[1].turns, 1);
  EXPECT_TRUE(has_note(endless.notes, WarningCode::plan_assumed));
}

TEST(ReadFlightPlan, NamesSplinesThatNobodyDefines) {
  const std::string spline = simple(82, 3, "[0, 0, 0, 0, 48.002, 11, 5]"),
                    arc = simple(36, 3, "[90, 0, 0, 0, 48.001, 11, 5]");
  EXPECT_TRUE(parsed_plan(plan({waypoint(48, 11, 10), spline})).not_judged.empty());
  EXPECT_EQ(parsed_plan(plan({waypoint(48, 11, 10), arc, spline})).not_judged.size(), 1u);
  EXPECT_EQ(parsed_plan(plan({waypoint(48, 11, 10), spline, simple(93, 2, "[3, 0, 0, 0, 0, 0, 0]")})).not_judged.size(),
            1u);
}

/// A plan for an autopilot (MAV_AUTOPILOT: 3 is ArduPilot, 12 PX4) and a kind of vehicle (MAV_TYPE).
FlightPlan plan_for(int autopilot, int vehicle, const std::vector<std::string>& items) {
  std::string text = plan(items, vehicle);
  const std::string px4 = "\"firmwareType\": 12";
  return parsed_plan(text.replace(text.find(px4), px4.size(), "\"firmwareType\": " + std::to_string(autopilot)));
}

TEST(ReadFlightPlan, KeepsTheHeightBeforeForTheHeightZero) {
  const std::string up = simple(22, 3, "[0, 0, 0, null, null, null, 50]"),
                    here = simple(17, 3, "[0, 0, 0, 0, 0, 0, 0]");
  const FlightPlan read = plan_for(3, 2,
                                   {up, waypoint(48, 11.001, 0), simple(82, 0, "[0, 0, 0, 0, 48.001, 11.001, 0]"),
                                    simple(21, 3, "[0, 0, 0, 0, 48, 11, 0]")});
  ASSERT_EQ(read.items.size(), 4u);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(read.items[i].position.height_m, 50);
    EXPECT_EQ(read.items[i].position.datum, HeightDatum::home);
  }
  EXPECT_EQ(read.items[3].position.height_m, 0) << "it lands";
  EXPECT_TRUE(read.not_judged.empty());
  std::vector<std::string> texts;
  for (const Warning& note : read.notes) texts.push_back(note.text);
  expect_wording(texts);
  // Of other autopilots 0 is a height, and of ArduPilot's Plane where there is a position.
  const auto second = [](int autopilot, int vehicle, const std::string& item) {
    const FlightPlan two = plan_for(autopilot, vehicle, {waypoint(48, 11, 50), item});
    EXPECT_TRUE(two.not_judged.empty()) << autopilot << ", " << vehicle;
    return two.items[1].position.height_m;
  };
  const std::string there = waypoint(48.001, 11, 0);
  EXPECT_EQ(second(3, 2, there), 50);
  EXPECT_EQ(second(12, 2, there), 0);
  EXPECT_EQ(second(3, 1, there), 0);
  EXPECT_EQ(second(3, 20, there), 0);
  EXPECT_EQ(second(3, 2, here), 50);
  EXPECT_EQ(second(12, 2, here), 0);
  EXPECT_EQ(second(3, 1, here), 50);
  // A loiter climbs to its own height, also to 0.
  EXPECT_EQ(second(3, 2, simple(31, 3, "[0, 30, 0, 0, 48.001, 11, 0]")), 0);
  // Over another ground the height is not that of the item before.
  EXPECT_EQ(plan_for(3, 2, {waypoint(48, 11, 50, 10), there}).not_judged.size(), 1u);
}

// A Copter keeps the height, and others descend: unless that is the same.
TEST(ReadFlightPlan, NamesHeightsOfZeroThatNobodyKnows) {
  const auto read = [](const std::vector<std::string>& items) { return plan_for(0, 2, items); };
  const std::string up = waypoint(48, 11, 50), low = waypoint(48, 11, 0);
  const FlightPlan descends = read({up, waypoint(48, 11.001, 0), waypoint(48, 11.002, 40)});
  ASSERT_EQ(descends.not_judged.size(), 1u);
  expect_wording(descends.not_judged);
  EXPECT_EQ(read({up, waypoint(48, 11.001, 0, 10)}).not_judged.size(), 1u) << "above another ground";
  EXPECT_EQ(read({low, waypoint(48, 11.001, 0, 0)}).not_judged.size(), 1u) << "above another level";
  EXPECT_TRUE(read({low, waypoint(48, 11.001, 0)}).not_judged.empty());
  for (const auto& [autopilot, vehicle, count] : {std::tuple(0, 2, 1u), {3, 0, 1u}, {0, 1, 0u}, {12, 0, 0u}}) {
    const std::string back = simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]");
    EXPECT_EQ(plan_for(autopilot, vehicle, {up, waypoint(48.001, 11, 0), back}).not_judged.size(), count)
        << autopilot << ", " << vehicle;
  }
  // Without a position, too; of fixed wings these alone.
  const std::string here = simple(17, 3, "[0, 0, 0, 0, 0, 0, 0]");
  for (const int vehicle : {1, 2, 20}) EXPECT_EQ(plan_for(0, vehicle, {up, here}).not_judged.size(), 1u) << vehicle;
}

// Its Plane climbs straight ahead, returns when the mission is over, and changes heights a little, or low, at once.
TEST(ReadFlightPlan, NamesWaysOfArduPilotsPlane) {
  constexpr int kArduPilot = 3, kPx4 = 12, kPlane = 1, kVtol = 20;
  const std::string up = simple(22, 3, "[0, 0, 0, null, 48, 11, 50]"),
                    vtol_up = simple(84, 3, "[0, 1, 0, null, 48, 11, 50]"),
                    stays = simple(17, 3, "[0, 0, 60, 0, 48.002, 11, 50]"),
                    back = simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]");
  const auto told = [&](int autopilot, int vehicle, const std::vector<std::string>& items) {
    return plan_for(autopilot, vehicle, items).not_judged;
  };
  const std::string level = waypoint(48.001, 11, 50);
  ASSERT_EQ(told(kArduPilot, kPlane, {up, level}).size(), 1u);
  expect_wording(told(kArduPilot, kPlane, {up, level}));
  EXPECT_EQ(told(0, kPlane, {up, level, back}).size(), 1u);
  EXPECT_TRUE(told(kPx4, kPlane, {up, level}).empty());
  EXPECT_TRUE(told(kArduPilot, kVtol, {vtol_up, level}).empty()) << "straight up";
  EXPECT_TRUE(told(kArduPilot, 2, {up, level}).empty());
  // The end.
  const auto last = [&](int autopilot, const std::vector<std::string>& items) {
    return plan_for(autopilot, kPlane, items).items.back().kind;
  };
  EXPECT_EQ(last(kArduPilot, {level, level}), PlanItemKind::return_home);
  EXPECT_EQ(last(kArduPilot, {level, stays}), PlanItemKind::loiter);
  EXPECT_EQ(last(kArduPilot, {level, simple(21, 3, "[0, 0, 0, 0, 48.002, 11, 0]")}), PlanItemKind::land);
  EXPECT_EQ(last(kPx4, {level, level}), PlanItemKind::waypoint);
  EXPECT_EQ(plan_for(kArduPilot, kPlane, {level, back}).items.size(), 2u);
  ASSERT_EQ(told(0, kPlane, {level, level}).size(), 1u);
  expect_wording(told(0, kPlane, {level, level}));
  // From one height to another one, above the home, which is at 500 m, or above the sea level.
  const auto slope = [&](double from, double to, int frame = 3, int next_frame = 3) {
    return told(kArduPilot, kPlane, {waypoint(48, 11, from, frame), waypoint(48.01, 11, to, next_frame)}).size();
  };
  for (const auto& [from, to] : {std::pair(50.0, 64.0), {64.0, 50.0}, {20.0, 90.0}, {50.0, 50.1}}) {
    EXPECT_EQ(slope(from, to), 1u) << from << " to " << to;
    EXPECT_EQ(slope(from + 500, to + 500, 0, 0), 1u) << from << " to " << to;
  }
  for (const auto& [from, to] : {std::pair(50.0, 65.0), {90.0, 5.0}, {21.0, 90.0}, {50.0, 50.0}}) {
    EXPECT_EQ(slope(from, to), 0u) << from << " to " << to;
    EXPECT_EQ(slope(from + 500, to + 500, 0, 0), 0u) << from << " to " << to;
  }
  EXPECT_EQ(slope(50, 570, 3, 0), 1u) << "of two levels";
  expect_wording(told(kArduPilot, kPlane, {waypoint(48, 11, 50), waypoint(48.01, 11, 60)}));
  EXPECT_TRUE(told(kPx4, kPlane, {waypoint(48, 11, 50), waypoint(48.01, 11, 60)}).empty());
  EXPECT_TRUE(told(kArduPilot, 2, {waypoint(48, 11, 50), waypoint(48.01, 11, 60)}).empty());
}

// Radii, turns and seconds are whole there, and a radius for a time is none.
TEST(ReadFlightPlan, RoundsNumbersAsArduPilotDoes) {
  constexpr int kArduPilot = 3, kPx4 = 12;
  const auto circle = [](int command, const std::string& first, const std::string& radius) {
    const std::string second = command == 31 ? radius : "0";
    return simple(command, 3, "[" + first + ", " + second + ", " + radius + ", 0, 48.001, 11, 50]");
  };
  const auto read = [](int autopilot, const std::string& item, int vehicle = 2) {
    return plan_for(autopilot, vehicle, {waypoint(48, 11, 50), item, simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]")});
  };
  const auto radius = [&](const std::string& stated, int command = 18) {
    return read(kArduPilot, circle(command, "2", stated), 1).items.at(1).loiter_radius_m;
  };
  EXPECT_EQ(radius("20.9"), 20);
  EXPECT_EQ(radius("-20.9"), -20);
  EXPECT_EQ(radius("255.5"), 255);
  EXPECT_EQ(radius("299"), 290);
  EXPECT_EQ(radius("9999"), 2550);
  EXPECT_EQ(radius("299.5", 17), 299);
  EXPECT_EQ(radius("299.5", 31), 299);
  EXPECT_EQ(radius("50", 19), 0);
  EXPECT_TRUE(std::signbit(radius("-50", 19))) << "its own, the other way round";
  EXPECT_EQ(read(kPx4, circle(18, "2", "20.9")).items[1].loiter_radius_m, 20.9);
  EXPECT_EQ(read(kPx4, circle(19, "2", "50"), 1).items[1].loiter_radius_m, 50);
  std::vector<std::string> told;
  for (const auto& [item, vehicle] :
       {std::pair(circle(18, "2", "20.9"), 2), {circle(18, "2.5", "20"), 2}, {circle(19, "9", "50"), 1}}) {
    const std::vector<std::string> texts = read(0, item, vehicle).not_judged;
    ASSERT_EQ(texts.size(), 1u) << item;
    told.push_back(texts[0]);
    EXPECT_TRUE(read(kPx4, item, vehicle).not_judged.empty()) << item;
  }
  expect_wording(told);
  EXPECT_EQ(read(kArduPilot, circle(18, "2.5", "20")).not_judged.size(), 1u);
  EXPECT_TRUE(read(0, circle(18, "2", "20")).not_judged.empty());
  const std::string stays = simple(16, 3, "[2.9, 0, 0, 0, 48.001, 11, 50]");
  EXPECT_EQ(read(kArduPilot, stays).items[1].hold_s, 2);
  EXPECT_EQ(read(0, stays).items[1].hold_s, 2);
  EXPECT_EQ(read(kPx4, stays).items[1].hold_s, 2.9);
  EXPECT_EQ(read(kArduPilot, circle(19, "7.9", "0")).items[1].hold_s, 7);
}

// PX4 stays at an item that does not lead on; ArduPilot has no such thing.
TEST(ReadFlightPlan, NamesItemsThatDoNotLeadOn) {
  std::string halts = waypoint(48, 11, 10);
  halts.replace(halts.find("true"), 4, "false");
  const auto told = [&](int autopilot, const std::vector<std::string>& items) {
    return plan_for(autopilot, 2, items).not_judged;
  };
  ASSERT_EQ(told(12, {halts, waypoint(48.001, 11, 10)}).size(), 1u);
  expect_wording(told(12, {halts, waypoint(48.001, 11, 10)}));
  EXPECT_EQ(told(0, {halts, waypoint(48.001, 11, 10)}).size(), 1u);
  EXPECT_TRUE(told(3, {halts, waypoint(48.001, 11, 10)}).empty());
  EXPECT_TRUE(told(12, {waypoint(48.001, 11, 10), halts}).empty()) << "the last one";
  const std::string home = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t510\t0\n",
                    row = "\t0\t3\t16\t0\t0\t0\t0\t48.001\t11\t50\t";
  EXPECT_TRUE(parsed_plan(home + "1" + row + "1\n2" + row + "0\n").not_judged.empty());
  EXPECT_EQ(parsed_plan(home + "1" + row + "0\n2" + row + "1\n").not_judged.size(), 1u);
}

// Jumps name rows of tables, and whole numbers that one item alone has.
TEST(ReadFlightPlan, RefusesJumpsThatNameNoItem) {
  const std::string home = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t510\t1\n",
                    row = "\t0\t3\t16\t0\t0\t0\t0\t48.001\t11\t50\t1\n", jump = "\t0\t3\t177\t1\t1\t0\t0\t0\t0\t0\t1\n";
  EXPECT_EQ(parsed_plan(home + "1" + row + "2" + row + "3" + jump).items.size(), 4u);
  expect_error([&] { parsed_plan(home + "2" + row + "1" + row + "3" + jump); }, ErrorCode::plan_syntax, "item 2");
  expect_code([&] { parsed_plan(home + "1" + row + "1" + row + "3" + jump); }, ErrorCode::plan_syntax, "item 1");
  EXPECT_EQ(parsed_plan(home + "2" + row + "1" + row).items.size(), 2u) << "nothing names them";
  const auto to = [](const std::string& id, int second) {
    parsed_plan(plan({waypoint(48, 11, 10, 3, 1), waypoint(48.001, 11, 10, 3, second),
                      simple(177, 2, "[" + id + ", 1, 0, 0, 0, 0, 0]", 9)}));
  };
  to("1", 2);
  expect_error([&] { to("1.6", 2); }, ErrorCode::index_out_of_range, "item 3");
  expect_error([&] { to("1", 1); }, ErrorCode::index_out_of_range, "item 3");
}

// ArduPilot's first row is the home, whatever it says; others fly it.
TEST(ReadFlightPlan, NamesFirstRowsThatAreNoHome) {
  const auto told = [](const std::string& frame, const std::string& command) {
    return parsed_plan("QGC WPL 110\n0\t1\t" + frame + "\t" + command +
                       "\t0\t0\t0\t0\t48\t11\t50\t1\n1\t0\t3\t16\t0\t0\t0\t0\t48.001\t11\t50\t1\n")
        .not_judged;
  };
  EXPECT_TRUE(told("0", "16").empty());
  ASSERT_EQ(told("3", "16").size(), 1u);
  expect_wording(told("3", "16"));
  EXPECT_EQ(told("3", "22").size(), 1u);
}

// -2 is the vehicle's own speed, and with PX4 all that is none.
TEST(ReadFlightPlan, ForgetsASpeedForTheVehiclesOwn) {
  const auto speed = [](int autopilot, const std::string& next) {
    return plan_for(autopilot, 2,
                    {simple(178, 2, "[1, 0.5, -1, 0, 0, 0, 0]"), simple(178, 2, "[1, " + next + ", -1, 0, 0, 0, 0]"),
                     waypoint(48, 11, 50)})
        .items.at(0)
        .speed_m_s;
  };
  for (const int autopilot : {0, 3, 12}) EXPECT_TRUE(std::isnan(speed(autopilot, "-2"))) << autopilot;
  EXPECT_TRUE(std::isnan(speed(12, "-1")));
  EXPECT_EQ(speed(3, "-1"), 0.5);
  EXPECT_EQ(speed(12, "3"), 3);
}

TEST(ReadFlightPlan, NamesTransitionsToOtherWays) {
  const auto told = [](const std::string& heading) {
    return parsed_plan(plan({simple(84, 3, "[0, " + heading + ", 0, 270, 48, 11, 50]"), waypoint(48.001, 11, 50)}, 22))
        .not_judged;
  };
  for (const std::string heading : {"0", "1", "null"}) EXPECT_TRUE(told(heading).empty()) << heading;
  ASSERT_EQ(told("3").size(), 1u);
  expect_wording(told("3"));
}

TEST(ReadFlightPlan, TellsVersionsThatItDoesNotKnow) {
  std::string text = plan({waypoint(48, 11, 50)});
  EXPECT_TRUE(parsed_plan(text).notes.empty());
  text.replace(text.find("\"version\": 1"), 12, "\"version\": 42");
  text.replace(text.find("\"version\": 2"), 12, "\"version\": 7");
  const std::vector<Warning> notes = parsed_plan(text).notes;
  ASSERT_EQ(notes.size(), 2u);
  expect_wording({notes[0].text, notes[1].text});
}

TEST(ReadFlightPlan, RefusesHeightsThatContradictEachOther) {
  const auto item = [](const std::string& mode, int frame, const std::string& more) {
    return simple(16, frame, "[0, 0, 0, null, 48, 11, 50]", 1, ", \"AltitudeMode\": " + mode + ", " + more);
  };
  const auto read = [&](const std::string& text) { return parsed_plan(plan({text})); };
  expect_error([&] { read(item("3", 0, "\"Altitude\": 50, \"AMSLAltAboveTerrain\": 550")); },
               ErrorCode::conflicting_keys, "item 1");
  expect_error([&] { read(item("1", 3, "\"Altitude\": 30, \"AMSLAltAboveTerrain\": null")); },
               ErrorCode::conflicting_keys, "item 1");
  expect_code([&] { read(item("\"CalcAboveTerrain\"", 0, "\"Altitude\": 50, \"AMSLAltAboveTerrain\": 550")); },
              ErrorCode::conflicting_keys, "item 1");
  EXPECT_EQ(read(item("3", 0, "\"Altitude\": 20, \"AMSLAltAboveTerrain\": 50.01")).items[0].position.height_m, 50);
  EXPECT_EQ(read(item("1", 3, "\"Altitude\": 50, \"AMSLAltAboveTerrain\": 12")).items[0].position.height_m, 50);
  EXPECT_EQ(read(item("\"Absolute\"", 0, "\"Altitude\": 50")).items[0].position.height_m, 50);
  // Whatever the mode is, and where the frame is not that of the mode.
  for (const std::string mode : {"\"Relative\"", "0", "9", "null"}) {
    expect_code([&] { read(item(mode, 3, "\"Altitude\": 12")); }, ErrorCode::conflicting_keys, "item 1");
  }
  expect_code([&] { read(simple(16, 3, "[0, 0, 0, null, 48, 11, 50]", 1, ", \"Altitude\": 12")); },
              ErrorCode::conflicting_keys, "item 1");
  expect_error([&] { read(item("1", 0, "\"Altitude\": 50")); }, ErrorCode::conflicting_keys, "item 1");
  for (const auto& [mode, frame] : {std::pair("4", 3), {"2", 3}, {"3", 10}, {"\"Relative\"", 10}}) {
    expect_code([&, mode = mode, frame = frame] { read(item(mode, frame, "\"Altitude\": 50")); },
                ErrorCode::conflicting_keys, "item 1");
  }
  EXPECT_EQ(read(item("4", 10, "\"Altitude\": 50")).items[0].position.datum, HeightDatum::ground);
}

TEST(ReadFlightPlan, TakesTablesOfWaypoints) {
  const std::string table =
      "QGC WPL 110\r\n"
      "0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t510\t1\r\n"
      "1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t20\t1\r\n"
      "2\t0\t3\t16\t1.5\t0\t0\tnan\t48.001\t11.001\t40\t1\r\n"
      "3\t0\t3\t177\t2\t1\t0\t0\t0\t0\t0\t1\r\n";
  const FlightPlan read = parsed_plan(table);
  EXPECT_EQ(read.format, PlanFormat::waypoints);
  ASSERT_TRUE(read.home);
  EXPECT_EQ(read.home->height_m, 510);
  EXPECT_TRUE(has_note(read.notes, WarningCode::plan_assumed));
  ASSERT_EQ(read.items.size(), 3u);
  EXPECT_EQ(read.items[0].kind, PlanItemKind::takeoff);
  EXPECT_EQ(read.items[1].hold_s, 1) << "of 1.5, as ArduPilot stores it";
  EXPECT_EQ(read.items[1].place, "/data/flight.plan: line 4, item 2");
  expect_error([] { parsed_plan("QGC WPL 100\n"); }, ErrorCode::value_unsupported, "line 1");
  expect_error([] { parsed_plan("QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t510\n"); }, ErrorCode::plan_syntax,
               "line 2");
  expect_error([] { parsed_plan("QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\tnan\t11\t510\t1\n"); }, ErrorCode::not_a_number,
               "line 2, item 0");
  expect_error([] { parsed_plan("QGC WPL 110\n"); }, ErrorCode::plan_empty);
}

TEST(ReadFlightPlan, TakesLinesAndTracksOfKml) {
  const FlightPlan line = parsed_plan(kml(kml_line("11,48,520 11.001,48,530\n11.001,48.001,540")));
  EXPECT_EQ(line.format, PlanFormat::kml);
  ASSERT_EQ(line.items.size(), 3u);
  EXPECT_EQ(line.items[2].position.horizontal, Eigen::Vector2d(11.001, 48.001));
  EXPECT_EQ(line.items[2].position.height_m, 540);
  EXPECT_EQ(line.items[2].position.datum, HeightDatum::sea_level);
  EXPECT_EQ(line.items[2].place, "/data/flight.plan: line 3, position 3");
  EXPECT_EQ(parsed_plan(kml(kml_line("11,48,20", "relativeToGround"))).items[0].position.datum, HeightDatum::ground);
  const PlanItem clamped = parsed_plan(kml(kml_line("11,48,20", "clampToGround"))).items[0];
  EXPECT_EQ(clamped.position.datum, HeightDatum::unknown);
  EXPECT_EQ(clamped.position.height_m, 20);
  EXPECT_TRUE(std::isnan(parsed_plan(kml(kml_line("11,48,0", "clampToGround"))).items[0].position.height_m));
  const FlightPlan track = parsed_plan(
      kml("<Placemark><gx:Track><altitudeMode>absolute</altitudeMode><when>2020</when><gx:coord>11 48 500</gx:coord>"
          "<gx:coord>11.5 48 510</gx:coord></gx:Track></Placemark><Placemark><Point><coordinates>1,2,3</coordinates>"
          "</Point></Placemark>"));
  ASSERT_EQ(track.items.size(), 2u);
  EXPECT_EQ(track.items[1].position.height_m, 510);
  const auto point = [](const std::string& at) {
    return "<Placemark><Point><altitudeMode>absolute</altitudeMode><coordinates>" + at +
           "</coordinates></Point></Placemark>";
  };
  EXPECT_EQ(parsed_plan(kml(point("11,48,500") + point("11.1,48,500"))).items.size(), 2u);
}

TEST(ReadFlightPlan, TakesKmlAsManyWriteIt) {
  const std::string multi =
      "<Placemark><gx:MultiTrack><altitudeMode>relativeToGround</altitudeMode><gx:Track><gx:coord>11 48 50</gx:coord>"
      "</gx:Track><gx:Track><altitudeMode>absolute</altitudeMode><gx:coord>11 48.1 550</gx:coord></gx:Track>"
      "</gx:MultiTrack></Placemark>";
  const FlightPlan tracks = parsed_plan(kml(multi));
  ASSERT_EQ(tracks.items.size(), 2u);
  EXPECT_EQ(tracks.items[0].position.datum, HeightDatum::ground);
  EXPECT_EQ(tracks.items[1].position.datum, HeightDatum::sea_level);
  const FlightPlan commas = parsed_plan(kml(kml_line(",11,48,500 ,11.001,48,510\n, 11.002,48,520")));
  ASSERT_EQ(commas.items.size(), 3u);
  EXPECT_EQ(commas.items[1].position.horizontal, Eigen::Vector2d(11.001, 48));
  EXPECT_EQ(commas.items[1].position.height_m, 510);
  const std::string offset = "<gx:altitudeOffset>-7</gx:altitudeOffset><altitudeMode>";
  std::string shifted = kml(kml_line("11,48,500"));
  EXPECT_EQ(parsed_plan(shifted.replace(shifted.find("<altitudeMode>"), 14, offset)).items.at(0).position.height_m,
            493);
  const FlightPlan beside =
      parsed_plan(kml(kml_line("11,48,500 11.001,48,500") +
                      "<Placemark><Point><coordinates>11.2,48</coordinates></Point></Placemark>"));
  EXPECT_EQ(beside.items.size(), 2u);
  ASSERT_EQ(beside.notes.size(), 1u);
  expect_wording(beside.notes[0].text);
  // In UTF-16, of both orders, with a mark and without; also where the declaration says UTF-16.
  std::string text = kml(kml_line("11,48,500", "absolute", "H\xC3\xB6he \xF0\x9F\x9A\x81") + kml_line("11,48.1,500"));
  text.replace(text.find("UTF-8"), 5, "UTF-16");
  for (const bool is_big : {false, true}) {
    for (const bool has_mark : {false, true}) {
      const FlightPlan read = parsed_plan(in_utf16(text, is_big, has_mark));
      ASSERT_EQ(read.items.size(), 2u);
      EXPECT_NE(read.notes.at(0).text.find("H\xC3\xB6he \xF0\x9F\x9A\x81"), std::string::npos) << read.notes[0].text;
    }
  }
  EXPECT_EQ(parsed_plan(in_utf16("lat;lon;msl\n48;11;500\n", false, true)).items.at(0).position.height_m, 500);
}

TEST(ReadFlightPlan, TellsWhatOfKmlIsNotFlown) {
  const std::string line = kml_line("11,48,520 11.001,48,530"), at = "<coordinates>11,48,500 11,48.1,500</coordinates>";
  const FlightPlan more = parsed_plan(kml(line + "<Placemark><Polygon/></Placemark><Placemark><Polygon/></Placemark>" +
                                          "<NetworkLink><Link><href>b.kml</href></Link></NetworkLink><gx:Tour/>"));
  EXPECT_EQ(more.items.size(), 2u);
  ASSERT_EQ(more.notes.size(), 1u);
  EXPECT_EQ(more.notes[0].code, WarningCode::plan_left_out);
  expect_wording(more.notes[0].text);
  // Rings, and lines outside of a placemark, are flown.
  EXPECT_EQ(parsed_plan(kml(line + "<Placemark><LinearRing>" + at + "</LinearRing></Placemark>")).items.size(), 4u);
  EXPECT_EQ(parsed_plan(kml(line + "<LineString>" + at + "</LineString>")).items.size(), 4u);
  expect_error([&] { parsed_plan(kml(line + "<Placemark><linestring>" + at + "</linestring></Placemark>")); },
               ErrorCode::plan_syntax, "line 3");
  expect_error([&] { parsed_plan(kml("<Placemark><LineString>" + at + at + "</LineString></Placemark>")); },
               ErrorCode::conflicting_keys, "line 3");
  EXPECT_TRUE(
      parsed_plan(kml(line + "<Placemark><ExtendedData><point>2</point></ExtendedData></Placemark>")).notes.empty());
}

TEST(ReadFlightPlan, RefusesPositionsOfKmlThatAreNotFlown) {
  const std::string line = kml_line("11,48,520 11.001,48,530") + "\n", at = "11,48,500 11,48.1,500";
  const auto refuse = [&](const std::string& content, ErrorCode code = ErrorCode::plan_syntax) {
    expect_error([&] { parsed_plan(kml(line + "<Placemark>" + content + "</Placemark>")); }, code, "line 4");
  };
  const std::string list = "<coordinates>" + at + "</coordinates>";
  refuse("<LineString><Coordinates>" + at + "</Coordinates></LineString>");
  refuse("<LineString>" + list + "<Coordinates>" + at + "</Coordinates></LineString>");
  refuse("<LineString><coordinates><a>" + at + "</a></coordinates></LineString>");
  refuse("<LineString>" + at + "</LineString>");
  refuse("<LineString><coord>11 48 500</coord></LineString>");
  refuse("<LineString>" + list + "<LineString>" + list + "</LineString></LineString>");
  refuse("<gx:Track><gx:Coord>11 48 500</gx:Coord></gx:Track>");
  refuse("<gx:Track>" + list + "</gx:Track>");
  refuse("<Point>" + list + "</Point>");
  refuse("<LinesString>" + list + "</LinesString>", ErrorCode::value_unsupported);
  refuse("<ExtendedData><LineString>" + list + "</LineString></ExtendedData>", ErrorCode::value_unsupported);
  refuse("<gx:Track><ExtendedData>" + list + "</ExtendedData></gx:Track>", ErrorCode::value_unsupported);
  refuse("<coords>" + at + "</coords>", ErrorCode::value_unsupported);
  refuse("<LineString><gx:altitudeOffset>1</gx:altitudeOffset><gx:altitudeOffset>2</gx:altitudeOffset>" + list +
             "</LineString>",
         ErrorCode::conflicting_keys);
  // What programs write beside it.
  const std::string more =
      "<Style id=\"s\"><LineStyle><color>ff0000ff</color></LineStyle></Style><Placemark><name>b</name><LookAt>"
      "<longitude>11</longitude><latitude>48</latitude><altitude>0</altitude></LookAt><Region><LatLonAltBox>"
      "<north>49</north></LatLonAltBox></Region><ExtendedData><Data name=\"coordinates\"><value>11,48</value></Data>"
      "</ExtendedData><LineString id=\"l\"><extrude>1</extrude><tessellate>1</tessellate><gx:altitudeMode>absolute"
      "</gx:altitudeMode><gx:drawOrder>1</gx:drawOrder>" +
      list +
      "</LineString></Placemark><Placemark><gx:Track id=\"t\"><altitudeMode>absolute</altitudeMode><when>2020</when>"
      "<gx:coord>11 48 500</gx:coord><gx:angles>1 2 3</gx:angles><Model><Location><longitude>11</longitude></Location>"
      "</Model><ExtendedData><SchemaData><gx:SimpleArrayData name=\"a\"><gx:value>1</gx:value></gx:SimpleArrayData>"
      "</SchemaData></ExtendedData></gx:Track></Placemark>";
  EXPECT_EQ(parsed_plan(kml(line + more)).items.size(), 5u);
}

TEST(ReadFlightPlan, TakesAllTracksOfAName) {
  const std::string text = kml(kml_line("11,48,1 11,48.001,2", "absolute", "out") +
                               kml_line("11,49,3", "absolute", "b") + kml_line("11,48.002,4", "absolute", "out"));
  const FlightPlan out = parsed_plan(text, "out");
  ASSERT_EQ(out.items.size(), 3u);
  EXPECT_EQ(out.items[2].position.height_m, 4);
  EXPECT_TRUE(has_note(out.notes, WarningCode::plan_joined));
  EXPECT_EQ(parsed_plan(text, "3").items.size(), 1u);
}

TEST(ReadFlightPlan, JoinsTracksOrTakesOne) {
  const std::string text =
      kml(kml_line("11,48,1 11,48.001,2", "absolute", "out") + kml_line("11,48.001,3", "absolute", "back"));
  const FlightPlan both = parsed_plan(text);
  EXPECT_EQ(both.items.size(), 3u);
  ASSERT_EQ(both.notes.size(), 1u);
  EXPECT_EQ(both.notes[0].code, WarningCode::plan_joined);
  expect_wording(both.notes[0].text);
  EXPECT_EQ(parsed_plan(text, "back").items.size(), 1u);
  EXPECT_EQ(parsed_plan(text, "1").items.size(), 2u);
  EXPECT_TRUE(parsed_plan(text, "back").notes.empty());
  expect_error([&] { parsed_plan(text, "third"); }, ErrorCode::unknown_choice);
  expect_code([&] { parsed_plan(text, "3"); }, ErrorCode::unknown_choice);
  expect_code([&] { parsed_plan(text, "0"); }, ErrorCode::unknown_choice);
}

TEST(ReadFlightPlan, TakesWaylinesOfDji) {
  const std::string turn =
      "<wpml:waypointTurnParam><wpml:waypointTurnMode>coordinateTurn</wpml:waypointTurnMode>"
      "<wpml:waypointTurnDampingDist>5</wpml:waypointTurnDampingDist></wpml:waypointTurnParam>";
  const std::string actions =
      "<wpml:waypointSpeed>6</"
      "wpml:waypointSpeed><wpml:actionGroup><wpml:actionTrigger><wpml:actionTriggerType>reachPoint"
      "</wpml:actionTriggerType></wpml:actionTrigger><wpml:action><wpml:actionActuatorFunc>hover</"
      "wpml:actionActuatorFunc>"
      "<wpml:actionActuatorFuncParam><wpml:hoverTime>3</wpml:hoverTime></wpml:actionActuatorFuncParam></wpml:action>"
      "<wpml:action><wpml:actionActuatorFunc>gimbalRotate</wpml:actionActuatorFunc><wpml:actionActuatorFuncParam>"
      "<wpml:gimbalPitchRotateEnable>1</wpml:gimbalPitchRotateEnable><wpml:gimbalPitchRotateAngle>-60"
      "</wpml:gimbalPitchRotateAngle></wpml:actionActuatorFuncParam></wpml:action></wpml:actionGroup>";
  const std::string config =
      "<wpml:finishAction>goHome</wpml:finishAction><wpml:takeOffSecurityHeight>25</wpml:takeOffSecurityHeight>"
      "<wpml:takeOffRefPoint>48,11,560</wpml:takeOffRefPoint><wpml:globalTransitionalSpeed>9</"
      "wpml:globalTransitionalSpeed>";
  const FlightPlan read =
      parsed_plan(waylines(wayline(wayline_point(11.001, 48, 40, actions) + wayline_point(11.002, 48, 50, turn) +
                                   wayline_point(11.003, 48, 60)),
                           config));
  EXPECT_EQ(read.format, PlanFormat::wpml);
  ASSERT_EQ(read.items.size(), 5u);
  EXPECT_EQ(read.items[0].kind, PlanItemKind::takeoff);
  EXPECT_EQ(read.items[0].position.height_m, 25);
  EXPECT_EQ(read.items[1].position.datum, HeightDatum::home);
  EXPECT_EQ(read.items[1].speed_m_s, 9);
  EXPECT_EQ(read.items[1].hold_s, 3);
  EXPECT_EQ(read.items[1].gimbal_pitch_deg, -60);
  EXPECT_EQ(read.items[2].speed_m_s, 6);
  EXPECT_EQ(read.items[2].cut_m, 5);
  EXPECT_EQ(read.items[2].gimbal_pitch_deg, -60);
  EXPECT_EQ(read.items[3].speed_m_s, 8);
  EXPECT_EQ(read.items[4].kind, PlanItemKind::return_home);
  EXPECT_EQ(read.home->datum, HeightDatum::ellipsoid);
  const auto datum = [](const std::string& mode) {
    return parsed_plan(waylines(wayline(wayline_point(11, 48, 40), mode))).items[0].position.datum;
  };
  EXPECT_EQ(datum("WGS84"), HeightDatum::ellipsoid);
  EXPECT_EQ(datum("realTimeFollowSurface"), HeightDatum::ground);
  EXPECT_EQ(datum("another"), HeightDatum::unknown);
  EXPECT_TRUE(has_note(
      parsed_plan(waylines(wayline(wayline_point(11, 48, 40)) + wayline(wayline_point(11, 48, 40), "WGS84", 1))).notes,
      WarningCode::plan_joined));
}

TEST(ReadFlightPlan, RefusesArchivesOfSeveralPlans) {
  const std::string line = kml(kml_line("11,48,1 11,48.001,2")), dji = waylines(wayline(wayline_point(11, 48, 40)));
  const auto read = [&](const std::vector<internal::io::ZippedFile>& files) {
    return parsed_plan(internal::io::zipped(files));
  };
  EXPECT_EQ(read({{"any.kml", line}, {"__MACOSX/any.kml", "notes"}}).format, PlanFormat::kml);
  EXPECT_EQ(read({{"wpmz/template.kml", line}, {"wpmz/waylines.wpml", dji}}).format, PlanFormat::wpml);
  EXPECT_EQ(read({{"flight.wpml", dji}}).format, PlanFormat::wpml);
  expect_error([&] { read({{"doc.kml", line}, {"b.kml", line}}); }, ErrorCode::value_unsupported, "flight.plan");
  const auto refuse = [&](const std::vector<internal::io::ZippedFile>& files) {
    expect_code([&] { read(files); }, ErrorCode::value_unsupported, "flight.plan");
  };
  refuse({{"doc.kml", line}, {"doc.kml", line}});
  refuse({{"wpmz/waylines.wpml", dji}, {"wpmz/waylines2.wpml", dji}, {"wpmz/template.kml", line}});
  refuse({{"wpmz/waylines.wpml", dji}, {"doc.kml", line}});
  refuse({{"doc.kml", line}, {"other.KMZ", internal::io::zipped({{"doc.kml", line}})}});
  refuse({{"doc.kml", line}, {"b.gpx", "<gpx/>"}});
  refuse({{"wpmz/waylines.wpml", dji}, {"wpmz/template.kml", line}, {"template.kml", line}});
}

TEST(ReadFlightPlan, RefusesWaypointsInAnotherOrder) {
  const auto read = [](const std::string& first, const std::string& second) {
    const auto index = [](const std::string& number) { return "<wpml:index>" + number + "</wpml:index>"; };
    return parsed_plan(
        waylines(wayline(wayline_point(11, 48, 40, index(first)) + wayline_point(11.001, 48, 40, index(second)))));
  };
  EXPECT_EQ(read("0", "1").items.size(), 2u);
  expect_error([&] { read("1", "0"); }, ErrorCode::value_unsupported, "line");
}

TEST(ReadFlightPlan, NamesCurvesOfTheAircraftsOwn) {
  const auto point = [](double longitude, const std::string& mode, const std::string& straight) {
    return wayline_point(longitude, 48, 40,
                         "<wpml:waypointTurnParam><wpml:waypointTurnMode>" + mode +
                             "</wpml:waypointTurnMode></wpml:waypointTurnParam>"
                             "<wpml:useStraightLine>" +
                             straight + "</wpml:useStraightLine>");
  };
  const auto read = [&](const std::string& mode, const std::string& straight) {
    return parsed_plan(waylines(wayline(point(11, mode, straight) + point(11.001, mode, straight))));
  };
  const FlightPlan curved = read("toPointAndPassWithContinuityCurvature", "0");
  ASSERT_EQ(curved.not_judged.size(), 1u);
  expect_wording(curved.not_judged[0]);
  EXPECT_TRUE(read("toPointAndPassWithContinuityCurvature", "1").not_judged.empty())
      << "at the ends it is not turned before";
  EXPECT_TRUE(read("toPointAndStopWithDiscontinuityCurvature", "0").not_judged.empty());
}

TEST(ReadFlightPlan, TurnsNoWaylineAtItsEnds) {
  const std::string turn =
      "<wpml:waypointTurnParam><wpml:waypointTurnMode>coordinateTurn</wpml:waypointTurnMode>"
      "<wpml:waypointTurnDampingDist>5</wpml:waypointTurnDampingDist></wpml:waypointTurnParam>";
  const std::string points =
      wayline_point(11, 48, 40, turn) + wayline_point(11.001, 48, 40, turn) + wayline_point(11.001, 48.001, 40, turn);
  const FlightPlan plan =
      parsed_plan(waylines(wayline(points, "relativeToStartPoint", 0) + wayline(points, "relativeToStartPoint", 1),
                           "<wpml:finishAction>goHome</wpml:finishAction>"));
  ASSERT_EQ(plan.items.size(), 7u);
  for (std::size_t i = 0; i < plan.items.size(); ++i) EXPECT_EQ(plan.items[i].cut_m, i == 1 || i == 4 ? 5 : 0) << i;
}

// Nobody knows which of the two counts.
TEST(ReadFlightPlan, RefusesElementsOfDjiThatAreThereTwice) {
  const std::string point = wayline_point(11, 48, 40);
  const auto refuse = [](const std::string& text) {
    expect_code([&] { parsed_plan(text); }, ErrorCode::value_unsupported, "line");
  };
  expect_error(
      [&] {
        parsed_plan(waylines(wayline(point + wayline_point(11.001, 48, 40,
                                                           "<wpml:executeHeight>90"
                                                           "</wpml:executeHeight>"))));
      },
      ErrorCode::value_unsupported, "line 4");
  refuse(waylines(wayline(wayline_point(11, 48, 40, "<Point><coordinates>12,48</coordinates></Point>"))));
  refuse(waylines(wayline(point),
                  "</wpml:missionConfig><wpml:missionConfig><wpml:finishAction>goHome"
                  "</wpml:finishAction>"));
  const auto ways = [&](int first, int last) {
    const std::string mode = "relativeToStartPoint";
    return waylines(wayline(point, mode, first) + wayline(wayline_point(11.001, 48, 40), mode, last));
  };
  EXPECT_EQ(parsed_plan(ways(0, 1)).items.size(), 2U);
  refuse(ways(1, 0));
}

TEST(ReadFlightPlan, RefusesWaypointsThatAreInNoWayline) {
  const std::string first = wayline_point(11, 48, 40), last = wayline_point(11.002, 48, 40);
  const auto read = [&](const std::string& between) {
    return [&, between] { parsed_plan(waylines(wayline(first + between + last))); };
  };
  const auto in_place_of_point = [&](const std::string& begin, const std::string& end) {
    std::string text = first;
    text.replace(text.find("<Point>"), 7, begin);
    return text.replace(text.find("</Point>"), 8, end);
  };
  read(first)();
  expect_error(read("<Folder>" + first + "</Folder>"), ErrorCode::value_unsupported, "line 4");
  expect_code(read(in_place_of_point("<MultiGeometry><Point>", "</Point></MultiGeometry>")),
              ErrorCode::value_unsupported, "line 4");
  expect_code(read(in_place_of_point("<LineString>", "</LineString>")), ErrorCode::value_unsupported, "line 4");
  expect_code([&] { parsed_plan(waylines(first + wayline(first + last))); }, ErrorCode::value_unsupported, "line 3");
}

TEST(ReadFlightPlan, NamesWhatOfDjiIsNotKnown) {
  const auto mode = [](const std::string& name, const std::string& more = "") {
    return "<wpml:waypointTurnParam><wpml:waypointTurnMode>" + name + "</wpml:waypointTurnMode>" + more +
           "</wpml:waypointTurnParam>";
  };
  const auto read = [](const std::string& turn, const std::string& config = "", const std::string& folder = "") {
    return parsed_plan(waylines(wayline(folder + wayline_point(11, 48, 40, turn) + wayline_point(11.001, 48, 40, turn) +
                                        wayline_point(11.001, 48.001, 40, turn)),
                                config))
        .not_judged;
  };
  std::vector<std::string> told;
  const auto expect_told = [&](const std::vector<std::string>& texts, std::size_t count) {
    ASSERT_EQ(texts.size(), count);
    told.push_back(texts[0]);
  };
  expect_told(read(mode("somethingNew")), 3);
  expect_told(read(mode("coordinateTurn")), 1);  // at its ends a wayline is not turned
  expect_told(read("", "", "<wpml:globalWaypointTurnMode>coordinateTurn</wpml:globalWaypointTurnMode>"), 1);
  EXPECT_TRUE(read(mode("coordinateTurn", "<wpml:waypointTurnDampingDist>9</wpml:waypointTurnDampingDist>")).empty());
  expect_told(read("", "<wpml:finishAction>goFishing</wpml:finishAction>"), 1);
  EXPECT_TRUE(read("", "<wpml:finishAction>noAction</wpml:finishAction>").empty());
  expect_told(read("", "<wpml:finishAction></wpml:finishAction>"), 1);
  expect_told(read("",
                   "<wpml:autoRerouteInfo><wpml:missionAutoRerouteMode>1</wpml:missionAutoRerouteMode>"
                   "</wpml:autoRerouteInfo>"),
              1);
  expect_told(read("", "", "<wpml:caliFlightEnable>1</wpml:caliFlightEnable>"), 1);
  expect_told(read("", "<wpml:takeOffSecurityHeight>0</wpml:takeOffSecurityHeight>"), 1);
  const std::string straight = "<wpml:useStraightLine>1</wpml:useStraightLine>",
                    early = "toPointAndPassWithContinuityCurvature";
  expect_told(read(mode(early) + straight), 1);
  expect_told(read(mode(early, "<wpml:waypointTurnDampingDist>9</wpml:waypointTurnDampingDist>") + straight), 1);
  const std::string home =
      "<wpml:takeOffSecurityHeight>25</wpml:takeOffSecurityHeight><wpml:takeOffRefPoint>48,11,560"
      "</wpml:takeOffRefPoint><wpml:flyToWaylineMode>";
  expect_told(read("", home + "inCircles</wpml:flyToWaylineMode>"), 1);
  EXPECT_TRUE(read("", home + "pointToPoint</wpml:flyToWaylineMode>").empty());
  for (const char* drone : {"60", "89"}) {  // Matrice 300, 350
    const std::string info =
        std::string("<wpml:droneInfo><wpml:droneEnumValue>") + drone + "</wpml:droneEnumValue></wpml:droneInfo>";
    EXPECT_EQ(read("", home + "pointToPoint</wpml:flyToWaylineMode>" + info).size(), 1u);
    EXPECT_TRUE(read("", home + "safely</wpml:flyToWaylineMode>" + info).empty());
  }
  expect_told(read("", "", "<wpml:waylineType>poi</wpml:waylineType>"), 1);
  const auto action = [](const std::string& name) {
    return "<wpml:startActionGroup><wpml:action><wpml:actionActuatorFunc>" + name +
           "</wpml:actionActuatorFunc></wpml:action></wpml:startActionGroup>";
  };
  expect_told(read("", "", action("flyAround")), 1);
  EXPECT_TRUE(read("", "", action("takePhoto")).empty());
  expect_wording(told);
}

TEST(ReadFlightPlan, TakesTemplatesOfDji) {
  const auto with = [](const std::string& type, const std::string& mode) {
    return waylines(
        "<Folder><wpml:templateType>" + type + "</wpml:templateType><wpml:waylineCoordinateSysParam><wpml:heightMode>" +
        mode +
        "</wpml:heightMode></wpml:waylineCoordinateSysParam><wpml:globalHeight>70</wpml:globalHeight>"
        "<Placemark><Point><coordinates>11,48</coordinates></Point><wpml:ellipsoidHeight>590"
        "</wpml:ellipsoidHeight><wpml:height>545</wpml:height></Placemark><Placemark><Point><coordinates>11,48.001"
        "</coordinates></Point><wpml:useGlobalHeight>1</wpml:useGlobalHeight></Placemark></Folder>");
  };
  const FlightPlan read = parsed_plan(with("waypoint", "EGM96"));
  EXPECT_EQ(read.items[0].position.height_m, 545);
  EXPECT_EQ(read.items[0].position.datum, HeightDatum::sea_level);
  EXPECT_EQ(read.items[1].position.height_m, 70);
  ASSERT_EQ(read.not_judged.size(), 1U) << "that is above the place of takeoff";
  expect_wording(read.not_judged[0]);
  EXPECT_EQ(parsed_plan(with("waypoint", "WGS84")).items[0].position.height_m, 590);
  expect_error([&] { parsed_plan(with("mapping2d", "EGM96")); }, ErrorCode::value_unsupported, "line 3");
}

TEST(ReadFlightPlan, TakesTracksRoutesAndPointsOfGpx) {
  const auto point = [](const std::string& name, const std::string& latitude, const std::string& height) {
    return "<" + name + " lat=\"" + latitude + "\" lon=\"11\"><ele>" + height + "</ele></" + name + ">\n";
  };
  const std::string track = "<trk><trkseg>" + point("trkpt", "48", "500") + point("trkpt", "48.1", "501") +
                            "</trkseg><trkseg>" + point("trkpt", "48.2", "502") + "</trkseg></trk>";
  const std::string route = "<rte>" + point("rtept", "47", "400") + "</rte>";
  const std::string waypoints = point("wpt", "46", "300") + point("wpt", "46.1", "300");
  const FlightPlan all = parsed_plan(gpx(waypoints + route + track));
  ASSERT_EQ(all.items.size(), 3u);
  EXPECT_EQ(all.items[2].position.height_m, 502);
  EXPECT_EQ(all.items[0].position.datum, HeightDatum::sea_level);
  EXPECT_TRUE(has_note(all.notes, WarningCode::plan_left_out));
  ASSERT_TRUE(has_note(all.notes, WarningCode::plan_joined)) << "two segments";
  expect_wording(all.notes[0].text);
  EXPECT_EQ(parsed_plan(gpx(waypoints + route)).items.size(), 1u);
  EXPECT_EQ(parsed_plan(gpx(waypoints)).items.size(), 2u);
  EXPECT_TRUE(std::isnan(parsed_plan(gpx("<wpt lat=\"48\" lon=\"11\"/>")).items[0].position.height_m));
  expect_error([&] { parsed_plan(gpx("<wpt lat=\"48\"/>")); }, ErrorCode::plan_syntax, "line 3");
  expect_error([&] { parsed_plan(gpx("<wpt lat=\"NaN\" lon=\"11\"/>")); }, ErrorCode::not_a_number, "line 3");
}

TEST(ReadFlightPlan, RefusesPositionsOfGpxThatAreNotFlown) {
  const auto point = [](const std::string& name, const std::string& content = "<ele>500</ele>") {
    return "<" + name + " lat=\"48\" lon=\"11\">" + content + "</" + name + ">";
  };
  const std::string points = point("trkpt") + point("trkpt"), track = "<trk><trkseg>" + points + "</trkseg></trk>\n";
  const auto refuse = [&](const std::string& content, ErrorCode code, const std::string& place = "line 4") {
    expect_error([&] { parsed_plan(gpx(content)); }, code, place);
  };
  refuse(track + "<Trk><trkseg>" + points + "</trkseg></Trk>", ErrorCode::plan_syntax);
  refuse(track + "<trk><trkSeg>" + points + "</trkSeg></trk>", ErrorCode::plan_syntax);
  refuse(track + "<trk><trkseg>" + point("trkPt") + "</trkseg></trk>", ErrorCode::plan_syntax);
  refuse(track + "<metadata>" + track + "</metadata>", ErrorCode::value_unsupported);
  refuse(track + "<extensions>" + track + "</extensions>", ErrorCode::value_unsupported);
  refuse(track + "<rte>" + points + "</rte>", ErrorCode::value_unsupported);
  refuse(track + "<way><point><Latitude>48</Latitude></point></way>", ErrorCode::value_unsupported);
  refuse("<trk><trkseg>" + point("trkpt", points) + "</trkseg></trk>", ErrorCode::value_unsupported, "line 3");
  refuse(point("wpt", "<Ele>500</Ele>"), ErrorCode::plan_syntax, "line 3");
  refuse(point("wpt", "<ele>50</ele><ele>500</ele>"), ErrorCode::conflicting_keys, "line 3");
  // Garmin's devices fly along these.
  refuse("<rte>" +
             point("rtept", "<extensions><gpxx:RoutePointExtension>" + point("gpxx:rpt") +
                                "</gpxx:RoutePointExtension></extensions>") +
             "</rte>",
         ErrorCode::value_unsupported, "line 3");
  // What programs write beside it.
  const std::string more =
      "<extensions><gpxtpx:TrackPointExtension><gpxtpx:hr>60</gpxtpx:hr><gpxtpx:Extensions/>"
      "</gpxtpx:TrackPointExtension><hold_s>2</hold_s><ogr:lat>48</ogr:lat></extensions><extensions><speed_m_s>3</"
      "speed_m_s></extensions>";
  const FlightPlan plan = parsed_plan(
      gpx("<metadata><bounds minlat=\"48\" minlon=\"11\" maxlat=\"49\" maxlon=\"12\"/></metadata><trk><name>a</name>"
          "<number>1</number><extensions><gpxx:TrackExtension><gpxx:DisplayColor>Red</gpxx:DisplayColor>"
          "</gpxx:TrackExtension></extensions><trkseg>" +
          point("trkpt", "<ele>500</ele><time>2026-01-01T00:00:00Z</time>" + more) + "</trkseg></trk>"));
  ASSERT_EQ(plan.items.size(), 1u);
  EXPECT_EQ(plan.items[0].hold_s, 2);
  EXPECT_EQ(plan.items[0].speed_m_s, 3);
  EXPECT_TRUE(plan.notes.empty());
}

TEST(ReadFlightPlan, TakesLinesAndPointsOfGeoJson) {
  const FlightPlan line = parsed_plan(
      "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"properties\": {\"name\": \"a\"}, "
      "\"geometry\": {\"type\": \"LineString\", \"coordinates\": [[11, 48, 560], [11.001, 48, 570]]}}, {\"type\": "
      "\"Feature\", \"properties\": null, \"geometry\": null}]}");
  EXPECT_EQ(line.format, PlanFormat::geojson);
  ASSERT_EQ(line.items.size(), 2u);
  EXPECT_EQ(line.items[1].position.height_m, 570);
  EXPECT_EQ(line.items[1].position.datum, HeightDatum::ellipsoid);
  EXPECT_EQ(parsed_plan("{\"type\": \"Point\", \"coordinates\": [11, 48]}").items.size(), 1u);
  expect_error([] { parsed_plan("{\"type\": \"LineString\", \"coordinates\": [[11]]}"); }, ErrorCode::plan_syntax,
               "position 1");
  const std::string collection =
      "{\"type\": \"GeometryCollection\", \"geometries\": [{\"type\": \"LineString\", \"coordinates\": [[11, 48, 560], "
      "[11.001, 48, 570]]}, {\"type\": \"LineString\", \"coordinates\": [[11.002, 48, 580]]}]}";
  EXPECT_EQ(parsed_plan(collection).items.size(), 3u);
  EXPECT_EQ(parsed_plan("{\"type\": \"Feature\", \"properties\": {}, \"geometry\": " + collection + "}").items.size(),
            3u);
  EXPECT_EQ(parsed_plan("{\"type\": \"MultiPoint\", \"coordinates\": [[11, 48, 1], [11.1, 48, 2]]}").items.size(), 2u);
}

TEST(ReadFlightPlan, TellsWhatOfGeoJsonIsNotFlown) {
  const std::string line = "{\"type\": \"LineString\", \"coordinates\": [[11, 48, 560], [11.001, 48, 570]]}";
  const auto feature = [](const std::string& geometry) {
    return "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": " + geometry + "}";
  };
  const auto all = [&](const std::string& more, const std::string& members = "") {
    return parsed_plan("{\"type\": \"FeatureCollection\", " + members + "\"features\": [" + feature(line) + more +
                       "]}");
  };
  const FlightPlan polygon = all(", " + feature("{\"type\": \"Polygon\", \"coordinates\": []}"));
  ASSERT_EQ(polygon.notes.size(), 1u);
  EXPECT_EQ(polygon.notes[0].code, WarningCode::plan_left_out);
  const auto crs = [&](const std::string& name) {
    return all("", "\"crs\": {\"type\": \"name\", \"properties\": {\"name\": \"" + name + "\"}}, ").notes;
  };
  ASSERT_EQ(crs("urn:ogc:def:crs:EPSG::4258").size(), 1u);
  expect_wording({polygon.notes[0].text, crs("urn:ogc:def:crs:EPSG::4258")[0].text});
  EXPECT_TRUE(crs("urn:ogc:def:crs:OGC:1.3:CRS84").empty());
  EXPECT_EQ(all(", {\"type\": \"FeatureCollection\", \"features\": [" + feature(line) + "]}").items.size(), 4u);
  expect_error([&] { all(", " + feature("{\"type\": \"linestring\", \"coordinates\": []}")); },
               ErrorCode::value_unsupported, "features[1]");
}

TEST(ReadFlightPlan, RefusesMembersOfGeoJsonThatAreNotFlown) {
  const std::string line = "{\"type\": \"LineString\", \"coordinates\": [[11, 48, 560], [11.001, 48, 570]]}";
  const std::string feature = "{\"type\": \"Feature\", \"properties\": {}, \"geometry\": " + line + "}";
  const auto with = [&](const std::string& more, const std::string& members = "") {
    return parsed_plan("{\"type\": \"FeatureCollection\", \"features\": [" + feature + ", " + more + "]" + members +
                       "}");
  };
  const auto refuse = [&](const std::string& more, ErrorCode code) {
    expect_error([&] { with(more); }, code, "features[1]");
  };
  const auto shaped = [](const std::string& shape) { return "{\"type\": \"Feature\", \"geometry\": " + shape + "}"; };
  refuse("{\"type\": \"Feature\", \"Geometry\": " + line + "}", ErrorCode::value_unsupported);
  refuse("{\"type\": \"Feature\", \"geometry\": null, \"path\": [[11, 48], [12, 48]]}", ErrorCode::value_unsupported);
  refuse("{\"type\": \"Feature\", \"geometry\": null, \"path\": [{\"lat\": 48, \"lon\": 11}]}",
         ErrorCode::value_unsupported);
  refuse("{\"type\": \"Feature\", \"geometry\": null, \"properties\": {\"way\": " + line + "}}",
         ErrorCode::value_unsupported);
  refuse("{\"type\": \"Feature\", \"properties\": {}}", ErrorCode::plan_syntax);
  refuse("{\"type\": \"Feature\", \"properties\": [1], \"geometry\": null}", ErrorCode::plan_syntax);
  refuse(shaped("{\"type\": \"LineString\", \"Coordinates\": [[11, 48], [12, 48]]}"), ErrorCode::value_unsupported);
  refuse(shaped("[" + line + "]"), ErrorCode::plan_syntax);
  refuse(shaped(feature), ErrorCode::value_unsupported);
  refuse(shaped("{\"type\": \"GeometryCollection\", \"Geometries\": [" + line + "]}"), ErrorCode::value_unsupported);
  refuse(shaped("{\"type\": \"GeometryCollection\", \"geometries\": [[" + line + "]]}"), ErrorCode::plan_syntax);
  refuse(shaped("{\"coordinates\": [[11, 48], [12, 48]]}"), ErrorCode::plan_syntax);
  refuse(shaped("{\"type\": \"LineString\", \"coordinates\": \"[[11, 48], [12, 48]]\"}"), ErrorCode::plan_syntax);
  expect_error([&] { with(feature, ", \"Features\": [" + feature + "]"); }, ErrorCode::value_unsupported, "the object");
  expect_error([&] { with(feature, ", \"mission\": {}"); }, ErrorCode::plan_syntax);
  // What programs write beside it.
  const std::string data = "{\"color\": [255, 0, 0], \"name\": \"b\", \"gpx\": {\"times\": [[1, 2]]}}";
  const std::string boxed = "{\"type\": \"Feature\", \"id\": 7, \"bbox\": [11, 48, 12, 49], \"properties\": " + data +
                            ", \"geometry\": {\"type\": \"LineString\", \"bbox\": [11, 48, 12, 49], \"coordinates\": "
                            "[[11.001, 48, 570, 1e9], [11.002, 48, 580, 1e9]]}}";
  const FlightPlan plan = with(boxed + ", {\"type\": \"Feature\", \"properties\": [], \"geometry\": null}",
                               ", \"bbox\": [11, 48, 12, 49], \"name\": \"a\", \"properties\": {\"author\": \"c\"}");
  EXPECT_EQ(plan.items.size(), 4u);
  ASSERT_EQ(plan.notes.size(), 1u);
  EXPECT_EQ(plan.notes[0].code, WarningCode::plan_joined);
  const std::string crs =
      "{\"type\": \"Feature\", \"crs\": {\"properties\": {\"name\": \"EPSG:31468\"}}, \"geometry\": " + line + "}";
  EXPECT_TRUE(has_note(with(crs).notes, WarningCode::plan_assumed));
}

TEST(ReadFlightPlan, TakesStaysOfPointsBesideTheirLine) {
  const auto point = [](const std::string& at, const std::string& data) {
    return "<Placemark><ExtendedData>" + data +
           "</ExtendedData><Point><altitudeMode>absolute</altitudeMode><coordinates>" + at +
           "</coordinates></Point></Placemark>";
  };
  const std::string line = kml_line("11,48,520 11.001,48,530");
  const std::string stays = "<Data name=\"point\"><value>2</value></Data><Data name=\"hold_s\"><value>3</value></Data>";
  const FlightPlan plan = parsed_plan(kml(point("11.001,48,530", stays) + line));
  ASSERT_EQ(plan.items.size(), 2u);
  EXPECT_EQ(plan.items[0].hold_s, 0);
  EXPECT_EQ(plan.items[1].hold_s, 3);
  EXPECT_TRUE(plan.notes.empty());
  // GDAL writes KML so.
  const std::string simple =
      "<SchemaData schemaUrl=\"#a\"><SimpleData name=\"point\">1</SimpleData><SimpleData name=\"hold_s\">4.5"
      "</SimpleData><SimpleData name=\"yaw_deg\">-90</SimpleData></SchemaData>";
  const FlightPlan of_gdal = parsed_plan(kml(line + point("11,48,520", simple)));
  EXPECT_EQ(of_gdal.items[0].hold_s, 4.5);
  EXPECT_EQ(of_gdal.items[0].yaw_deg, -90);
  for (const std::string elsewhere : {"11.002,48,530", "11.001,48,531", "11,48,520"}) {
    const FlightPlan moved = parsed_plan(kml(line + point(elsewhere, stays)));
    EXPECT_EQ(moved.items[1].hold_s, 0) << elsewhere;
    ASSERT_EQ(moved.notes.size(), 1u) << elsewhere;
    EXPECT_EQ(moved.notes[0].code, WarningCode::plan_left_out);
    expect_wording(moved.notes[0].text);
  }
  EXPECT_EQ(parsed_plan(kml(point("11,48,520", stays))).items[0].hold_s, 3) << "points alone are the flight";
  const std::string wrong = "<Data name=\"hold_s\"><value>long</value></Data>";
  expect_error([&] { parsed_plan(kml(line + point("11,48,520", wrong))); }, ErrorCode::not_a_number, "flight.plan");
  const std::string negative = "<Data name=\"hold_s\"><value>-1</value></Data>";
  expect_code([&] { parsed_plan(kml(point("11,48,520", negative))); }, ErrorCode::value_out_of_range);

  const auto geojson = [](const std::string& properties) {
    return "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"properties\": {}, "
           "\"geometry\": {\"type\": \"LineString\", \"coordinates\": [[11, 48, 560], [11.001, 48, 570]]}}, "
           "{\"type\": \"Feature\", \"properties\": " +
           properties + ", \"geometry\": {\"type\": \"Point\", \"coordinates\": [11.001, 48, 570]}}]}";
  };
  EXPECT_EQ(parsed_plan(geojson("{\"point\": 2, \"hold_s\": 3, \"speed_m_s\": null}")).items[1].hold_s, 3);
  EXPECT_EQ(parsed_plan(geojson("{\"point\": \"2\", \"hold_s\": \"3\", \"name\": \"a\"}")).items[1].hold_s, 3);
  EXPECT_EQ(parsed_plan(geojson("{\"point\": \"a\", \"hold_s\": 3}")).items[1].hold_s, 0);
  EXPECT_EQ(parsed_plan(geojson("{\"hold_s\": 3}")).notes.size(), 1u);
  EXPECT_TRUE(parsed_plan(geojson("{\"name\": \"a\", \"point\": 7}")).notes.empty());

  const FlightPlan route = parsed_plan(
      gpx("<rte><rtept lat=\"48\" lon=\"11\"><extensions><v:hold_s xmlns:v=\"urn:v\">2.5</v:hold_s></extensions>"
          "</rtept></rte>"));
  EXPECT_EQ(route.items[0].hold_s, 2.5);
}

TEST(ReadFlightPlan, TakesTablesWhoseColumnsSayWhatTheyAre) {
  const auto first = [](const std::string& text) { return parsed_plan(text).items.at(0).position; };
  EXPECT_EQ(first("lat,lon,alt_amsl\n48,11,500\n").datum, HeightDatum::sea_level);
  EXPECT_EQ(first("Longitude;Latitude;Height AGL (m)\n11;48;30\n").datum, HeightDatum::ground);
  EXPECT_EQ(first("lat\tlng\tHAE\n48\t11\t560\n").datum, HeightDatum::ellipsoid);
  EXPECT_EQ(first("lat,lon,height_home_m\n48,11,560\n").datum, HeightDatum::home);
  EXPECT_EQ(first("lat,lon,altitude\n48,11,560\n").datum, HeightDatum::unknown);
  EXPECT_EQ(first("lat,lon,altitude,msl\n48,11,1,560\n").height_m, 560);
  EXPECT_NEAR(first("lat,lon,msl_ft\n48,11,1000\n").height_m, 304.8, 1e-9);
  EXPECT_EQ(first("lat,lon\n48,11\n").horizontal, Eigen::Vector2d(11, 48));
  const FlightPlan scene =
      parsed_plan("# a comment\n\nname,x_m,y_m,z_m,hold_s,speed_m_s,gimbal_pitch_deg\n\"a, b\",1,2,3,4,5,-90\n");
  EXPECT_TRUE(scene.is_in_scene_frame);
  EXPECT_EQ(scene.items[0].position.horizontal, Eigen::Vector2d(1, 2));
  EXPECT_EQ(scene.items[0].position.datum, HeightDatum::scene_z);
  EXPECT_EQ(scene.items[0].hold_s, 4);
  EXPECT_EQ(scene.items[0].speed_m_s, 5);
  EXPECT_EQ(scene.items[0].gimbal_pitch_deg, -90);
  const FlightPlan litchi = parsed_plan(
      "latitude,longitude,altitude(m),heading(deg),curvesize(m),altitudemode,speed(m/"
      "s)\n48,11,30,90,2,0,0\n48,11,40,0,0,1,3\n");
  EXPECT_EQ(litchi.items[0].position.datum, HeightDatum::home);
  EXPECT_EQ(litchi.items[0].cut_m, 2);
  EXPECT_EQ(litchi.items[0].yaw_deg, 90);
  EXPECT_TRUE(std::isnan(litchi.items[0].speed_m_s));
  EXPECT_EQ(litchi.items[1].position.datum, HeightDatum::ground);
  expect_error([] { parsed_plan("a,b,c\n1,2,3\n"); }, ErrorCode::plan_syntax, "line 1");
  expect_error([] { parsed_plan("lat,lon,msl\n48,11,high\n"); }, ErrorCode::not_a_number, "line 2, column 3");
  expect_error([] { parsed_plan("x,y,z\n1,2,\n"); }, ErrorCode::plan_syntax, "line 2");
  expect_error([] { parsed_plan("lat,lon,msl\n"); }, ErrorCode::plan_empty);
}

TEST(ReadFlightPlan, TakesDegreesMinutesAndSeconds) {
  const auto first = [](const std::string& latitude, const std::string& longitude) {
    return parsed_plan("latitude;longitude;agl\n" + latitude + ";" + longitude + ";50\n")
        .items.at(0)
        .position.horizontal;
  };
  EXPECT_EQ(first("47\u00b059'60\"N", "10\u00b059'60\"E"), Eigen::Vector2d(11, 48));
  EXPECT_EQ(first("\"47\u00b0 59' 60\"\" N\"", "\"11\u00b0 0' 0\"\" E\""), Eigen::Vector2d(11, 48));
  EXPECT_EQ(first("S 47\u00b030\u2032", "W11\u00b030.6'"), Eigen::Vector2d(-11.51, -47.5));
  EXPECT_EQ(first("-47\u00b030'0\u2033", "11.25\u00b0"), Eigen::Vector2d(11.25, -47.5));
  EXPECT_NEAR(first("48\u00b00'0,36\"N", "11\u00b00'0\"E").y(), 48.0001, 1e-12);
  // Of the other kind, too large, cut off, with two signs.
  for (const std::string wrong :
       {"47\u00b059'60\"E", "47\u00b061'0\"N", "47\u00b00'61\"N", "47\u00b05", "47\u00b05'6", "-47\u00b00'0\"S",
        "47.5\u00b030'0\"N", "47\u00b030.5'10\"N", "47'30\"N", "\u00b0", "N"}) {
    EXPECT_EQ(code_of([&] { first(wrong, "11"); }), ErrorCode::not_a_number) << wrong;
  }
  // Without semicolons and quotes, too.
  EXPECT_EQ(parsed_plan("lat,lon,agl\n47\u00b059'60\"N,10\u00b059'60\"E,50\n").items.at(0).position.horizontal,
            Eigen::Vector2d(11, 48));
}

TEST(ReadFlightPlan, TakesDecimalCommasBetweenSemicolons) {
  const FlightPlan read =
      parsed_plan("\xEF\xBB\xBFlatitude;longitude;height_agl_m\n48,0000000;10,9997320;50\n48;11,5;50,25\n");
  ASSERT_EQ(read.items.size(), 2u);
  EXPECT_EQ(read.items[0].position.horizontal, Eigen::Vector2d(10.999732, 48));
  EXPECT_EQ(read.items[1].position.height_m, 50.25);
  EXPECT_EQ(parsed_plan("x\ty\tz\n1,5\t2\t3\n").items.at(0).position.horizontal.x(), 1.5);
  // Thousands, and both kinds of marks: nobody knows.
  for (const std::string row : {"48.5;11.5;1,234", "48,5;11,5;1.234", "48,5;11,5;1,234,567", "48,5;11,5;1.234,5"}) {
    expect_code([&] { parsed_plan("lat;lon;agl\n" + row + "\n"); }, ErrorCode::not_a_number, "line 2");
  }
}

TEST(ReadFlightPlan, TakesTablesOfUgcs) {
  const FlightPlan read =
      parsed_plan("Latitude,Longitude,AltitudeAMSL,AltitudeAGL,UavSpeed\n48,11,550,50,5\n48,11.1,551,50,5\n");
  EXPECT_EQ(read.items.at(1).position.height_m, 551);
  EXPECT_EQ(read.items[1].position.datum, HeightDatum::sea_level);
  EXPECT_EQ(read.items[1].speed_m_s, 5);
  ASSERT_EQ(read.notes.size(), 1u);
  expect_wording(read.notes[0].text);
  EXPECT_EQ(parsed_plan("Latitude,Longitude,AltitudeAGL\n48,11,50\n").items[0].position.datum, HeightDatum::ground);
}

TEST(ReadFlightPlan, RefusesModesOfLitchiThatItDoesNotKnow) {
  const auto read = [](const std::string& mode) {
    return parsed_plan("latitude,longitude,altitude(m),curvesize(m),altitudemode\n48,11,50,0," + mode + "\n");
  };
  EXPECT_EQ(read("0").items[0].position.datum, HeightDatum::home);
  EXPECT_EQ(read("1").items[0].position.datum, HeightDatum::ground);
  expect_error([&] { read("2"); }, ErrorCode::value_unsupported, "line 2");
  expect_code([&] { read("-1"); }, ErrorCode::value_unsupported, "line 2");
}

TEST(ReadFlightPlan, TakesNoFieldForAnotherColumns) {
  // A decimal comma, and a row that is cut off.
  expect_error([] { parsed_plan("lon,lat,msl,hold_s\n11.1,48.1,530,184773,3\n"); }, ErrorCode::plan_syntax, "line 2");
  expect_error([] { parsed_plan("lon,lat,msl,hold_s\n11.1,48.1,530\n"); }, ErrorCode::plan_syntax, "line 2");
  EXPECT_EQ(parsed_plan("lon,lat,msl,hold_s\n11.1,48.1,530,,\n").items.at(0).hold_s, 0);
  expect_error([] { parsed_plan("x,y,z,hold_s,hold_s\n1,2,3,4,5\n"); }, ErrorCode::plan_syntax, "line 1");
}

TEST(ReadFlightPlan, RefusesTwoColumnsOfOneMeaning) {
  const auto refuse = [](const std::string& header) { return [header] { parsed_plan(header + "\n48,11,500,7\n"); }; };
  expect_error(refuse("lat,lon,msl,latitude"), ErrorCode::conflicting_keys, "line 1");
  for (const std::string header : {"lat,lon,msl,LAT", "lat,lon,long,msl", "lat,lng,speed,speed_kn"}) {
    expect_code(refuse(header), ErrorCode::conflicting_keys, "line 1");
  }
  expect_code([] { parsed_plan("x,y,z,yaw,heading\n1,2,3,4,5\n"); }, ErrorCode::conflicting_keys, "line 1");
  EXPECT_EQ(parsed_plan("lat,lon,msl,agl\n48,11,500,7\n").items.at(0).position.height_m, 500);
}

TEST(ReadFlightPlan, NamesCommandsOfTables) {
  const auto told = [](const std::string& title, const std::string& first, const std::string& second) {
    return parsed_plan("lat,lon,agl," + title + "\n48,11,50," + first + "\n48,11.1,50," + second + "\n").not_judged;
  };
  ASSERT_EQ(told("command", "WAYPOINT", "ORBIT").size(), 1u);
  expect_wording(told("command", "WAYPOINT", "ORBIT"));
  EXPECT_EQ(told("Loiter Radius (m)", "50", "").size(), 1u);
  EXPECT_EQ(told("turns", "0", "16").size(), 1u);
  EXPECT_TRUE(told("cmd", "16", "").empty());
  EXPECT_EQ(told("turn_type", "straight", "spline").size(), 1u);
  for (const std::string title :
       {"type", "action", "wpType", "cmd_name", "command id", "nav_cmd", "task", "anything"}) {
    EXPECT_EQ(told(title, "waypoint", "LOITER_TIME").size(), 1u) << title;
    EXPECT_EQ(told(title, "", "RTL").size(), 1u) << title;
    EXPECT_EQ(told(title, "0", "MAV_CMD_NAV_LAND").size(), 1u) << title;
    EXPECT_EQ(told(title, "16", "18").size(), title == "anything" ? 0u : 1u) << title;
  }
  for (const std::string title : {"rtl", "spline", "land", "is_takeoff"}) {
    EXPECT_EQ(told(title, "0", "1").size(), 1u) << title;
    EXPECT_EQ(told(title, "no", "yes").size(), 1u) << title;
  }
  // What is for people, of cameras, or of a place.
  for (const std::string title : {"name", "notes", "wp_name", "description"}) {
    EXPECT_TRUE(told(title, "RTL", "land").empty()) << title;
  }
  EXPECT_TRUE(told("surface", "land", "circle").empty());
  EXPECT_TRUE(told("actiontype1,actionparam1,rotationdir,gimbalmode", "4,20,1,2", "5,-90,0,0").empty()) << "Litchi";
}

TEST(ReadFlightPlan, TellsFieldsThatMayBeCommands) {
  const auto read = [](const std::string& title, const std::string& field) {
    return parsed_plan("lat,lon,agl," + title + "\n48,11,50,0\n48,11.1,50," + field + "\n48,11.2,50," + field + "\n");
  };
  for (const auto& [title, field] :
       {std::pair("action", "photo"), {"radius", "50"}, {"type", "3"}, {"land", "grass"}}) {
    const FlightPlan plan = read(title, field);
    EXPECT_TRUE(plan.not_judged.empty()) << title;
    ASSERT_EQ(plan.notes.size(), 1u) << title;
    EXPECT_EQ(plan.notes[0].code, WarningCode::plan_left_out);
    if (field == std::string("photo")) expect_wording(plan.notes[0].text);
  }
  EXPECT_TRUE(read("camera_type", "RGB").notes.empty());
}

TEST(ReadFlightPlan, RefusesAZBesideAnotherHeight) {
  expect_error([] { parsed_plan("lat,lon,agl,z\n48,11,60,5\n"); }, ErrorCode::conflicting_keys, "line 1");
  EXPECT_EQ(parsed_plan("lat,lon,msl,x,y,z\n48,11,500,1,2,3\n").items.at(0).position.height_m, 500)
      << "as it is written";
  EXPECT_EQ(parsed_plan("lat,lon,z\n48,11,5\n").items.at(0).position.height_m, 5);
}

TEST(ReadFlightPlan, TakesUnitsThatAColumnCanHave) {
  const auto item = [](const std::string& text) { return parsed_plan(text).items.at(0); };
  EXPECT_NEAR(item("x,y,z,speed_kn\n1,2,3,36\n").speed_m_s, 18.52, 1e-9);
  EXPECT_NEAR(item("x,y,z,speed (km/h)\n1,2,3,36\n").speed_m_s, 10, 1e-9);
  EXPECT_NEAR(item("x,y,z,speed_mph\n1,2,3,10\n").speed_m_s, 4.4704, 1e-9);
  EXPECT_EQ(item("x,y,z,hold_min\n1,2,3,2\n").hold_s, 120);
  // What it is not told of is left out with a word.
  for (const char* const column : {"hold_ft", "speed_furlongs", "hold (h)"}) {
    const FlightPlan plan = parsed_plan(std::string("x,y,z,") + column + "\n1,2,3,7\n");
    EXPECT_TRUE(has_note(plan.notes, WarningCode::plan_left_out)) << column;
    EXPECT_EQ(plan.items.at(0).hold_s, 0);
    EXPECT_TRUE(std::isnan(plan.items.at(0).speed_m_s));
  }
  EXPECT_TRUE(parsed_plan("x,y,z,name,battery_left\n1,2,3,a,7\n").notes.empty());
}

TEST(ReadFlightPlan, RefusesAStayThatIsGivenTwice) {
  const auto point = [](const std::string& number, const std::string& hold) {
    return "<Placemark><ExtendedData><Data name=\"point\"><value>" + number +
           "</value></Data><Data name=\"hold_s\"><value>" + hold + "</value></Data>" +
           "</ExtendedData><Point><altitudeMode>absolute</altitudeMode><coordinates>11,48,500</coordinates></Point>" +
           "</Placemark>\n";
  };
  const std::string line = kml_line("11,48,500 11.001,48,500");
  EXPECT_EQ(parsed_plan(kml(line + point("1", "3"))).items.at(0).hold_s, 3);
  EXPECT_EQ(parsed_plan(kml(line + point("1", "3") + point("1", "3"))).items.at(0).hold_s, 3);
  expect_code([&] { parsed_plan(kml(line + point("1", "3") + point("1", "30"))); }, ErrorCode::conflicting_keys,
              "line");
  const std::string twice = "</value></Data><Data name=\"hold_s\"><value>";
  expect_code([&] { parsed_plan(kml(line + point("1", "3" + twice + "9"))); }, ErrorCode::conflicting_keys, "line");
  EXPECT_EQ(parsed_plan(kml(line + point("1", "3" + twice + "3"))).items.at(0).hold_s, 3);
}

TEST(ReadFlightPlan, TellsWhatIsWrong) {
  expect_error([] { parsed_plan(""); }, ErrorCode::file_empty);
  expect_error([] { parsed_plan(std::string("\x01\x02\x03", 3)); }, ErrorCode::plan_syntax);
  expect_error([] { parsed_plan("<svg/>"); }, ErrorCode::plan_syntax);
  expect_error([] { parsed_plan("{\"fileType\": \"Plan\"}"); }, ErrorCode::plan_empty, "mission");
  expect_error([] { parsed_plan("{\"mission\": {\"items\": 3}}"); }, ErrorCode::plan_syntax, "mission.items");
  expect_error([] { parsed_plan(plan({})); }, ErrorCode::plan_empty);
  expect_error([] { parsed_plan("{\"mission\": "); }, ErrorCode::plan_syntax, "line 1, column 13");
  expect_error([] { parsed_plan(plan({simple(16, 3, "[0, 0, 0, 0, 48, 11]")})); }, ErrorCode::plan_syntax, "item 1");
  expect_error([] { parsed_plan(plan({simple(16, 3, "[0, 0, 0, 0, \"48\", 11, 1]")})); }, ErrorCode::not_a_number,
               "item 1");
  expect_error([] { parsed_plan(plan({simple(16, 1, "[0, 0, 0, 0, 48, 11, 1]")})); }, ErrorCode::value_unsupported,
               "item 1");
  expect_error([] { parsed_plan(plan({waypoint(111, 48, 1)})); }, ErrorCode::not_on_earth, "item 1");
  expect_error([] { parsed_plan(plan({waypoint(48, 11, 1e7)})); }, ErrorCode::value_out_of_range, "item 1");
  expect_error([] { parsed_plan(plan({simple(16, 3, "[0, 0, 0, 0, 0, 0, 50]")})); }, ErrorCode::plan_empty, "item 1");
  expect_error([] { parsed_plan(plan({simple(20, 2, "[0, 0, 0, 0, 0, 0, 0]")})); }, ErrorCode::plan_empty);
  expect_error([] { parsed_plan(kml("<Placemark><Polygon/></Placemark>")); }, ErrorCode::plan_empty);
  expect_error([] { parsed_plan(kml(kml_line("11,48,1 11;48"))); }, ErrorCode::plan_syntax, "line 3, position 2");
  expect_error([] { parsed_plan(kml(kml_line("11,48,nan"))); }, ErrorCode::plan_syntax, "position 1");
  expect_error([] { parsed_plan("<!DOCTYPE kml><kml/>"); }, ErrorCode::plan_syntax, "line 1");
  expect_error([] { parsed_plan("<kml><Document></kml>"); }, ErrorCode::plan_syntax, "line 1");
  expect_error([] { parsed_plan("PK\x03\x04" + std::string(100, 'x')); }, ErrorCode::plan_syntax);
  expect_error([] { read_flight_plan("/nowhere/a.plan"); }, ErrorCode::file_not_found);
}

TEST(ReadFlightPlan, IsNotHurtByDepthAndNumber) {
  const std::string deep(200'000, '[');
  expect_code([&] { parsed_plan("{\"mission\": " + deep); }, ErrorCode::plan_syntax);
  std::string elements;
  for (int i = 0; i < 200; ++i) elements += "<a>";
  expect_code([&] { parsed_plan("<kml>" + elements); }, ErrorCode::plan_syntax);
  std::string rows = "x,y,z\n";
  for (std::size_t i = 0; i <= kMostPlanItems; ++i) rows += "1,2,3\n";
  expect_code([&] { parsed_plan(rows); }, ErrorCode::value_out_of_range);
  // Of many tracks the sum counts, and the memory is that of the first too many.
  std::string lines, positions;
  for (std::size_t i = 0; i < kMostPlanItems / 10; ++i) positions += "1,2 ";
  for (int i = 0; i < 11; ++i) lines += kml_line(positions);
  expect_code([&] { parsed_plan(kml(lines)); }, ErrorCode::value_out_of_range);
  // A placemark takes as long however many are before it: else this would take minutes.
  constexpr std::size_t kPlacemarks = 100'000;
  std::string placemarks;
  for (std::size_t i = 0; i < kPlacemarks; ++i) placemarks += kml_line("1,2,3");
  EXPECT_EQ(parsed_plan(kml(placemarks)).items.size(), kPlacemarks);
}

}  // namespace
}  // namespace vantage::testing
