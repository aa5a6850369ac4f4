// Surfaces inside of convex ones.
#pragma once

#include <functional>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// A closed mesh between points on the border of a convex set that holds the origin: it lies in the set. `reach`: of
/// the set in a direction of unit length; > 0. Sides lie farther in by no more than `share` of the distance, or are
/// shorter than 0.02 of it. Cost: in proportion to the facets, a few calls of `reach` for each; they grow as 1 / share,
/// and with the length of the edges that the set has.
Mesh star_inside(const std::function<double(const Vec3&)>& reach, double share);

}  // namespace vantage::internal::solid
