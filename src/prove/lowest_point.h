// Where the largest of linear functions of two variables is smallest.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

namespace vantage::internal::prove {

/// A linear function of two variables.
struct Plane2 {
  double value = 0;  ///< at zero
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  double at(const Eigen::Vector2d& place) const { return value + slope.dot(place); }
};

inline double highest(std::span<const Plane2> planes, const Eigen::Vector2d& place) {
  double most = planes.front().at(place);
  for (const Plane2& plane : planes) most = std::max(most, plane.at(place));
  return most;
}

/// A place in the box where the highest of the planes is lowest, but for rounding. `planes`: at least one; `min` <=
/// `max`. Cutting planes (Kelley 1960), of which only those are kept that hold the place up.
Eigen::Vector2d lowest_point(std::span<const Plane2> planes, const Eigen::Vector2d& min, const Eigen::Vector2d& max);

}  // namespace vantage::internal::prove
