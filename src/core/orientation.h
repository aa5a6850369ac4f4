// Where points lie, of the numbers as they are: no rounding decides.
#pragma once

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// 1 where `d` is on the side of the plane of a, b and c from which these run clockwise, -1 on the other one, 0 where
/// all four lie in one plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// In the plane: 1 where c lies left of the way from a to b, -1 right, 0 on the line.
int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace vantage::internal::core
