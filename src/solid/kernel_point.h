// A point from which all of a surface is seen from within.
#pragma once

#include <optional>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// The half-space behind it: normal · x <= at. The normal has length 1.
struct HalfSpace {
  Vec3 normal;
  double at;
};

/// A point of the box that lies at least `margin` inside of every half-space; nothing where there is none, or where
/// rounding leaves a doubt. By R. Seidel, "Small-dimensional linear programming and convex hulls made easy" (1991):
/// expected time linear in the half-spaces. The same input gives the same point.
std::optional<Vec3> kernel_point(const std::vector<HalfSpace>& half_spaces, const Box& box, double margin);

}  // namespace vantage::internal::solid
