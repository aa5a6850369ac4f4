// How a camera must look from a flight to keep a point in its centre.
#pragma once

#include <vector>

#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/leg_query.h"

namespace vantage::internal::flight {

/// Clockwise from north (+y), and up from the horizon, degrees. Straight up or down the yaw is 0.
struct Aim {
  double yaw_deg = 0, pitch_deg = 0;
};
Aim aim_at(const Vec3& from, const Vec3& to);

/// Of the pitch along a straight piece of a flight.
struct PitchRange {
  double min_deg = 0, max_deg = 0;
};
/// Exact: the ends, and the one place where the pitch may turn.
PitchRange pitch_range(const Leg& piece, const Vec3& to);

/// The fastest turn of the line of sight along a straight piece that is flown at this speed; infinite where it passes
/// through the point.
double fastest_turn_deg_s(const Leg& piece, const Vec3& to, double speed_m_s);

/// The same for every position within `reach_m` of the piece that flies in its direction: never less.
double fastest_turn_near_deg_s(const Leg& piece, const Vec3& to, double speed_m_s, double reach_m);

/// Where along the piece, flown at this speed, the line of sight turns no faster than `rate_deg_s`: sorted, apart;
/// never too long.
std::vector<LegInterval> slow_turns(const Leg& piece, const Vec3& to, double speed_m_s, double rate_deg_s);

}  // namespace vantage::internal::flight
