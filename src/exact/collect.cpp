#include "exact/collect.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>

#include "exact/numerics.h"
#include "vantage/error.h"

namespace vantage::exact {
namespace {

struct Entry {
  double distance;
  std::uint32_t node;
  bool operator<(const Entry& other) const {  // the queue serves the nearest first
    if (distance != other.distance) return distance > other.distance;
    return node > other.node;
  }
};

double distance_to(const scene::Bounds& bounds, const Vec3& point) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({0.0, bounds.min[a] - point[a], point[a] - bounds.max[a]});
    sum += d * d;
  }
  return std::sqrt(sum);
}

void check_cancelled(const Progress& progress) {
  if (progress && !progress("finding blockers", 0.0))
    throw Error(ErrorKind::cancelled, "cancelled while finding blockers", "", "");
}

}  // namespace

void local_polygon(const PreparedScene::Data& scene, const TargetFrame& frame, std::uint32_t polygon,
                   std::vector<Vec3>& corners) {
  const Vec3 centre = frame.origin - scene.origin;
  corners.clear();
  for (std::uint32_t k = scene.first_vertex[polygon]; k < scene.first_vertex[polygon + 1]; ++k) {
    const Vec3 d = scene.vertices[scene.polygon_vertices[k]] - centre;
    corners.emplace_back(frame.axis_u.dot(d), frame.axis_v.dot(d), frame.normal.dot(d));
  }
}

void collect_blockers(const PreparedScene::Data& scene, const TargetFrame& frame, const LocalTarget& target,
                      const RangeRegion& range, BlockerSet& blockers, DirectionTree& tree, const Progress& progress) {
  if (scene.bvh.nodes.empty()) return;
  const Vec3 centre = frame.origin - scene.origin;
  const double reach = std::max(range.radius(), target.radius);  // a segment from the region to the target stays within
  // The scene's axes in the target's frame.
  std::array<Vec3, 3> axes;
  for (int a = 0; a < 3; ++a) axes[a] = {frame.axis_u[a], frame.axis_v[a], frame.normal[a]};
  BlockerBuilder builder(target);
  std::vector<Vec3> corners;
  std::priority_queue<Entry> queue;
  const auto push = [&](std::uint32_t node) {
    const double distance = distance_to(scene.bvh.nodes[node].bounds, centre);
    if (distance <= reach) queue.push({distance, node});
  };
  push(0);
  std::size_t steps = 0;
  while (!queue.empty()) {
    const scene::BvhNode& node = scene.bvh.nodes[queue.top().node];
    queue.pop();
    if (++steps % 1024 == 0) check_cancelled(progress);
    Vec3 middle = Vec3::Zero();
    std::array<Vec3, 3> half;
    double above = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = node.bounds.min[a] - centre[a], high = node.bounds.max[a] - centre[a];
      middle += axes[a] * (0.5 * (low + high));
      half[a] = axes[a] * (0.5 * (high - low));
      above += std::abs(half[a].z());
    }
    if (middle.z() + above <= numerics::kOnPlane) continue;  // behind the target
    if (tree.hides_box(middle, half)) continue;
    if (!node.leaf()) {
      push(node.first);
      push(node.first + 1);
      continue;
    }
    for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) {
      local_polygon(scene, frame, polygon, corners);
      if (tree.hides_hull(corners)) continue;
      if (!builder.build(corners, blockers.planes, blockers.corners)) continue;
      blockers.close(polygon);
      if (!tree.insert(std::uint32_t(blockers.count() - 1))) blockers.drop_last();
    }
  }
}

}  // namespace vantage::exact
