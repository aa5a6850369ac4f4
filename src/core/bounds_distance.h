// How far a point is from a box of a hierarchy.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// 0 inside, as is the distance.
inline double squared_distance_to(const Bounds& bounds, const Vec3& point) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({0.0, bounds.min[a] - point[a], point[a] - bounds.max[a]});
    sum += d * d;
  }
  return sum;
}

inline double distance_to(const Bounds& bounds, const Vec3& point) {
  return std::sqrt(squared_distance_to(bounds, point));
}

}  // namespace vantage::internal::core
