#include "support/plain_union.h"

#include <manifold/manifold.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>
#include <vector>

#include "vantage/progress.h"

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
manifold::Manifold convex_hull(const std::vector<Vec3>& points) {
  std::vector<manifold::vec3> positions;
  positions.reserve(points.size());
  for (const Vec3& p : points) positions.emplace_back(p.x(), p.y(), p.z());
  return manifold::Manifold::Hull(positions);
}

manifold::Manifold solid_of(const Mesh& mesh) {
  manifold::MeshGL64 gl;
  for (const Vec3& v : mesh.vertices) gl.vertProperties.insert(gl.vertProperties.end(), {v.x(), v.y(), v.z()});
  for (const Triangle& t : mesh.triangles) gl.triVerts.insert(gl.triVerts.end(), {t[0], t[1], t[2]});
  return manifold::Manifold(gl);
}

/// Manifold evaluates lazily: here, on another thread, while this one asks. Whether it came to an end.
bool is_evaluated(const manifold::Manifold& lazy, int threads, const std::function<bool()>& goes_on) {
  manifold::ExecutionContext context;
  const manifold::Manifold watched = lazy.WithContext(context);
  std::future<void> work =
      std::async(std::launch::async, [&] { with_threads(threads, [&] { (void)watched.Status(); }); });
  while (work.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready)
    if (!goes_on()) context.Cancel();
  return lazy.Status() == manifold::Manifold::Error::NoError;
}

}  // namespace

// A polygon O hides { o + l (o - t) } for all o of it, t of the target and l >= 0, which is convex. What has l <= s is
// the hull of the corners o and (1 + s) o - s t, and l <= s holds within the range when (1 + s) is at least the range
// over the least distance of O from the target.
PlainVolume plain_visibility(const Scene& scene, const TargetFrame& frame, const Mesh& region, double max_range,
                             int threads, const std::function<bool()>& goes_on) {
  double radius = 0;
  for (const Eigen::Vector2d& t : frame.polygon) radius = std::max(radius, t.norm());
  constexpr double kNearest = 0.1;  // metres; keeps the hull of what comes closer finite
  std::vector<manifold::Manifold> blockers;
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
    const manifold::Manifold blocker = convex_hull(corners);
    if (!blocker.IsEmpty()) blockers.push_back(blocker);
  }
  const manifold::Manifold result =
      solid_of(region) - manifold::Manifold::BatchBoolean(blockers, manifold::OpType::Add);
  if (!is_evaluated(result, threads, goes_on)) return {};
  return {result.NumTri(), result.Volume(), true};
}

}  // namespace vantage::bench
