#include "query/obstacle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/triangle_distance.h"
#include "core/walk_bvh.h"

namespace vantage::internal::query {
namespace {

/// Where the line comes to the distance `radius` from a point.
void add_ball(const Vec3& to_centre, const Vec3& direction, double radius, std::vector<double>& out) {
  const double middle = direction.dot(to_centre);
  const double half_squared = radius * radius - (to_centre - middle * direction).squaredNorm();
  if (half_squared < 0) return;
  out.push_back(middle - std::sqrt(half_squared));
  out.push_back(middle + std::sqrt(half_squared));
}

/// And from the line through two points.
void add_cylinder(const Vec3& to_a, const Vec3& side, const Vec3& direction, double radius, std::vector<double>& out) {
  const double length = side.norm();
  if (!(length > 0)) return;
  const Vec3 axis = side / length;
  const Vec3 across = direction - axis.dot(direction) * axis, from = to_a - axis.dot(to_a) * axis;
  const double slope = across.squaredNorm();
  if (!(slope > 0)) return;
  const double middle = across.dot(from) / slope;
  const double half_squared = (radius * radius - (from - middle * across).squaredNorm()) / slope;
  if (half_squared < 0) return;
  out.push_back(middle - std::sqrt(half_squared));
  out.push_back(middle + std::sqrt(half_squared));
}

/// Whether the line from 0 to `reach` meets the box; too often rather than too seldom.
bool meets(const core::Bounds& box, const Vec3& origin, const Vec3& direction, double reach) {
  constexpr double kRounding = 1e-9;
  double begin = 0, finish = reach;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - origin[axis], high = box.max[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const auto [near, far] = std::minmax({low / direction[axis], high / direction[axis]});
    begin = std::max(begin, near);
    finish = std::min(finish, far);
  }
  return begin <= finish + kRounding * reach;
}

}  // namespace

ObstacleDistance::ObstacleDistance(const Clearance& clearance) : clearance_(clearance) {
  const Mesh& mesh = *clearance_.obstacles;
  std::vector<core::Bounds> bounds(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Box box;
    for (const std::uint32_t vertex : mesh.triangles[t]) box.extend(mesh.vertices[vertex]);
    for (unsigned axis = 0; axis < 3; ++axis) {
      bounds[t].min[axis] = std::nextafterf(static_cast<float>(box.min[axis] - clearance_.distance_m), -INFINITY);
      bounds[t].max[axis] = std::nextafterf(static_cast<float>(box.max[axis] + clearance_.distance_m), INFINITY);
    }
  }
  bvh_ = core::build_bvh(bounds, triangles_);
}

std::array<Vec3, 3> ObstacleDistance::corners(std::uint32_t item) const {
  const Mesh& mesh = *clearance_.obstacles;
  const auto& [a, b, c] = mesh.triangles[triangles_[item]];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

bool ObstacleDistance::is_too_near(const Vec3& point) const {
  const auto holds = [&](const core::BvhNode& node) {
    const auto& [min, max] = node.bounds;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (point[axis] < min[axis] || point[axis] > max[axis]) return false;
    }
    return true;
  };
  const double squared = clearance_.distance_m * clearance_.distance_m;
  return !core::walk_bvh(bvh_, holds, [&](std::uint32_t item) {
    const auto [a, b, c] = corners(item);
    return core::squared_distance_to_triangle(point, a, b, c) >= squared;
  });
}

// What is near a triangle is the union of balls about its corners, cylinders about its sides, and a slab.
void ObstacleDistance::add_crossings(const Vec3& origin, const Vec3& direction, double reach,
                                     std::vector<double>& out) const {
  const double radius = clearance_.distance_m;
  const auto enter = [&](const core::BvhNode& node) { return meets(node.bounds, origin, direction, reach); };
  core::walk_bvh(bvh_, enter, [&](std::uint32_t item) {
    const std::array<Vec3, 3> at = corners(item);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 to_corner = at[k] - origin;
      add_ball(to_corner, direction, radius, out);
      add_cylinder(to_corner, at[(k + 1) % 3] - at[k], direction, radius, out);
    }
    const Vec3 normal = (at[1] - at[0]).cross(at[2] - at[0]);
    const double slope = normal.dot(direction), height = normal.dot(at[0] - origin), length = normal.norm();
    if (slope == 0) return;
    out.push_back((height - radius * length) / slope);
    out.push_back((height + radius * length) / slope);
  });
}

}  // namespace vantage::internal::query
