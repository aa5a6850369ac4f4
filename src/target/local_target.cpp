#include "target/local_target.h"

#include <algorithm>

namespace vantage::internal::target {

using Eigen::Vector2d;

LocalTarget make_local_target(const std::vector<Vector2d>& polygon, double slack, double rounding) {
  LocalTarget target;
  target.vertices = polygon;
  target.slack = slack;
  target.rounding = rounding;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d along = (polygon[(i + 1) % polygon.size()] - a).normalized();
    const Vector2d outward(along.y(), -along.x());
    target.edges.push_back({outward, outward.dot(a)});
    target.radius = std::max(target.radius, a.norm());
    target.clearance = std::min(target.clearance, target.edges.back().distance);
  }
  return target;
}

void local_polygon(const PreparedScene::Data& scene, const TargetFrame& frame, std::uint32_t polygon,
                   std::vector<Vec3>& corners) {
  const Vec3 centre = frame.origin - scene.origin;
  corners.clear();
  for (std::uint32_t k = scene.first_vertex[polygon]; k < scene.first_vertex[polygon + 1]; ++k) {
    const Vec3 d = scene.vertices[scene.polygon_vertices[k]] - centre;
    corners.emplace_back(frame.axis_u.dot(d), frame.axis_v.dot(d), frame.normal.dot(d));
  }
}

}  // namespace vantage::internal::target
