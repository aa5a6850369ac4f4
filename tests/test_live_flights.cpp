// What the page is told of a flight, and of the volumes that it flies through.
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "live/judged_flight.h"
#include "support/live_session.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage::live {
namespace {

GivenFlight given_flight(const std::string& table) {
  GivenFlight given;
  given.plan = parse_flight_plan(table, "flight.csv");
  given.locate.unknown_heights = HeightDatum::scene_z;
  given.speed_m_s = 5;
  given.name = "flight.csv";
  return given;
}

constexpr const char* kOver = "x,y,z\n-40,0,40\n40,0,40\n";

TEST_F(LiveSession, TellsWhatAFlightSees) {
  EXPECT_TRUE(Json::parse(session_.hello())["flight"].is_null());
  EXPECT_EQ(code_of({{"call", "flight"}}), name_of(ErrorCode::nothing_given));
  session_.show_flight(given_flight(kOver));
  const Json flight = Json::parse(session_.hello())["flight"];
  EXPECT_EQ(flight["name"], "flight.csv");
  EXPECT_TRUE(flight["home"].is_null());
  // What the program says of it.
  write("flight.csv", kOver);
  const auto checked = [&](const std::string& mission) {
    return Json::parse(run({"check", mission, "flight.csv", "--heights", "scene", "--speed", "5", "--json"}).out);
  };
  EXPECT_EQ(flight["check"], checked("mission.yaml"));
  ASSERT_FALSE(flight["check"]["targets"][0]["seen"].empty());
  EXPECT_EQ(flight["check"]["targets"][0]["parts"][0][2]["x_m"], 5);
  EXPECT_EQ(flight["check"]["points"][1]["position"]["x_m"], 40);
  // As it was sent, and by the mission that was opened where there is no volume yet.
  EXPECT_EQ(session_.hello().find('\n'), std::string::npos);
  EXPECT_EQ(ask({{"call", "hello"}}).header["value"]["flight"], flight);
  EXPECT_EQ(ask({{"call", "flight"}}).header["value"], flight);
  // By the mission of the last volume, which has another range.
  const std::string nearer =
      "target: {name: square, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}\nsensor: {max_range: 45}\n";
  ask({{"call", "compute"}, {"text", nearer}});
  const Json again = ask({{"call", "flight"}}).header["value"]["check"];
  write("nearer.yaml", testing::kScene + nearer);
  EXPECT_EQ(again, checked("nearer.yaml"));
  EXPECT_NE(again["targets"], flight["check"]["targets"]);
}

TEST_F(LiveSession, AFlightSeesEachOfSeveralTargetsByItself) {
  const std::string targets =
      "targets:\n  - {name: a, vertices: [[-35, -5, 0], [-30, -5, 0], [-30, 5, 0]]}\n"
      "  - {name: b, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\nsensor: {max_range: 42}\n";
  write("several.yaml", testing::kScene + targets);
  session_.open_file(folder_ / "several.yaml");
  session_.show_flight(given_flight(kOver));
  ask({{"call", "compute"}, {"text", targets}});
  for (const Json& flight : {Json::parse(session_.hello())["flight"], ask({{"call", "flight"}}).header["value"]}) {
    ASSERT_EQ(flight["check"]["targets"].size(), 2U);
    EXPECT_EQ(flight["check"]["targets"][0]["name"], "a");
    EXPECT_FALSE(flight["check"]["targets"][0]["seen"].empty());
    EXPECT_FALSE(flight["check"]["targets"][1]["seen"].empty());
  }
}

TEST_F(LiveSession, EachTargetHasAVolumeOfItsOwn) {
  EXPECT_EQ(ask({{"call", "volumes"}}).header["value"]["volumes"].size(), 1U) << "of the mission that was opened";
  const std::string targets =
      "targets:\n  - {name: a, vertices: [[-35, -5, 0], [-30, -5, 0], [-30, 5, 0]]}\n"
      "  - {name: b, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\nsensor: {max_range: 42}\n";
  ask({{"call", "compute"}, {"text", targets}});
  const Message message = ask({{"call", "volumes"}});
  EXPECT_EQ(message.header["value"]["volumes"],
            Json::parse(R"([{"name": "a", "reason": ""}, {"name": "b", "reason": ""}])"));
  write("each.yaml", testing::kScene + targets + "combine: each\n");
  const Mission each = resolve_mission(read_mission(folder_ / "each.yaml"));
  std::vector<std::size_t> expected;
  for (std::size_t i = 0; i < 2; ++i) expected.push_back(run_mission(one_volume(each, i)).volume.mesh.triangles.size());
  const ViewMesh& view = session_.target_volumes_view();
  EXPECT_EQ(message.header["mesh"][2], view.label_of.size());
  for (std::uint32_t i = 0; i < 2; ++i) {
    EXPECT_EQ(std::count(view.label_of.begin(), view.label_of.end(), i), static_cast<std::ptrdiff_t>(expected[i]));
  }
  EXPECT_EQ(view.triangles.size(), 3 * view.label_of.size());
  EXPECT_LT(*std::max_element(view.triangles.begin(), view.triangles.end()), view.positions.size() / 3);
  // The last volume stays what it was.
  EXPECT_EQ(ask({{"call", "prove"}}).header["value"]["verdict"], "proved");
}

// Nothing of them is to be seen, so that there is no volume of the mission.
TEST_F(LiveSession, AFlightIsShownThroughVolumesThatAreGiven) {
  ask({{"call", "compute"}, {"text", kSquare}});
  ask({{"call", "save"}, {"format", "ply"}});
  write("region.ply", session_.bytes());
  const std::string square = "{name: square, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}";
  const std::string body = "targets:\n  - " + square +
                           "\n  - {volume: region.ply}\nsensor: {max_range: 60}\nnavigation: {altitude: [0, 30]}\n"
                           "links: [{name: \"the \\\"pilot\\\"\", point: [0, -30, 2], max_range: 50}]\n";
  write("through.yaml", testing::kScene + body);
  Session session;
  session.open_file(folder_ / "through.yaml");
  session.show_flight(given_flight("x,y,z\n-40,0,25\n40,0,25\n"));
  session_ = session;
  EXPECT_EQ(code_of({{"call", "compute"}, {"text", body}}), name_of(ErrorCode::not_applicable));
  const Json check = ask({{"call", "flight"}}).header["value"]["check"];
  EXPECT_EQ(check["targets"][1]["volume"], true);
  EXPECT_FALSE(check["targets"][1]["seen"].empty());
  EXPECT_EQ(check["links"][0]["name"], "the \"pilot\"");
  const Message message = ask({{"call", "volumes"}});
  EXPECT_EQ(message.header["value"]["volumes"],
            Json::parse(R"([{"name": "square", "reason": ""}, {"name": "region", "reason": ""}])"));
  // What the limits of navigation leave of it.
  const ViewMesh& view = session_.target_volumes_view();
  std::ptrdiff_t given = 0;
  float highest = -1000;
  for (std::size_t i = 0; i < view.label_of.size(); ++i) {
    if (view.label_of[i] != 1) continue;
    ++given;
    for (std::size_t k = 0; k < 3; ++k) highest = std::max(highest, view.positions[3 * view.triangles[3 * i + k] + 2]);
  }
  EXPECT_GT(given, 4);
  const double middle = (bounding_box(session_.scene().mesh).min.z() + bounding_box(session_.scene().mesh).max.z()) / 2;
  EXPECT_NEAR(highest, 30 - middle, 1e-4);
}

}  // namespace
}  // namespace vantage::live
