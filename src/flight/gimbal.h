// How a camera must look from a flight to keep a point in its centre.
#pragma once

#include <vector>

#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/query.h"

namespace vantage::internal::flight {

/// Clockwise from north (+y), and up from the horizon, degrees. Straight up or down the yaw is 0.
struct Aim {
  double yaw_deg = 0, pitch_deg = 0;
};
Aim aim_at(const Vec3& from, const Vec3& to);

/// The range of the pitch along a straight piece of a flight.
struct PitchRange {
  double min_deg = 0, max_deg = 0;
};
/// The range for all positions within `radius_m` of the piece. For 0 it is exact: the ends, and the one place where the
/// pitch may turn. Else it is never less, and within -90 and 90.
PitchRange pitch_range(const Leg& piece, const Vec3& to, double radius_m = 0);

/// How a vehicle may be off a piece of its flight.
struct Deviation {
  double reach_m = 0;  ///< so far beside it
  double aside = 0;    ///< and in another direction: unit vectors differ by at most so much, 0 to 2
};
/// `reach_m` beside a piece that stands for a curve, which lies at most `chord_error_m` from it.
Deviation off_chord(const Leg& piece, double reach_m, double chord_error_m);

/// The fastest turn of the line of sight of a vehicle that flies along a straight piece at this speed, and is off it by
/// no more than that: never less. Infinite where it may pass through the point.
double fastest_turn_deg_s(const Leg& piece, const Vec3& to, double speed_m_s, const Deviation& off = {});

/// Where along the piece, flown at this speed and off it by no more than that, the line of sight turns no faster than
/// `rate_deg_s`: sorted, apart; never too long.
std::vector<LegInterval> slow_turns(const Leg& piece, const Vec3& to, double speed_m_s, double rate_deg_s,
                                    const Deviation& off = {});

}  // namespace vantage::internal::flight
