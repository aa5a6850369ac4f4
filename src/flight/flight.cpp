#include "vantage/flight.h"

#include <cmath>

#include "vantage/error.h"

namespace vantage {
namespace {

void check_point(const FlightPoint& point, std::size_t index) {
  const std::string place = point.place.empty() ? "flight, point " + std::to_string(index) : point.place;
  if (!point.position.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "a point of the flight is not finite", place,
                "give three finite numbers");
  }
  if (!(point.hold_s >= 0) || !std::isfinite(point.hold_s)) {
    throw Error(ErrorCode::value_out_of_range, "the vehicle cannot stay at a point for this time", place,
                "give 0 seconds or more");
  }
  if (std::isnan(point.speed_m_s)) return;
  if (!(point.speed_m_s > 0) || !std::isfinite(point.speed_m_s)) {
    throw Error(ErrorCode::value_out_of_range, "the speed of a leg is not positive and finite", place,
                "give metres per second");
  }
}

}  // namespace

double length_m(const Flight& flight) {
  double length = 0;
  for (std::size_t i = 0; i < flight.leg_count(); ++i) {
    if (!flight.points[i + 1].is_other_way) length += (flight.leg(i).to - flight.leg(i).from).norm();
  }
  return length;
}

void check_flight_points(const Flight& flight) {
  if (flight.points.empty()) {
    throw Error(ErrorCode::nothing_given, "the flight has no points", "flight", "give one point or more");
  }
  for (std::size_t i = 0; i < flight.points.size(); ++i) check_point(flight.points[i], i);
}

}  // namespace vantage
