// The zones of a mission as the geofence of a ground station, which has no heights and no holes.
#pragma once

#include <string>
#include <vector>

#include "vantage/flight.h"
#include "vantage/navigation.h"

namespace vantage::internal::flight::plans {

struct Geofence {
  std::vector<Zone::Ring> stay_in, stay_out;
  std::vector<std::string> left_out;  ///< zones that the flight would break, seen from above

  bool empty() const { return stay_in.empty() && stay_out.empty(); }
};

/// An autopilot refuses a flight that breaks its fence. So those zones are left out in which the flight or its home
/// lies, seen from above: it passes over them or under them, or through a hole. All of those to stay in are left out
/// where it lies outside of one of them.
Geofence geofence_of(const FlightOut& flight);

}  // namespace vantage::internal::flight::plans
