// Smallest enclosing circle and centroid of a convex polygon.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace vantage::internal::core {

struct Circle {
  Eigen::Vector2d centre;
  double radius;
};

/// Smallest circle that holds all points (Welzl 1991, iterative form). At least one point. Cost: O(n^3) at worst, n
/// <= 64.
Circle smallest_enclosing_circle(const std::vector<Eigen::Vector2d>& points);

/// Centroid of the area of a counter-clockwise polygon that has one.
Eigen::Vector2d centroid(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace vantage::internal::core
