#include <array>
#include <functional>
#include <map>

#include "core/format.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage {
namespace {

constexpr double kLeastLevels = 0.5, kMostLevels = 200;
constexpr double kLowest = 0.05, kHighest = 700, kWidest = 200;  // metres, as of tags

void check(double value, double least, double most, const std::string& name, const std::string& where) {
  if (value >= least && value <= most) return;
  throw Error(ErrorCode::value_out_of_range, std::string(name).append(" cannot be that"), where,
              internal::core::format("give a number from {:g} to {:g}", least, most));
}

/// The height of a kind that has sizes. One that is not in the table would never be looked up.
double& height_of(std::map<std::string, OccluderDefaults::Size, std::less<>>& sizes, const std::string& kind,
                  const std::string& name, const std::string& where) {
  const auto found = sizes.find(kind);
  if (found != sizes.end()) return found->second.height_m;
  std::string known;
  for (const auto& [other, size] : sizes) known.append(known.empty() ? "" : ", ").append(other);
  throw Error(ErrorCode::unknown_choice, "there is no default '" + name + "'", where, "the kinds are: " + known);
}

/// "levels.house" and the like; false when the name is none of these.
bool set_of_kind(CityOptions& options, const std::string& name, double value, const std::string& where) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos || dot + 1 == name.size()) return false;
  const std::string family = name.substr(0, dot), kind = name.substr(dot + 1);
  if (family == "levels") {
    check(value, kLeastLevels, kMostLevels, name, where);
    options.defaults.levels_of[kind] = value;
  } else if (family == "wall" || family == "tower") {
    auto& sizes = family == "wall" ? options.occluder_defaults.walls : options.occluder_defaults.towers;
    double& height = height_of(sizes, kind, name, where);
    check(value, kLowest, kHighest, name, where);
    height = value;
  } else if (family == "way") {
    check(value, 0.5, kWidest, name, where);
    options.occluder_defaults.ways[kind] = value;
  } else {
    return false;
  }
  return true;
}

}  // namespace

const std::vector<CitySetting>& city_settings() {
  static const std::vector<CitySetting> kSettings = {
      {"level", [](CityOptions& o) -> double& { return o.defaults.level_m; }, 1, 20, "height of a storey, m"},
      {"levels", [](CityOptions& o) -> double& { return o.defaults.levels; }, kLeastLevels, kMostLevels,
       "storeys of a building without height and levels"},
      {"roof_level", [](CityOptions& o) -> double& { return o.defaults.roof_level_m; }, 0.5, 20,
       "height of a storey in the roof, m"},
      {"roof_pitch", [](CityOptions& o) -> double& { return o.defaults.roof_pitch_deg; }, 1, 80,
       "slope of a roof without a height, degrees"},
      {"roof_deck", [](CityOptions& o) -> double& { return o.defaults.roof_deck_m; }, 0.01, 20,
       "thickness of roofs on posts, m"},
      {"layer", [](CityOptions& o) -> double& { return o.occluder_defaults.layer_m; }, 0.5, 50,
       "underside of a bridge for each layer, m"},
      {"deck", [](CityOptions& o) -> double& { return o.occluder_defaults.deck_m; }, 0.05, 20,
       "thickness of a bridge's deck, m"},
      {"lane", [](CityOptions& o) -> double& { return o.occluder_defaults.lane_m; }, 1, 20, "width of a lane, m"},
      {"track", [](CityOptions& o) -> double& { return o.occluder_defaults.track_m; }, 1, 20,
       "width of a railway track, m"},
      {"way", [](CityOptions& o) -> double& { return o.occluder_defaults.other_way_m; }, 0.5, kWidest,
       "width of a bridge that carries another way, m"},
      {"tree", [](CityOptions& o) -> double& { return o.occluder_defaults.tree_m; }, 0.5, 150, "height of a tree, m"},
      {"crown", [](CityOptions& o) -> double& { return o.occluder_defaults.crown_share; }, 0.1, 2,
       "diameter of a tree's crown by its height"},
      {"tree_spacing", [](CityOptions& o) -> double& { return o.occluder_defaults.tree_spacing_m; }, 1, 100,
       "between the trees of a row, m"},
  };
  return kSettings;
}

void set_city_option(CityOptions& options, const std::string& name, double value, const std::string& where) {
  for (const CitySetting& setting : city_settings()) {
    if (name != setting.name) continue;
    check(value, setting.least, setting.most, name, where);
    setting.value(options) = value;
    return;
  }
  if (set_of_kind(options, name, value, where)) return;
  std::string known;
  for (const CitySetting& setting : city_settings()) known.append(setting.name).append(", ");
  throw Error(ErrorCode::unknown_choice, "there is no default '" + name + "'", where,
              "the defaults are: " + known + "and of a kind levels.house, wall.fence, tower.mast, way.footway");
}

std::span<const OccluderSwitch> occluder_switches() {
  static constexpr std::array<OccluderSwitch, 13> kSwitches = {{{"walls", &Occluders::walls},
                                                                {"towers", &Occluders::towers},
                                                                {"bridges", &Occluders::bridges},
                                                                {"trees", &Occluders::trees},
                                                                {"woods", &Occluders::woods},
                                                                {"stadiums", &Occluders::stadiums},
                                                                {"masts", &Occluders::masts},
                                                                {"turbines", &Occluders::turbines},
                                                                {"cranes", &Occluders::cranes},
                                                                {"tanks", &Occluders::tanks},
                                                                {"monuments", &Occluders::monuments},
                                                                {"others", &Occluders::others},
                                                                {"lines", &Occluders::lines}}};
  return kSwitches;
}

const char* name_of(HeightUnit unit) {
  switch (unit) {
    case HeightUnit::metre:
      return "m";
    case HeightUnit::foot:
      return "ft";
    case HeightUnit::us_survey_foot:
      return "us-ft";
  }
  return "unknown";
}

HeightUnit height_unit(const std::string& name, const std::string& where) {
  for (const HeightUnit unit : {HeightUnit::metre, HeightUnit::foot, HeightUnit::us_survey_foot}) {
    if (name == name_of(unit)) return unit;
  }
  throw Error(ErrorCode::unknown_choice, "'" + name + "' is not a unit of heights", where,
              "write m (metres), ft (feet) or us-ft (US survey feet)");
}

void leave_out(Occluders& occluders, const std::string& kind, const std::string& where) {
  std::string names;
  for (const OccluderSwitch& one : occluder_switches()) {
    if (kind == one.name) {
      occluders.*one.on = false;
      return;
    }
    names.append(names.empty() ? "" : ", ").append(one.name);
  }
  throw Error(ErrorCode::unknown_choice, "'" + kind + "' is not what can be left out", where, "write one of: " + names);
}

}  // namespace vantage
