// Questions about points that are answered exactly, of the numbers as they are.
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace vantage::internal::simplify {

using Corners = std::array<Vec3, 3>;

/// 1 where `point` is on the inner side of the facet's plane, from which its corners run clockwise; -1 on the outer
/// side, 0 in the plane.
int side_of(const Corners& facet, const Vec3& point);

/// Whether the two, with their ends and borders, have a point in common. The triangle must have an area.
bool meet(const Vec3& start, const Vec3& end, const Corners& triangle);

/// Whether two triangles with a common side, from `start` to `end`, lie in one plane and on the same side of it.
bool is_folded(const Vec3& start, const Vec3& end, const Vec3& third, const Vec3& other_third);

}  // namespace vantage::internal::simplify
