#include "core/enclosing_circle.h"

#include <cmath>

namespace vantage::internal::core {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Circle through(const Vector2d& a, const Vector2d& b) { return {0.5 * (a + b), 0.5 * (a - b).norm()}; }

Circle through(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a, ac = c - a;
  const double d = 2 * cross(ab, ac);
  const Vector2d offset = Vector2d(ac.y() * ab.squaredNorm() - ab.y() * ac.squaredNorm(),
                                   ab.x() * ac.squaredNorm() - ac.x() * ab.squaredNorm()) /
                          d;
  return {a + offset, offset.norm()};
}

bool holds(const Circle& circle, const Vector2d& p) {
  return (p - circle.centre).norm() <= circle.radius * (1 + 1e-12);
}

}  // namespace

Circle smallest_enclosing_circle(const std::vector<Vector2d>& points) {
  Circle circle{points[0], 0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (holds(circle, points[i])) continue;
    circle = {points[i], 0};
    for (std::size_t j = 0; j < i; ++j) {
      if (holds(circle, points[j])) continue;
      circle = through(points[i], points[j]);
      for (std::size_t k = 0; k < j; ++k)
        if (!holds(circle, points[k])) circle = through(points[i], points[j], points[k]);
    }
  }
  return circle;
}

Vector2d centroid(const std::vector<Vector2d>& polygon) {
  double area = 0;
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector2d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    const double w = cross(a, b);
    area += w;
    sum += w * (a + b) / 3;
  }
  return polygon[0] + sum / area;
}

}  // namespace vantage::internal::core
