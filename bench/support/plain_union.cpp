#include "support/plain_union.h"

#include <manifold/manifold.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/internals.h"

namespace vantage::bench {
namespace {

std::vector<Vec3> clip_to_front(const std::array<Vec3, 3>& triangle) {
  std::vector<Vec3> polygon;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (a.z() >= 0) polygon.push_back(a);
    if ((a.z() < 0) == (b.z() < 0)) continue;
    Vec3 cut = a + a.z() / (a.z() - b.z()) * (b - a);
    cut.z() = 0;
    polygon.push_back(cut);
  }
  return polygon;
}

double distance_to_box(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  return box.min.cwiseMax(-box.max).cwiseMax(Vec3::Zero()).norm();
}

/// The convex hull of points; empty when they all lie in one plane.
solid::Solid convex_hull(const std::vector<Vec3>& points) {
  std::vector<manifold::vec3> positions;
  positions.reserve(points.size());
  for (const Vec3& p : points) positions.emplace_back(p.x(), p.y(), p.z());
  const manifold::MeshGL64 hull = manifold::Manifold::Hull(positions).GetMeshGL64();
  solid::LabelledMesh result;
  for (std::size_t i = 0; i < hull.NumVert(); ++i) {
    const manifold::vec3 p = hull.GetVertPos(i);
    result.mesh.vertices.emplace_back(p.x, p.y, p.z);
  }
  for (std::size_t i = 0; i < hull.NumTri(); ++i) {
    const auto t = hull.GetTriVerts(i);
    result.mesh.triangles.push_back(
        {static_cast<std::uint32_t>(t.x), static_cast<std::uint32_t>(t.y), static_cast<std::uint32_t>(t.z)});
  }
  result.labels.assign(result.mesh.triangles.size(), 0);
  return solid::Solid(result, "convex hull");
}

}  // namespace

// A polygon O hides { o + l (o - t) } for all o of it, t of the target and l >= 0, which is convex. What has l <= s is
// the hull of the corners o and (1 + s) o - s t, and l <= s holds within the range when (1 + s) is at least the range
// over the least distance of O from the target.
solid::Solid plain_visibility(const Scene& scene, const TargetFrame& frame, const solid::Solid& region,
                              double max_range, const core::ProgressReporter& progress) {
  double radius = 0;
  for (const Eigen::Vector2d& t : frame.polygon) radius = std::max(radius, t.norm());
  constexpr double kNearest = 0.1;  // metres; keeps the hull of what comes closer finite
  std::vector<solid::Solid> blockers;
  std::vector<Vec3> corners;
  for (const Triangle& t : scene.mesh.triangles) {
    std::array<Vec3, 3> triangle;
    for (int i = 0; i < 3; ++i) triangle[i] = frame.to_local(scene.mesh.vertices[t[i]]);
    const std::vector<Vec3> polygon = clip_to_front(triangle);
    if (polygon.size() < 3) continue;
    const double distance = distance_to_box(polygon);
    if (distance > max_range) continue;
    const double far = (max_range + 2 * radius) / std::max(distance - radius, kNearest);
    corners = polygon;
    for (const Vec3& o : polygon)
      for (const Eigen::Vector2d& v : frame.polygon) corners.push_back((1 + far) * o - far * Vec3(v.x(), v.y(), 0));
    solid::Solid blocker = convex_hull(corners);
    if (!blocker.empty()) blockers.push_back(std::move(blocker));
  }
  return solid::subtract(region, solid::unite(blockers, progress), progress);
}

}  // namespace vantage::bench
