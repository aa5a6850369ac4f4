// The numbers of BuildingDefaults and OccluderDefaults by name: for the command line, missions and the table in
// docs/scene.md.
#pragma once

#include <string>
#include <vector>

#include "vantage/city.h"

namespace vantage::city {

struct Setting {
  const char* name;
  double& (*value)(CityOptions&);
  double least, most;
  const char* meaning;  ///< with the unit
};

/// Those that are single numbers.
const std::vector<Setting>& settings();

/// `name`: one of `settings()`, or one of a kind: "levels.KIND" (storeys of building=KIND), "wall.KIND" (height of
/// barrier=KIND), "tower.KIND" (height of man_made=KIND or tower:type=KIND), "way.KIND" (width of a bridge that carries
/// highway=KIND). Throws Error(input) for an unknown name and a value out of range, with `where`.
void set(CityOptions& options, const std::string& name, double value, const std::string& where);

/// Switches off "walls", "towers", "bridges" or "trees". Throws Error(input) for another word.
void leave_out(Occluders& occluders, const std::string& kind, const std::string& where);

}  // namespace vantage::city
