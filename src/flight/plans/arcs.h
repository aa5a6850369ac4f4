// Circles, arcs, cut corners and splines as chords.
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

/// The circle on which one comes from the origin to `to` while turning by `angle_deg`, above 0 clockwise seen from
/// above (x east, y north), no multiple of 360: its centre. The radius is the distance of that from the origin.
Eigen::Vector2d arc_centre(const Eigen::Vector2d& to, double angle_deg);

/// The cubic curve from `from` to `to` with these derivatives at its ends (Hermite's), without its first point. Chords
/// lie within `error_m` of it: n of them within (1 / n)^2 / 8 of the largest second derivative, which is that at an
/// end.
std::vector<Vec3> spline_points(const Vec3& from, const Vec3& to, const Vec3& from_tangent, const Vec3& to_tangent,
                                double error_m);

/// The arc that touches both legs at a corner, `cut_m` before it and behind it: from the first to the last point,
/// chords within `error_m`. The corner alone where the legs go straight on or back, or are too short for 1 mm of it.
std::vector<Vec3> corner_points(const Vec3& before, const Vec3& corner, const Vec3& after, double cut_m,
                                double error_m);

}  // namespace vantage::internal::flight::plans
