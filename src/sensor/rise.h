// Uphill on the least of a few planes over two variables.
#pragma once

#include <Eigen/Core>
#include <span>

namespace vantage::internal::sensor {

/// A linear function of two variables.
struct Plane2 {
  double value = 0;  ///< at zero
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  double at(const Eigen::Vector2d& place) const { return value + slope.dot(place); }
};

struct Room {
  double reach = 0;                               ///< of each variable, to both sides of zero; > 0
  Eigen::Vector2d min = Eigen::Vector2d::Zero();  ///< <= 0; may be infinite
  Eigen::Vector2d max = Eigen::Vector2d::Zero();  ///< >= 0
};

/// Goes from zero along the steepest way up on the least of the planes, ridge after ridge, to the top or to the end of
/// the reach; along `min` and `max` it goes on. `planes`: at least one.
Eigen::Vector2d rise(std::span<const Plane2> planes, const Room& room);

}  // namespace vantage::internal::sensor
