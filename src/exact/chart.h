// The chart of viewing directions: the upper half of the octahedron |x| + |y| + |z| = 1, seen from above.
//
// A direction d with z >= 0 is the point (x, y) / (|x| + |y| + z) of the diamond |a| + |b| <= 1. In each quadrant the
// map is projective, so straight lines stay straight and a plane's inverse depth g . d is linear in (a, b) when d is
// scaled to |x| + |y| + z = 1. The whole hemisphere is one bounded domain; only the axes a = 0 and b = 0 are creases of
// the map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "vantage/geometry.h"

namespace vantage::exact {

using ChartPoint = Eigen::Vector2d;

inline ChartPoint to_chart(const Vec3& direction) {
  return direction.head<2>() / (std::abs(direction.x()) + std::abs(direction.y()) + direction.z());
}

/// The direction with |x| + |y| + z = 1. Heights that rounding leaves below zero are zero.
inline Vec3 to_direction(const ChartPoint& p) {
  return {p.x(), p.y(), std::max(0.0, 1 - std::abs(p.x()) - std::abs(p.y()))};
}

/// A function that is linear on one quadrant: constant + slope_a |a| + slope_b |b|.
struct QuadrantLinear {
  double constant, slope_a, slope_b;
};

inline int quadrant_of(double x, double y) { return (x < 0 ? 1 : 0) + (y < 0 ? 2 : 0); }

/// Inverse depth of a plane on a quadrant (bit 0: a < 0, bit 1: b < 0).
inline QuadrantLinear on_quadrant(const Vec3& plane, int quadrant) {
  const double x = quadrant & 1 ? -plane.x() : plane.x(), y = quadrant & 2 ? -plane.y() : plane.y();
  return {plane.z(), x - plane.z(), y - plane.z()};
}

/// A square of a quadrant, [a, a + size] x [b, b + size] in |a|, |b|; when it straddles the horizon |a| + |b| = 1, the
/// half of it that is above.
struct ChartCell {
  int quadrant;
  double a, b, size;
  bool at_horizon() const { return a + b + size >= 1; }  // exact: cells are dyadic

  double max_of(const QuadrantLinear& f) const {
    const double corner = f.constant + f.slope_a * a + f.slope_b * b;
    const double da = f.slope_a * size, db = f.slope_b * size;
    return at_horizon() ? corner + std::max(0.0, std::max(da, db)) : corner + std::max(0.0, da) + std::max(0.0, db);
  }
  double min_of(const QuadrantLinear& f) const {
    const double corner = f.constant + f.slope_a * a + f.slope_b * b;
    const double da = f.slope_a * size, db = f.slope_b * size;
    return at_horizon() ? corner + std::min(0.0, std::min(da, db)) : corner + std::min(0.0, da) + std::min(0.0, db);
  }
  /// Values at the corners; a half square has its first corner twice.
  std::array<double, 4> at_corners(const QuadrantLinear& f) const {
    const double corner = f.constant + f.slope_a * a + f.slope_b * b;
    const double da = f.slope_a * size, db = f.slope_b * size;
    return {corner, corner + da, corner + db, at_horizon() ? corner : corner + da + db};
  }
  Vec3 centre_direction() const {
    const double shift = at_horizon() ? size / 3 : size / 2;
    const double x = a + shift, y = b + shift;
    return {quadrant & 1 ? -x : x, quadrant & 2 ? -y : y, std::max(0.0, 1 - x - y)};
  }
};

}  // namespace vantage::exact
