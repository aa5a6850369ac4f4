#include "prove/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::prove {

View make_view(const Target& target, std::size_t part, double lift_m) {
  const TargetFrame frame = make_target_frame(target, part);
  View view;
  view.origin = frame.origin + lift_m * frame.normal;
  view.normal = frame.normal;
  view.all_sides = frame.all_sides;
  for (const Eigen::Vector2d& corner : frame.polygon) {
    view.whole.push_back(frame.axis_u * corner.x() + frame.axis_v * corner.y());
  }
  view.corners = view.whole;
  if (frame.polygon.size() < 3) return view;
  // vantage/volume.h says what numbers cannot tell.
  constexpr double kPart = 1e-9, kMost = 1e-9, kRoundings = 8;
  const double largest = view.origin.cwiseAbs().maxCoeff() + frame.enclosing_radius_m;
  view.margin_m = std::max(std::min(kPart * frame.enclosing_radius_m, kMost),
                           kRoundings * std::numeric_limits<double>::epsilon() * largest);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < frame.polygon.size(); ++i) {
    const Eigen::Vector2d &a = frame.polygon[i], &b = frame.polygon[(i + 1) % frame.polygon.size()];
    nearest = std::min(nearest, (a.x() * b.y() - a.y() * b.x()) / (b - a).norm());
  }
  const double kept = std::max(0.0, 1 - view.margin_m / nearest);
  for (Vec3& corner : view.corners) corner *= kept;
  return view;
}

SceneTree obstacles_in_front(const Scene& scene, const View& view, const Box& near) {
  std::vector<TreeTriangle> triangles;
  const double floor = view.all_sides ? -std::numeric_limits<double>::infinity() : view.margin_m;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> corners;
    Box box;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = scene.mesh.vertices[scene.mesh.triangles[t][k]] - view.origin;
      box.extend(corners[k]);
      const double height = view.normal.dot(corners[k]);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    if (high <= floor) continue;
    if ((box.min.array() > near.max.array()).any() || (box.max.array() < near.min.array()).any()) continue;
    if (low >= floor) {
      triangles.push_back({corners, t});
      continue;
    }
    // Cut at half the height, so that rounding leaves no less than what is above all of it.
    std::vector<Vec3> left;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      const double at_a = view.normal.dot(a) - floor / 2, at_b = view.normal.dot(b) - floor / 2;
      if (at_a >= 0) left.push_back(a);
      if ((at_a >= 0) != (at_b >= 0)) left.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    for (std::size_t k = 2; k < left.size(); ++k) triangles.push_back({{left[0], left[k - 1], left[k]}, t});
  }
  return make_tree(std::move(triangles));
}

}  // namespace vantage::internal::prove
