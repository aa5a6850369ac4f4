#include "exact/node_planes.h"

#include <algorithm>
#include <limits>

#include "exact/numerics.h"

namespace vantage::exact {

NodePlanes::NodePlanes(const LocalTarget& target, const TargetFrame& frame) {
  const std::size_t edges = target.edges.size(), used = std::min(edges, kMostEdges);
  for (std::size_t i = 0; i < used; ++i) edges_.push_back(target.edges[i * edges / used]);
  for (int a = 0; a < 3; ++a) {
    axes_[a] = {frame.axis_u[a], frame.axis_v[a], frame.normal[a]};
    target_low_[a] = std::numeric_limits<double>::infinity();
    target_high_[a] = -target_low_[a];
    for (const auto& t : target.vertices) {
      const double h = axes_[a].x() * t.x() + axes_[a].y() * t.y();
      target_low_[a] = std::min(target_low_[a], h);
      target_high_[a] = std::max(target_high_[a], h);
    }
  }
}

void NodePlanes::add(const Vec3& normal, double height) {
  if (height > numerics::kOnPlane) planes_[count_++] = normal / height;
}

bool NodePlanes::set(const scene::Bounds& bounds, const Vec3& centre) {
  count_ = 0;
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i].setZero();
    for (int a = 0; a < 3; ++a) corners[i] += axes_[a] * ((i >> a & 1 ? bounds.max[a] : bounds.min[a]) - centre[a]);
  }
  double lowest = corners[0].z(), highest = lowest;
  for (const Vec3& c : corners) lowest = std::min(lowest, c.z()), highest = std::max(highest, c.z());
  if (highest <= numerics::kOnPlane) return false;
  add({0, 0, 1}, lowest);
  for (int a = 0; a < 3; ++a) {
    const double low = bounds.min[a] - centre[a], high = bounds.max[a] - centre[a];
    if (low >= target_high_[a]) add(axes_[a], low);
    if (high <= target_low_[a]) add(-axes_[a], -high);
  }
  for (const LocalTarget::Edge& edge : edges_) {
    double slope = -std::numeric_limits<double>::infinity(), nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& c : corners) {
      const double outside = edge.outward.dot(c.head<2>()) - edge.distance;
      nearest = std::min(nearest, outside);
      if (c.z() > 0) slope = std::max(slope, -outside / c.z());
    }
    // A box that reaches below the target's plane inside the edge can only be separated from the target by that plane.
    if (lowest <= 0 && nearest < 0) continue;
    add({edge.outward.x(), edge.outward.y(), slope}, edge.distance);
  }
  return true;
}

}  // namespace vantage::exact
