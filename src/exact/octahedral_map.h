// The octahedral map of viewing directions: the upper half of the octahedron |x| + |y| + |z| = 1, seen from above.
//
// A direction d with z >= 0 is the point (x, y) / (|x| + |y| + z) of the diamond |a| + |b| <= 1. In each quadrant the
// map is projective, so straight lines stay straight and a plane's inverse depth g . d is linear in (a, b) when d is
// scaled to |x| + |y| + z = 1. The whole hemisphere is one bounded domain; only the axes a = 0 and b = 0 are creases of
// the map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "vantage/geometry.h"

namespace vantage::internal::exact {

using OctahedralPoint = Eigen::Vector2d;

inline OctahedralPoint to_octahedral(const Vec3& direction) {
  return direction.head<2>() / (std::abs(direction.x()) + std::abs(direction.y()) + direction.z());
}

/// The direction with |x| + |y| + z = 1. Heights that rounding leaves below zero are zero.
inline Vec3 to_direction(const OctahedralPoint& p) {
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

/// A linear function at the corners of a cell.
using CellCorners = std::array<double, 4>;

/// A square of a quadrant, [a, a + size] x [b, b + size] in |a|, |b|; when it straddles the horizon |a| + |b| = 1, the
/// half of it that is above.
struct OctahedralCell {
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
  CellCorners at_corners(const QuadrantLinear& f) const {
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

/// Whether `low` is at most `high` all over a cell, to rounding. Without branches: which corner decides is a matter of
/// luck.
inline bool below(const CellCorners& low, const CellCorners& high) {
  constexpr double kRounding = 1 + 1e-13;
#ifdef __SSE2__
  const __m128d scale = _mm_set1_pd(kRounding);
  const __m128d first = _mm_cmple_pd(_mm_loadu_pd(low.data()), _mm_mul_pd(_mm_loadu_pd(high.data()), scale));
  const __m128d last = _mm_cmple_pd(_mm_loadu_pd(low.data() + 2), _mm_mul_pd(_mm_loadu_pd(high.data() + 2), scale));
  return _mm_movemask_pd(_mm_and_pd(first, last)) == 3;
#else
  return low[0] <= high[0] * kRounding && low[1] <= high[1] * kRounding && low[2] <= high[2] * kRounding &&
         low[3] <= high[3] * kRounding;
#endif
}

}  // namespace vantage::internal::exact
