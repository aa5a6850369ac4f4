// Level closed curves that a vehicle can circle on: circles, and racetracks of two half circles and two straights.
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::flight {

struct ClosedCurve {
  Vec3 centre = Vec3::Zero();
  double radius_m = 0;         ///< of the turns; > 0
  double half_straight_m = 0;  ///< half of a straight's length; 0: a circle
  double angle = 0;            ///< of the straights, radians, counter-clockwise from +x

  double length_m() const;
  /// Counter-clockwise, by the length of the way from the beginning of a straight.
  Vec3 at(double way_m) const;
  /// How far a place lies outside in plan; 0 within.
  double distance_outside(const Vec3& place) const;

  /// Points of the curve, the first one not repeated. The chords between them are at most `chord_error_m` > 0 from it,
  /// inside.
  std::vector<Vec3> corners(double chord_error_m) const;
  /// `count` points, the same way apart.
  std::vector<Vec3> points(std::size_t count) const;
};

}  // namespace vantage::internal::flight
