// Adaptive predicates (Shewchuk 1997), by William C. Lenthe: they come with CDT.
#include "core/orientation.h"

#include <CDT.h>

namespace vantage::internal::core {

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double sign = predicates::orient3d(a.data(), b.data(), c.data(), d.data());
  return (sign > 0) - (sign < 0);
}

int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double sign = predicates::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
  return (sign > 0) - (sign < 0);
}

}  // namespace vantage::internal::core
