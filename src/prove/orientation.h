// On which side of a plane a point lies, exactly.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// The sign of the determinant of (a - d, b - d, c - d), of the numbers as they are: 1 where a, b and c run clockwise
/// as seen from d's side, 0 where all four lie in one plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace vantage::internal::prove
