// What a plan that is written needs, and the mission does not say.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "vantage/flight.h"

namespace vantage::cli {

struct PlanOutput {
  std::string aircraft;              ///< "TYPE,SUBTYPE" or "TYPE,SUBTYPE,CAMERA"; empty: not given
  std::optional<double> undulation;  ///< of the mean sea level above the ellipsoid, metres
  std::string start;                 ///< ISO 8601 with a zone; empty: not given
};

/// check_can_write of a file that is no volume: where a folder is given, the advice names `example` in it.
void check_can_write_like(const std::string& file, const std::string& example);

/// --aircraft, --undulation and --start; `output` must outlive the parsing.
void add_plan_output(CLI::App& command, PlanOutput& output);

/// The plan with what was given. Throws Error(input) for an aircraft or a time that is none.
FlightOut with_output(FlightOut plan, const PlanOutput& output);

}  // namespace vantage::cli
