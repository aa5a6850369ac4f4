#include "city/settings.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "vantage/error.h"

namespace vantage::city {
namespace {

constexpr const char* kLevelsOf = "levels.";
constexpr double kMostLevels = 200;

void check(double value, double least, double most, const std::string& name, const std::string& where) {
  if (value >= least && value <= most) return;
  char text[128];
  std::snprintf(text, sizeof text, "give a number from %g to %g", least, most);
  throw Error(ErrorKind::input, std::string(name).append(" cannot be that"), where, text);
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> kSettings = {
      {"level", &BuildingDefaults::level_m, 1, 20, "height of a storey, m"},
      {"levels", &BuildingDefaults::levels, 0.5, kMostLevels, "storeys of a building without height and levels"},
      {"roof_level", &BuildingDefaults::roof_level_m, 0.5, 20, "height of a storey in the roof, m"},
      {"roof_pitch", &BuildingDefaults::roof_pitch_deg, 1, 80, "slope of a roof without a height, degrees"},
      {"roof_deck", &BuildingDefaults::roof_deck_m, 0.01, 20, "thickness of roofs on posts, m"},
  };
  return kSettings;
}

void set(BuildingDefaults& defaults, const std::string& name, double value, const std::string& where) {
  if (name.starts_with(kLevelsOf) && name.size() > std::string_view(kLevelsOf).size()) {
    check(value, 0.5, kMostLevels, name, where);
    defaults.levels_of[name.substr(std::string_view(kLevelsOf).size())] = value;
    return;
  }
  for (const Setting& setting : settings()) {
    if (name != setting.name) continue;
    check(value, setting.least, setting.most, name, where);
    defaults.*setting.value = value;
    return;
  }
  std::string known;
  for (const Setting& setting : settings()) known.append(setting.name).append(", ");
  throw Error(ErrorKind::input, "there is no default '" + name + "'", where,
              "the defaults are: " + known + "and levels.KIND, such as levels.house");
}

void leave_out(Occluders& occluders, const std::string& kind, const std::string& where) {
  if (kind == "walls") {
    occluders.walls = false;
  } else if (kind == "towers") {
    occluders.towers = false;
  } else if (kind == "bridges") {
    occluders.bridges = false;
  } else if (kind == "trees") {
    occluders.trees = false;
  } else {
    throw Error(ErrorKind::input, "'" + kind + "' is not what can be left out", where,
                "write walls, towers, bridges or trees");
  }
}

}  // namespace vantage::city
