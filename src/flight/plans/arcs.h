// Circles and cut corners as chords.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::flight::plans {

/// Points of a circle about the origin of the plane (x east, y north), the first one `radius` away in the direction of
/// `towards` (north where that is 0), with so many turns: clockwise seen from above for a positive radius. Chords lie
/// within `error_m` of the circle: n of them have the sagitta r (1 - cos(pi / n)). At least two points, of `turns` 0
/// one.
std::vector<Eigen::Vector2d> circle_points(const Eigen::Vector2d& towards, double radius_m, double turns,
                                           double error_m);

/// How many chords circle_points makes.
double chord_count(double radius_m, double turns, double error_m);

/// The arc that touches both legs at a corner, `cut_m` before it and behind it: from the first to the last point,
/// chords within `error_m`. The corner alone where the legs go straight on or back, or are too short for 1 mm of it.
std::vector<Vec3> corner_points(const Vec3& before, const Vec3& corner, const Vec3& after, double cut_m,
                                double error_m);

}  // namespace vantage::internal::flight::plans
