// Sections of mission files that are described once (src/request/): what is read, written and documented of them.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/described_section.h"
#include "request/describe_sensor.h"
#include "request/describe_spheres.h"
#include "request/describe_tour.h"
#include "request/json_object.h"
#include "request/key_lists.h"
#include "support/key_table.h"
#include "support/random.h"
#include "support/wording.h"
#include "support/written_part.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/mission_keys.h"

namespace vantage {
namespace {

using internal::app::section_text;
using internal::request::key_lists;
using internal::request::kSection;
using testing::expect_between;

TEST(DescribedKeys, AreDocumented) {
  std::vector<std::string> sections;
  for (const MissionKey& key : mission_keys()) {
    if (sections.empty() || sections.back() != key.section) sections.push_back(key.section);
  }
  for (const std::string& section : sections) {
    expect_between("docs/mission-file.md", "<!-- keys of " + section + ": written by a test -->\n",
                   "<!-- end of keys -->", testing::key_table(section));
  }
}

TEST(DescribedKeys, AreInTheDictionaryOfTheFuzzer) {
  std::set<std::string> words;
  for (const MissionKey& key : mission_keys()) {
    words.insert("\"" + key.path.substr(key.path.rfind('.') + 1) + ":\"");
    for (const std::string& word : key.words) words.insert("\"" + word + "\"");
  }
  std::string lines;
  for (const std::string& word : words) lines += word + "\n";
  expect_between("tests/fuzz/mission.dict", "# Keys and their words, written by a test:\n", "# Others:\n", lines);
}

TEST(DescribedKeys, AreNamedOnceInTheirSection) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const MissionKey& key : mission_keys()) {
    EXPECT_TRUE(seen.emplace(key.section, key.path).second) << key.section << "." << key.path;
    EXPECT_NE(key.text, "");
    EXPECT_FALSE(std::string(name_of(key.kind)).empty());
  }
}

TEST(DescribedKeys, OfATourAreListedMapByMap) {
  const auto lists = key_lists<TourSettings>();
  ASSERT_EQ(lists.size(), 4);
  EXPECT_EQ(lists[0].name, "tour");
  EXPECT_EQ(lists[0].keys, (std::vector<std::string_view>{"vehicle", "home", "closed", "view", "gimbal", "clearance",
                                                          "tube", "gap", "time_limit"}));
  EXPECT_EQ(lists[1].name, "tour.vehicle");
  EXPECT_EQ(lists[1].keys, (std::vector<std::string_view>{"kind", "speed", "acceleration", "turn_radius", "climb"}));
  EXPECT_EQ(lists[2].name, "tour.view");
  EXPECT_EQ(lists[3].name, "tour.gimbal");
}

TEST(DescribedKeys, OfATourAreReadBackAsTheyWereWritten) {
  testing::Random random(81);
  for (int i = 0; i < 200; ++i) {
    TourSettings tour;
    const bool is_wing = random.chance(0.5);
    tour.vehicle.kind = is_wing ? TourVehicle::Kind::fixed_wing : TourVehicle::Kind::multirotor;
    tour.vehicle.speed_m_s = random.uniform(1, 30);
    (is_wing ? tour.vehicle.turn_radius_m : tour.vehicle.acceleration_m_s2) = random.uniform(1, 30);
    if (is_wing) tour.vehicle.min_climb_deg = random.uniform(-80, -1);
    if (random.chance(0.5)) tour.home = TourHome{{}, random.point(-100, 100)};
    if (random.chance(0.3)) tour.home = TourHome{std::array{random.uniform(-80, 80), random.uniform(-170, 170)}, {}};
    tour.closed = random.chance(0.5);
    tour.dwell_s = random.uniform(0, 100);
    tour.simultaneous = random.chance(0.5);
    tour.tube_m = random.uniform(0, 100);
    if (random.uniform(0, 1) < 0.5) tour.gap = random.uniform(0, 0.9);
    tour.time_limit_s = random.uniform(1, 100);
    const std::string text = section_text(tour);
    const MissionFile file =
        read_mission_text(text + "target: {vertices: [[0, 0, 0], [9, 0, 0], [0, 9, 0]]}\nsensor: {max_range: 100}\n",
                          "memory.yaml", SceneSource());
    ASSERT_TRUE(file.tour) << text;
    EXPECT_EQ(section_text(*file.tour), text);
    const auto& [vehicle, home, closed, dwell_s, margin_m, simultaneous, rate, clearance_m, tube_m, gap, time_limit_s] =
        *file.tour;
    EXPECT_EQ(vehicle.kind, tour.vehicle.kind);
    EXPECT_EQ(vehicle.turn_radius_m, tour.vehicle.turn_radius_m);
    EXPECT_EQ(vehicle.min_climb_deg, tour.vehicle.min_climb_deg);
    EXPECT_EQ(home.has_value(), tour.home.has_value());
    EXPECT_EQ(closed, tour.closed);
    EXPECT_EQ(dwell_s, tour.dwell_s);
    EXPECT_EQ(simultaneous, tour.simultaneous);
    EXPECT_EQ(tube_m, tour.tube_m);
    EXPECT_EQ(gap, tour.gap);
    EXPECT_EQ(time_limit_s, tour.time_limit_s);
  }
}

TEST(DescribedKeys, AreReadFromTheJsonThatWasWritten) {
  using Json = nlohmann::ordered_json;
  const auto number_as = [](auto value) { return Json(value); };
  internal::request::JsonObject<Json, decltype(number_as)> object(number_as);
  const PixelLimit pixel = {0.02, PixelLimit::Kind::perpendicular};
  describe(pixel, object);
  EXPECT_EQ(object.json().dump(), R"({"size_m":0.02,"kind":"perpendicular"})");
  const auto read = [](const char* text) {
    const Json json = Json::parse(text);
    PixelLimit limit;
    internal::request::JsonReader<Json> reader(json, kSection<PixelLimit>);
    describe(limit, reader);
    return limit;
  };
  EXPECT_EQ(read(R"({"size_m": 0.02, "kind": "perpendicular"})").kind, PixelLimit::Kind::perpendicular);
  EXPECT_EQ(read(R"({"size_m": 0.02, "kind": "worst"})").size_m, 0.02);
  testing::expect_code([&] { read(R"({"size_m": 0.02, "kind": "wurst"})"); }, ErrorCode::unknown_choice,
                       "sensor.pixel.kind");
  testing::expect_code([&] { read(R"({"size_m": 0, "kind": "worst"})"); }, ErrorCode::value_out_of_range,
                       "sensor.pixel.size");
  EXPECT_THROW(read(R"({"kind": "worst"})"), std::exception);
}

TEST(DescribedKeys, ANumberThatIsNoneAtZeroIsLeftOutThen) {
  const PilotSight seated = {{0.35, VisualRange::Kind::multirotor, 5000}, 0};
  EXPECT_EQ(internal::app::flow_text(seated), "{aircraft_size: 0.35, kind: multirotor, visibility: 5000}");
  PilotSight standing = seated;
  standing.eye_height_m = 1.7;
  EXPECT_EQ(internal::app::flow_text(standing),
            "{aircraft_size: 0.35, kind: multirotor, visibility: 5000, eye_height: 1.7}");
}

TEST(Bounds, TellWhichNumbersTheyTake) {
  using internal::request::Bounds;
  using internal::request::Unit;
  const Bounds share = {0, 1, Unit::none, "give a share", "", Bounds::Ends::without_most};
  EXPECT_TRUE(share.hold(0));
  EXPECT_FALSE(share.hold(1));
  EXPECT_FALSE(share.hold(std::nan("")));
  const Bounds descent = {-90, -0.1, Unit::degrees, "", "", Bounds::Ends::without_least};
  EXPECT_FALSE(descent.hold(-90));
  EXPECT_TRUE(descent.hold(-0.1));
  EXPECT_EQ((Bounds{0.01, 1e5}).text(), "0.01 to 100,000");
  const Bounds week = {0, 604'800, Unit::seconds, "", "a week", Bounds::Ends::without_least};
  const Bounds angle = {0, 90, Unit::degrees, "give degrees", "", Bounds::Ends::neither};
  testing::expect_wording({share.text(), week.text(), angle.text()});
  testing::expect_error([&] { check_within(share, 1, "key"); }, ErrorCode::value_out_of_range, "key");
  testing::expect_error([&] { check_within(angle, 90, "key"); }, ErrorCode::value_out_of_range, "key");
  EXPECT_EQ((Bounds{0, 1000}).text(), "0 to 1000");
  const Bounds length = {0, internal::request::kLongest, Unit::metres, "", "", Bounds::Ends::without_least};
  EXPECT_FALSE(length.hold(0));
  EXPECT_EQ(length.text(), "> 0");
}

}  // namespace
}  // namespace vantage
