#include "core/triangle_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/bounds_distance.h"
#include "core/exact_crossing.h"
#include "core/portable_math.h"
#include "core/triangle_distance.h"
#include "core/walk_bvh.h"

namespace vantage::internal::core {
namespace {

Bounds rounded_outward(const Box& box) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds bounds{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -kInfinity);
    bounds.max[axis] = std::nextafter(static_cast<float>(box.max[axis]), kInfinity);
  }
  return bounds;
}

bool ray_meets(const Bounds& box, const Vec3& point, const Vec3& inverse_direction) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double a = (box.min[axis] - point[axis]) * inverse_direction[axis];
    const double b = (box.max[axis] - point[axis]) * inverse_direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  // The allowance covers the rounding of the divisions; a box too many is only slower.
  return from <= to * (1 + 1e-12);
}

enum class Hit { miss, from_front, from_back, unclear };

/// A ray from the origin against a triangle by the signs of volumes, none of which may be lost in rounding.
Hit ray_hits(const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto side = [&](const Vec3& p, const Vec3& q) {
    const double volume = direction.dot(p.cross(q));
    const double error = 16 * std::numeric_limits<double>::epsilon() * p.norm() * q.norm();
    return volume > error ? 1 : volume < -error ? -1 : 0;
  };
  const int s0 = side(a, b), s1 = side(b, c), s2 = side(c, a);
  const bool some_left = s0 > 0 || s1 > 0 || s2 > 0, some_right = s0 < 0 || s1 < 0 || s2 < 0;
  if (some_left && some_right) return Hit::miss;
  if (s0 == 0 || s1 == 0 || s2 == 0) return Hit::unclear;
  // The line through the ray meets the triangle; the ray does when the triangle's plane lies ahead.
  const Vec3 normal = (b - a).cross(c - a);
  const double longest = std::max({a.norm(), b.norm(), c.norm()}), height = normal.dot(a);
  const double error = 32 * std::numeric_limits<double>::epsilon() * longest * longest * longest;
  const double ahead = height / normal.dot(direction);
  if (!(std::abs(height) > error) || !std::isfinite(ahead)) return Hit::unclear;
  if (ahead < 0) return Hit::miss;
  return normal.dot(direction) < 0 ? Hit::from_front : Hit::from_back;
}

}  // namespace

Box triangle_box(const Mesh& mesh, std::size_t triangle) {
  Box box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.extend(mesh.vertices[v]);
  return box;
}

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(mesh) {
  std::vector<Bounds> bounds(mesh.triangles.size());
  for (std::size_t t = 0; t < bounds.size(); ++t) bounds[t] = rounded_outward(triangle_box(mesh, t));
  bvh_ = build_bvh(bounds, order_);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point) const {
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
  walk_nearer_first(
      bvh_, [&](const Bounds& bounds) { return squared_distance_to(bounds, point); },
      [&](const BvhNode&, double squared) { return squared < best; },
      [&](std::uint32_t i) {
        const Triangle& t = mesh_.triangles[order_[i]];
        const double squared =
            squared_distance_to_triangle(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
        if (squared >= best) return;
        best = squared;
        triangle = order_[i];
      });
  return {std::sqrt(best), triangle};
}

bool TriangleTree::crossings(const Vec3& point, const Vec3& direction, int& winding) const {
  const Vec3 inverse = direction.cwiseInverse();
  winding = 0;
  const auto enter = [&](const BvhNode& node) { return ray_meets(node.bounds, point, inverse); };
  return walk_bvh(bvh_, enter, [&](std::uint32_t i) {
    const Triangle& t = mesh_.triangles[order_[i]];
    const Hit hit =
        ray_hits(direction, mesh_.vertices[t[0]] - point, mesh_.vertices[t[1]] - point, mesh_.vertices[t[2]] - point);
    if (hit == Hit::from_back) ++winding;   // leaving a solid
    if (hit == Hit::from_front) --winding;  // entering one
    return hit != Hit::unclear;
  });
}

int TriangleTree::winding_number(const Vec3& point) const {
  if (mesh_.empty()) return 0;
  // Directions scattered by steps of irrational length, none along an axis or a diagonal. None is clear where the point
  // is on a triangle, or so near to it that rounding decides.
  constexpr int kAttempts = 8;
  for (int attempt = 1; attempt <= kAttempts; ++attempt) {
    const double z = 1 - 2 * std::fmod(0.137 + attempt * 0.6180339887498949, 1.0);
    const double azimuth = 2.3999632297286533 * attempt + 0.271;
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    int winding = 0;
    if (crossings(point, Vec3(r * portable::cos(azimuth), r * portable::sin(azimuth), z), winding)) return winding;
  }
  return exact_winding(point);
}

int TriangleTree::exact_winding(const Vec3& point) const {
  const auto is_below = [&](const BvhNode& node) {
    const auto& [low, high] = node.bounds;
    return point.x() >= low[0] && point.x() <= high[0] && point.y() >= low[1] && point.y() <= high[1] &&
           point.z() <= high[2];
  };
  int winding = 0;
  const bool is_off_surface = walk_bvh(bvh_, is_below, [&](std::uint32_t i) {
    const Triangle& t = mesh_.triangles[order_[i]];
    const TriangleCorners corners = {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
    if (is_on_triangle(point, corners)) return false;
    winding += crossing_above(point, corners);
    return true;
  });
  return is_off_surface ? winding : 0;
}

}  // namespace vantage::internal::core
