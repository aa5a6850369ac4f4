// Signs that are never wrong: points are taken as stored, to the last bit. Doubles with a bound first, then sums of
// doubles without rounding (Shewchuk, "Adaptive precision floating-point arithmetic", 1997).
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace attack {

using vantage::Vec3;
using Corners = std::array<Vec3, 3>;  ///< of a triangle

/// The side of the plane through a, b, c that d lies on: 1 where a, b, c run counter-clockwise seen from d, -1 on the
/// other side, 0 in the plane. Exact, as long as products of three coordinates neither overflow nor underflow.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Whether three points lie on one line. Exact.
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// The sign of |a - b| - length. Exact.
int compare_distance(const Vec3& a, const Vec3& b, double length);

}  // namespace attack
