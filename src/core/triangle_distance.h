// How far a point is from a triangle.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// Square of the distance from `point` to the nearest point of the closed triangle abc, which may have no area.
double squared_distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace vantage::internal::core
