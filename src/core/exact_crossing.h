// Whether points lie in closed meshes, of the numbers as they are: no rounding decides.
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace vantage::internal::core {

using TriangleCorners = std::array<Vec3, 3>;

/// With its border, also of a triangle without an area.
bool is_on_triangle(const Vec3& point, const TriangleCorners& t);

/// What a ray straight up from a point that is not on the triangle adds to the winding number: 1 where it leaves the
/// solid there, -1 where it enters, else 0. The sum over a closed mesh is right, also where the ray meets edges.
int crossing_above(const Vec3& point, const TriangleCorners& t);

}  // namespace vantage::internal::core
