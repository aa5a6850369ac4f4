// The numbers of BuildingDefaults by name: for the command line, missions and the table in docs/scene.md.
#pragma once

#include <string>
#include <vector>

#include "vantage/city.h"

namespace vantage::city {

struct Setting {
  const char* name;
  double BuildingDefaults::*value;
  double least, most;
  const char* meaning;  ///< with the unit
};

const std::vector<Setting>& settings();

/// `name`: one of `settings()`, or "levels.KIND" for the storeys of building=KIND. Throws Error(input) for an unknown
/// name and a value out of range, with `where`.
void set(BuildingDefaults& defaults, const std::string& name, double value, const std::string& where);

/// Switches off "walls", "towers", "bridges" or "trees". Throws Error(input) for another word.
void leave_out(Occluders& occluders, const std::string& kind, const std::string& where);

}  // namespace vantage::city
