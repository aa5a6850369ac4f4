// How long a detour is: the point of a plane, a line or a triangle with the shortest way from a to it and on to b, and
// bounds of it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

/// By how much at least a detour by a point at this distance from a leg of this length is longer than the leg.
inline double least_detour(double distance, double leg) {
  const double half = 0.5 * leg;
  return 2 * (std::sqrt(distance * distance + half * half) - half);
}

inline double distance_to_leg(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double squared = along.squaredNorm();
  const double place = squared > 0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (from + place * along - point).norm();
}

/// Where the way from a to b is shortest that touches a flat: `pa` and `pb` are their projections on it, `ha` and `hb`
/// their distances from it. Turned about the flat into one plane, on two sides of it, the way is straight (Heron).
inline Vec3 shortest_on_flat(const Vec3& pa, double ha, const Vec3& pb, double hb) {
  const double sum = ha + hb;
  if (!(sum > 0)) return (pa + pb) / 2;
  return (hb * pa + ha * pb) / sum;
}

/// |a - x| + |x - b|, with corners off by `smoothing`.
inline double way_length(const Vec3& a, const Vec3& x, const Vec3& b, double smoothing) {
  const double s = smoothing * smoothing;
  return std::sqrt((a - x).squaredNorm() + s) + std::sqrt((x - b).squaredNorm() + s);
}

/// The least one of the segment pq.
inline Vec3 shortest_on_segment(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, double smoothing) {
  const Vec3 along = q - p;
  const double length = along.norm();
  if (!(length > 0)) return p;
  const Vec3 unit = along / length;
  const double ta = unit.dot(a - p), tb = unit.dot(b - p);
  const double ha = std::hypot((a - p - ta * unit).norm(), smoothing);
  const double hb = std::hypot((b - p - tb * unit).norm(), smoothing);
  const double t = ha + hb > 0 ? (hb * ta + ha * tb) / (ha + hb) : (ta + tb) / 2;
  return t <= 0 ? p : t >= length ? q : Vec3(p + t * unit);
}

/// The least one of a closed triangle: that of its plane, if it lies in it, else of its sides, as the length is convex.
inline Vec3 shortest_on_triangle(const std::array<Vec3, 3>& t, const Vec3& a, const Vec3& b, double smoothing) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.norm();
  if (area > 0) {
    const Vec3 unit = normal / area;
    const double da = unit.dot(a - t[0]), db = unit.dot(b - t[0]);
    Vec3 x = shortest_on_flat(a - da * unit, std::hypot(da, smoothing), b - db * unit, std::hypot(db, smoothing));
    const auto is_left = [&](int i) { return normal.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) >= 0; };
    if (is_left(0) && is_left(1) && is_left(2)) return x;
  }
  Vec3 best = t[0];
  double least = way_length(a, best, b, smoothing);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 x = shortest_on_segment(t[i], t[(i + 1) % 3], a, b, smoothing);
    const double length = way_length(a, x, b, smoothing);
    if (length >= least) continue;
    least = length;
    best = x;
  }
  return best;
}

}  // namespace vantage::internal::flight::tour
