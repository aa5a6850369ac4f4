#include "scene/triangle_index.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/walk_bvh.h"

namespace vantage::internal::scene {
namespace {

// Along no street: a ray that runs through an edge counts twice or not at all. Most of seven do not. The first ones are
// steep: slopes round a valley are met by the level ones alone.
constexpr std::size_t kSteep = 3;
const std::array<Vec3, 7>& ray_directions() {
  static const std::array<Vec3, 7> kDirections = {
      Vec3(0.0123, 0.0345, 1),  Vec3(0.1347, -0.0791, 1),  Vec3(-0.0913, 0.1171, 1), Vec3(1, 0.2371, 0.0611),
      Vec3(-0.2713, 1, 0.0817), Vec3(-1, -0.3119, 0.0713), Vec3(0.3307, -1, 0.0917)};
  return kDirections;
}

bool overlap(const core::Bounds& a, const core::Bounds& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.min[axis] > b.max[axis] || a.max[axis] < b.min[axis]) return false;
  }
  return true;
}

/// Whether a ray, from its origin on, meets a box.
bool meets_ray(const core::Bounds& box, const Vec3& from, const Vec3& direction) {
  double enter = 0, leave = INFINITY;
  for (int a = 0; a < 3; ++a) {
    const double low = box.min[a] - from[a], high = box.max[a] - from[a];
    if (direction[a] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double first = low / direction[a], second = high / direction[a];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter <= leave;
}

/// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997).
bool meets_ray(const TriangleCorners& c, const Vec3& from, const Vec3& direction) {
  const Vec3 ab = c[1] - c[0], ac = c[2] - c[0], across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0) return false;
  const Vec3 offset = from - c[0];
  const double u = offset.dot(across) / determinant;
  if (u < 0 || u > 1) return false;
  const Vec3 turned = offset.cross(ab);
  const double v = direction.dot(turned) / determinant;
  if (v < 0 || u + v > 1) return false;
  return ac.dot(turned) / determinant > 0;
}

}  // namespace

TriangleIndex::TriangleIndex(const Scene& scene) : scene_(scene) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const core::Bounds nothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  objects_.assign(std::max<std::size_t>(1, scene.objects.size()), nothing);
  std::vector<core::Bounds> bounds(scene.mesh.triangles.size());
  for (std::uint32_t i = 0; i < bounds.size(); ++i) {
    core::Bounds& object = objects_[object_of(i)];
    Box box;
    for (const Vec3& corner : corners(i)) box.extend(corner);
    for (int a = 0; a < 3; ++a) {
      bounds[i].min[a] = std::nextafterf(static_cast<float>(box.min[a]), -INFINITY);
      bounds[i].max[a] = std::nextafterf(static_cast<float>(box.max[a]), INFINITY);
      object.min[a] = std::min(object.min[a], bounds[i].min[a]);
      object.max[a] = std::max(object.max[a], bounds[i].max[a]);
    }
  }
  bvh_ = core::build_bvh(bounds, order_);
}

TriangleCorners TriangleIndex::corners(std::uint32_t triangle) const {
  const Triangle& t = scene_.mesh.triangles[triangle];
  return {scene_.mesh.vertices[t[0]], scene_.mesh.vertices[t[1]], scene_.mesh.vertices[t[2]]};
}

void TriangleIndex::near(const Box& box, const std::function<void(std::uint32_t)>& visit) const {
  core::walk_bvh(
      bvh_,
      [&](const core::BvhNode& node) {
        for (int a = 0; a < 3; ++a) {
          if (node.bounds.min[a] > box.max[a] || node.bounds.max[a] < box.min[a]) return false;
        }
        return true;
      },
      [&](std::uint32_t item) { visit(order_[item]); });
}

int TriangleIndex::crossings(const Vec3& from, const Vec3& direction, std::uint32_t object) const {
  int count = 0;
  core::walk_bvh(
      bvh_,
      [&](const core::BvhNode& node) {
        return overlap(node.bounds, objects_[object]) && meets_ray(node.bounds, from, direction);
      },
      [&](std::uint32_t item) {
        const std::uint32_t triangle = order_[item];
        if (object_of(triangle) == object) count += meets_ray(corners(triangle), from, direction);
      });
  return count;
}

Side TriangleIndex::side_of(const Vec3& place, std::uint32_t object) const {
  const auto& directions = ray_directions();
  std::array<int, 2> odd{};  // of the steep rays, and of the level ones
  for (std::size_t i = 0; i < directions.size(); ++i) {
    odd[i < kSteep ? 0 : 1] += crossings(place, directions[i], object) % 2;
  }
  return odd[0] >= 2 && odd[1] >= 2 ? Side::inside : Side::outside;
}

}  // namespace vantage::internal::scene
