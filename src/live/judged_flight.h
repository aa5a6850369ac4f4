// A flight beside a mission, for the page: what it sees, as JSON.
#pragma once

#include <optional>
#include <string>

#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage::live {

/// A plan, and what it leaves open.
struct GivenFlight {
  FlightPlan plan;
  LocateOptions locate;
  std::optional<double> speed_m_s;  ///< of legs for which the plan states none
  std::string name;                 ///< of its file
};

/// JSON: {name, home: [x, y, z] of the ground or null, notes: texts, check: as json_text of vantage/flight_check.h}.
/// `mission`: with a volume for each target. Throws as locate_flight and check_flight do.
std::string judged_flight(const GivenFlight& given, const Mission& mission, const PreparedScene& prepared,
                          const Progress& progress);

}  // namespace vantage::live
