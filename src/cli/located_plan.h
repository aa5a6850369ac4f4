// Plans of flights as arguments: which file, and what it leaves open.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "vantage/flight.h"
#include "vantage/mission.h"
#include "vantage/progress.h"

namespace vantage::cli {

struct PlanArguments {
  std::string plan_file, track, heights;
  std::string home;                                          // "LAT,LON"
  std::string home_z, height, return_height, loiter_radius;  // lengths as typed; empty: not given
  std::optional<double> undulation;
  bool with_ground_legs = false;
};

/// The argument PLAN and its options; `arguments` must outlive the parsing.
void add_plan_options(CLI::App& command, PlanArguments& arguments);

/// The options of a plan that `plan` names. They need it.
void add_options_of_plan(CLI::App& command, PlanArguments& arguments, CLI::Option& plan);

/// The option --heights: a level for what does not say its own. `what`: "the plan does".
CLI::Option* add_heights_option(CLI::App& command, std::string& heights, const std::string& what);

/// Its level; nothing where it is not given.
std::optional<HeightDatum> datum_of(const std::string& heights);

FlightPlan read_plan_argument(const PlanArguments& arguments, const Progress& progress);

/// What the arguments say of it.
LocateOptions locate_options(const PlanArguments& arguments, const FlightPlan& plan);

/// The plan in the frame of the mission's scene, with the mission's ground and sea level, and its home where neither
/// the plan nor the arguments have one.
LocatedPlan locate_plan_argument(const PlanArguments& arguments, const FlightPlan& plan, const Mission& mission,
                                 const Progress& progress);

}  // namespace vantage::cli
