// Winding numbers by a ray straight up. Where the ray meets an edge, or a triangle that stands upright, it is taken to
// start beside the point: farther east by an infinitely small step, and farther north by a much smaller one (simulation
// of simplicity, Edelsbrunner and Muecke 1990). The point is on no triangle then, so that this changes nothing.
#include "solid/exact_winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/orientation.h"
#include "core/walk_bvh.h"

namespace vantage::internal::solid {
namespace {

using PlanPoint = Eigen::Vector2d;
using TriangleCorners = std::array<Vec3, 3>;

TriangleCorners corners_of_triangle(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// `rounding`: what the coordinates of the box and of a point may be off by.
core::Bounds grown_bounds(const Box& box, const Vec3& origin, double rounding) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  core::Bounds bounds{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - origin[axis] - rounding, high = box.max[axis] - origin[axis] + rounding;
    bounds.min[static_cast<std::size_t>(axis)] = std::nextafter(static_cast<float>(low), -kInfinity);
    bounds.max[static_cast<std::size_t>(axis)] = std::nextafter(static_cast<float>(high), kInfinity);
  }
  return bounds;
}

bool is_in_box(const Vec3& point, const Vec3& a, const Vec3& b) {
  return (point.array() >= a.cwiseMin(b).array()).all() && (point.array() <= a.cwiseMax(b).array()).all();
}

/// As seen along an axis.
PlanPoint flat(const Vec3& point, int axis) { return {point[(axis + 1) % 3], point[(axis + 2) % 3]}; }

int turn_along(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  return core::turn(flat(a, axis), flat(b, axis), flat(c, axis));
}

bool is_on_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  if (!is_in_box(point, a, b)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (turn_along(a, b, point, axis) != 0) return false;
  }
  return true;
}

/// With its border, also of a triangle without an area.
bool is_on_triangle(const Vec3& point, const TriangleCorners& t) {
  if (core::orientation(t[0], t[1], t[2], point) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int way = turn_along(t[0], t[1], t[2], axis);
    if (way == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (turn_along(t[i], t[(i + 1) % 3], point, axis) == -way) return false;
    }
    return true;
  }
  return is_on_segment(point, t[0], t[1]) || is_on_segment(point, t[1], t[2]) || is_on_segment(point, t[2], t[0]);
}

/// In plan, of a point that is moved a little to the east and even less to the north; never 0 where a and b differ.
int turn_beside(const Vec3& a, const Vec3& b, const Vec3& point) {
  const int way = core::turn(a.head<2>(), b.head<2>(), point.head<2>());
  if (way != 0) return way;
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  return b.x() > a.x() ? 1 : b.x() < a.x() ? -1 : 0;
}

/// What a ray up from a point that is not on the triangle adds: 1 where it leaves the solid there, -1 where it enters.
int crossing_of(const Vec3& point, const TriangleCorners& t) {
  const int way = turn_beside(t[0], t[1], point);
  if (way == 0 || turn_beside(t[1], t[2], point) != way || turn_beside(t[2], t[0], point) != way) return 0;
  // Seen from below the corners of a triangle that faces up run clockwise.
  return core::orientation(t[0], t[1], t[2], point) == way ? way : 0;
}

}  // namespace

ExactWinding::ExactWinding(const Mesh& mesh) : mesh_(mesh), bounds_(bounding_box(mesh)) {
  if (mesh.empty()) return;
  origin_ = bounds_.min / 2 + bounds_.max / 2;
  const double largest = std::max(bounds_.min.cwiseAbs().maxCoeff(), bounds_.max.cwiseAbs().maxCoeff());
  constexpr double kRounding = 0x1p-50;
  std::vector<core::Bounds> items;
  items.reserve(mesh.triangles.size());
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Box& box = boxes.emplace_back();
    for (const Vec3& corner : corners_of_triangle(mesh, t)) box.extend(corner);
    items.push_back(grown_bounds(box, origin_, kRounding * largest));
  }
  bvh_ = core::build_bvh(items, order_);
  for (const std::uint32_t t : order_) boxes_.push_back(boxes[t]);
}

bool ExactWinding::holds(const Vec3& point) const {
  if (!(point.array() >= bounds_.min.array()).all() || !(point.array() <= bounds_.max.array()).all()) return false;
  const Vec3 local = point - origin_;
  const auto is_above = [&](const auto& low, const auto& high, const Vec3& p) {
    return p.x() >= low[0] && p.x() <= high[0] && p.y() >= low[1] && p.y() <= high[1] && p.z() <= high[2];
  };
  int winding = 0;
  const bool is_off_surface = core::walk_bvh(
      bvh_, [&](const core::BvhNode& node) { return is_above(node.bounds.min, node.bounds.max, local); },
      [&](std::uint32_t item) {
        const Box& box = boxes_[item];
        if (!is_above(box.min, box.max, point)) return true;
        const TriangleCorners corners = corners_of_triangle(mesh_, order_[item]);
        if (point.z() >= box.min.z() && is_on_triangle(point, corners)) return false;
        winding += crossing_of(point, corners);
        return true;
      });
  return !is_off_surface || winding >= 1;
}

}  // namespace vantage::internal::solid
