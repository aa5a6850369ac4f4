// The table of defaults: names, bounds, and that docs/scene.md says what the code does.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "support/places.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage {
namespace {

std::string manual() {
  std::ifstream file(testing::source_folder() / "docs/scene.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

Error refusal(const std::string& name, double value, ErrorCode code) {
  CityOptions options;
  return testing::expect_error([&] { set_city_option(options, name, value, "here"); }, code, "here");
}

TEST(CitySettings, EachSetsANumberOfItsOwnWithinItsBounds) {
  for (const CitySetting& setting : city_settings()) {
    CityOptions options;
    const double before = setting.value(options);
    EXPECT_GE(before, setting.least) << setting.name;
    EXPECT_LE(before, setting.most) << setting.name;
    set_city_option(options, setting.name, setting.most, "here");
    EXPECT_EQ(setting.value(options), setting.most) << setting.name;
    for (const CitySetting& other : city_settings()) {
      CityOptions untouched;
      if (&other == &setting) continue;
      EXPECT_EQ(other.value(options), other.value(untouched)) << other.name;
    }
    const Error above = refusal(setting.name, setting.most * 1.01, ErrorCode::value_out_of_range);
    EXPECT_NE(above.fix().find(number(setting.least)), std::string::npos) << above.what();
    refusal(setting.name, setting.least * 0.99, ErrorCode::value_out_of_range);
  }
}

TEST(CitySettings, OfAKind) {
  CityOptions options;
  set_city_option(options, "levels.house", 4, "");
  set_city_option(options, "levels.castle", 5, "");
  set_city_option(options, "wall.fence", 3, "");
  set_city_option(options, "tower.mast", 60, "");
  set_city_option(options, "way.footway", 3.5, "");
  EXPECT_EQ(options.defaults.levels_of.at("house"), 4);
  EXPECT_EQ(options.defaults.levels_of.at("castle"), 5) << "a kind that the table does not have";
  EXPECT_EQ(options.occluder_defaults.walls.at("fence").height_m, 3);
  EXPECT_EQ(options.occluder_defaults.walls.at("fence").width_m, 0.1);
  EXPECT_EQ(options.occluder_defaults.towers.at("mast").height_m, 60);
  EXPECT_EQ(options.occluder_defaults.ways.at("footway"), 3.5);
}

TEST(CitySettings, RefusesWhatIsNone) {
  for (const char* name : {"", "levles", "levels.", ".house", "floor.house", "wall"}) {
    const Error error = refusal(name, 3, ErrorCode::unknown_choice);
    EXPECT_NE(error.fix().find("roof_pitch"), std::string::npos) << name;
  }
  const Error unknown = refusal("tower.eiffel", 300, ErrorCode::unknown_choice);  // it would never be looked up
  EXPECT_NE(unknown.fix().find("lighthouse"), std::string::npos) << unknown.what();
  const Error negative = refusal("wall.fence", -1, ErrorCode::value_out_of_range);
  EXPECT_NE(negative.problem().find("wall.fence"), std::string::npos) << negative.what();
  refusal("levels.house", 0, ErrorCode::value_out_of_range);
  refusal("way.footway", 1e6, ErrorCode::value_out_of_range);
}

TEST(CitySettings, TheManualHasThemAll) {
  const std::string text = manual();
  const auto expect = [&](const std::string& row) { EXPECT_NE(text.find(row), std::string::npos) << row; };
  CityOptions options;
  for (const CitySetting& setting : city_settings()) {
    expect(std::string("| `")
               .append(setting.name)
               .append("` | ")
               .append(number(setting.value(options)))
               .append(" | ")
               .append(number(setting.least))
               .append(" to ")
               .append(number(setting.most))
               .append(" | ")
               .append(setting.meaning)
               .append(" |"));
  }
  const auto kind = [](const char* family, const std::string& name, const std::string& value) {
    return std::string("`").append(family).append(name).append("` ").append(value);
  };
  for (const auto& [name, value] : options.defaults.levels_of) expect(kind("levels.", name, number(value)));
  for (const auto& [name, value] : options.occluder_defaults.ways) expect(kind("way.", name, number(value)));
  const auto size = [](const OccluderDefaults::Size& s) {
    return number(s.height_m).append(" × ").append(number(s.width_m));
  };
  for (const auto& [name, value] : options.occluder_defaults.walls) expect(kind("wall.", name, size(value)));
  for (const auto& [name, value] : options.occluder_defaults.towers) expect(kind("tower.", name, size(value)));
}

}  // namespace
}  // namespace vantage
