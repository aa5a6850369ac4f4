#include "solid/exact_winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/exact_crossing.h"
#include "core/walk_bvh.h"

namespace vantage::internal::solid {
namespace {

std::array<Vec3, 3> corners_of_triangle(const Mesh& mesh, std::uint32_t triangle) {
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
        const std::array<Vec3, 3> corners = corners_of_triangle(mesh_, order_[item]);
        if (point.z() >= box.min.z() && core::is_on_triangle(point, corners)) return false;
        winding += core::crossing_above(point, corners);
        return true;
      });
  return !is_off_surface || winding >= 1;
}

}  // namespace vantage::internal::solid
