// A point of a target that a triangle hides, by extended precision. Shares nothing with the library but the target's
// frame.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::testing {

/// The middle of the triangle's shadow on the target, if the segment to it passes through the triangle. No value where
/// nothing is hidden, or too little to be told.
inline std::optional<Vec3> hidden_point(const Vec3& position, const std::array<Vec3, 3>& triangle,
                                        const TargetFrame& frame) {
  using Point = Eigen::Matrix<long double, 3, 1>;
  const auto local = [&](const Vec3& at) {
    const Point d = at.cast<long double>() - frame.origin.cast<long double>();
    return Point(frame.axis_u.cast<long double>().dot(d), frame.axis_v.cast<long double>().dot(d),
                 frame.normal.cast<long double>().dot(d));
  };
  const Point eye = local(position);
  std::vector<Point> left;
  for (const Vec3& corner : triangle) left.push_back(local(corner));
  const auto cut = [&](const auto& side_of) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Point &a = left[i], &b = left[(i + 1) % left.size()];
      const long double at_a = side_of(a), at_b = side_of(b);
      if (at_a >= 0) kept.push_back(a);
      if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    left = kept;
  };
  cut([](const Point& p) { return p.z(); });
  cut([&](const Point& p) { return eye.z() - p.z(); });
  const std::size_t n = frame.polygon.size();
  for (std::size_t i = 0; i < n && !left.empty(); ++i) {
    const Point a(frame.polygon[i].x(), frame.polygon[i].y(), 0);
    const Point b(frame.polygon[(i + 1) % n].x(), frame.polygon[(i + 1) % n].y(), 0);
    const Point inside = (b - eye).cross(a - eye);
    cut([&](const Point& p) { return inside.dot(p - eye); });
  }
  if (left.size() < 3) return std::nullopt;
  Point middle = Point::Zero();
  for (const Point& p : left) middle += p / static_cast<long double>(left.size());
  if (!(middle.z() > 0 && middle.z() < eye.z())) return std::nullopt;
  const Point at = eye + eye.z() / (eye.z() - middle.z()) * (middle - eye);
  const Point a = local(triangle[0]), b = local(triangle[1]), c = local(triangle[2]);
  const auto side = [&](const Point& p, const Point& q) { return (at - eye).dot((p - eye).cross(q - eye)); };
  const long double first = side(a, b), second = side(b, c), third = side(c, a);
  if (!((first > 0 && second > 0 && third > 0) || (first < 0 && second < 0 && third < 0))) return std::nullopt;
  return frame.to_scene(Vec3(static_cast<double>(at.x()), static_cast<double>(at.y()), 0));
}

/// Whether any triangle of the scene hides a point.
inline bool sees_less_than_all(const Scene& scene, const TargetFrame& frame, const Vec3& position) {
  const std::vector<Vec3>& v = scene.mesh.vertices;
  for (const auto& [a, b, c] : scene.mesh.triangles) {
    if (hidden_point(position, {v[a], v[b], v[c]}, frame)) return true;
  }
  return false;
}

}  // namespace vantage::testing
