// Convex polygons grown by a ball, as convex polytopes that hold the exact shape.
#pragma once

#include <span>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// How far beyond the ball's radius a grown polygon reaches at most, in parts of the radius: beside edges 0.083, round
/// corners this. Straight over the polygon it is no more than rounding.
constexpr double kMostGrownTooFar = 0.16;

/// A closed, outward oriented mesh of a convex polytope that holds all points nearer to the polygon than `radius_m` >
/// 0, or at this distance. `corners`: convex and planar but for rounding, 1 or more, in order round it, in one place or
/// on a line too. The corners of the mesh are rounded outwards. Cost: linear.
Mesh grow_polygon(std::span<const Vec3> corners, double radius_m);

/// As grow_polygon, of those points alone whose foot in the polygon's plane is in the polygon or no farther aside from
/// it than `aside_m`, at most kMostAside of the radius: a prism. It reaches no farther out than grow_polygon.
Mesh grow_across(std::span<const Vec3> corners, double radius_m, double aside_m);
constexpr double kMostAside = 0.4;

}  // namespace vantage::internal::core
