// Flights: where a vehicle goes, in the scene frame.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/query.h"

namespace vantage {

/// Where legs meet.
struct FlightPoint {
  Vec3 position = Vec3::Zero();                                 ///< scene frame, metres
  double hold_s = 0;                                            ///< for so long it stays there; >= 0
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();  ///< of the leg that ends here; NaN: not stated
  std::string place = {};  ///< in the plan that it came from, for messages: "survey.plan: item 3"; may be empty
};

/// A flight along straight legs, from each point to the next one.
struct Flight {
  std::vector<FlightPoint> points;
  double chord_error_m = 0;  ///< the legs lie at most so far from the curves that they stand for

  /// One less than there are points, or none.
  std::size_t leg_count() const { return points.empty() ? 0 : points.size() - 1; }
  Leg leg(std::size_t index) const { return {points[index].position, points[index + 1].position}; }
};

/// Of all legs, metres.
VANTAGE_API double length_m(const Flight& flight);

/// Throws Error(input) for a flight without points, and with the point's place for a position, a hold or a speed that
/// is not finite (a speed may be NaN), a hold below 0 and a speed that is not positive.
VANTAGE_API void check_flight_points(const Flight& flight);

}  // namespace vantage
