// Adaptive predicates (Shewchuk 1997), by William C. Lenthe: they come with CDT.
#include "prove/orientation.h"

#include <CDT.h>

namespace vantage::internal::prove {

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double sign = predicates::orient3d(a.data(), b.data(), c.data(), d.data());
  return (sign > 0) - (sign < 0);
}

int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double sign = predicates::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
  return (sign > 0) - (sign < 0);
}

bool passes_through(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  if (orientation(a, b, c, from) * orientation(a, b, c, to) >= 0) return false;
  const int first = orientation(from, to, a, b);
  return first != 0 && orientation(from, to, b, c) == first && orientation(from, to, c, a) == first;
}

bool are_on_a_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    if (predicates::orient2d(a[x], a[y], b[x], b[y], c[x], c[y]) != 0) return false;
  }
  return true;
}

}  // namespace vantage::internal::prove
