// Distances of points from triangles and polygons.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

inline double squared_distance_from_side(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = point - a;
  const double length = ab.squaredNorm();
  const double part = length > 0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0;
  return (ap - part * ab).squaredNorm();
}

/// From all of a convex polygon, to a few roundings of the coordinates. Of one that is so narrow that rounding turns
/// its normal, from its outline at most.
template <typename Corners>
double distance_from_polygon(const Vec3& point, const Corners& corners) {
  const std::size_t n = corners.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    nearest = std::min(nearest, squared_distance_from_side(point, corners[i], corners[(i + 1) % n]));
  }
  if (n < 3) return std::sqrt(nearest);
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 2; i < n; ++i) normal += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  const double length = normal.norm();
  if (!(length > 0)) return std::sqrt(nearest);
  normal /= length;
  bool is_over = true;
  for (std::size_t i = 0; is_over && i < n; ++i) {
    is_over = normal.dot((corners[(i + 1) % n] - corners[i]).cross(point - corners[i])) >= 0;
  }
  return is_over ? std::min(std::abs(normal.dot(point - corners[0])), std::sqrt(nearest)) : std::sqrt(nearest);
}

inline double distance_from(const Vec3& point, const std::array<Vec3, 3>& corners) {
  return distance_from_polygon(point, corners);
}

/// Whether `holds` is true at a point of a convex polygon's outline, or in its middle. `better` is larger, along a
/// side, the more likely that is, and has one peak.
template <typename Holds, typename Better>
bool any_point_of(const std::vector<Vec3>& corners, const Holds& holds, const Better& better) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  if (holds(middle)) return true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    double low = 0, high = 1;
    for (int step = 0; step < 60; ++step) {
      const double first = low + (high - low) / 3, second = high - (high - low) / 3;
      if (better(a + first * (b - a)) < better(a + second * (b - a))) {
        low = first;
      } else {
        high = second;
      }
    }
    if (holds(a) || holds(a + (low + high) / 2 * (b - a))) return true;
  }
  return false;
}

}  // namespace vantage::internal::prove
