// A bounding volume hierarchy over the triangles of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "core/triangle_contact.h"
#include "core/walk_bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// Refers to the mesh, which must outlive it. The mesh should lie about the origin: boxes are single precision. Any
/// number of threads may ask at once. Building: O(n log n).
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);

  /// Calls `visit(triangle)` for every triangle whose bounding box, grown by `margin`, meets `box`.
  template <typename Visit>
  void for_each_near(const Box& box, double margin, const Visit& visit) const;

  /// Whether `visit(triangle)` is true for one of the triangles whose bounding boxes meet `box`; it is not called for
  /// others.
  template <typename Visit>
  bool any_near(const Box& box, const Visit& visit) const;

  /// The same for triangles whose bounding boxes meet that of a triangle with these corners, and may touch it: far
  /// fewer, of one that is long and slanted.
  template <typename Visit>
  void for_each_along(const std::array<Vec3, 3>& corners, const Visit& visit) const;

  struct Nearest {
    double distance;
    std::uint32_t triangle;
  };
  /// The triangle nearest to a point, and its distance; the mesh must not be empty. Metres.
  Nearest nearest(const Vec3& point) const;
  double distance(const Vec3& point) const { return nearest(point).distance; }

  /// How often the mesh, which must be closed, winds round a point: 1 inside an outward-oriented solid, 0 outside and
  /// on its triangles, decided by the coordinates as they are. Counts the signed crossings of rays in scattered
  /// directions until one keeps clear of all edges; if none of a few does, without rounding. If the surface counts as
  /// inside, ask for the distance, too.
  int winding_number(const Vec3& point) const;

 private:
  bool crossings(const Vec3& point, const Vec3& direction, int& winding) const;
  int exact_winding(const Vec3& point) const;

  const Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  Bvh bvh_;
};

Box triangle_box(const Mesh& mesh, std::size_t triangle);

template <typename Visit>
bool TriangleTree::any_near(const Box& box, const Visit& visit) const {
  const auto near = [&](const auto& low, const auto& high) {
    for (int axis = 0; axis < 3; ++axis) {
      if (low[axis] > box.max[axis] || high[axis] < box.min[axis]) return false;
    }
    return true;
  };
  const auto enter = [&](const BvhNode& node) { return near(node.bounds.min, node.bounds.max); };
  return !walk_bvh(bvh_, enter, [&](std::uint32_t i) {
    const Box item = triangle_box(mesh_, order_[i]);
    return !(near(item.min, item.max) && visit(order_[i]));
  });
}

template <typename Visit>
void TriangleTree::for_each_near(const Box& box, double margin, const Visit& visit) const {
  Box grown = box;
  grown.min.array() -= margin;
  grown.max.array() += margin;
  any_near(grown, [&](std::uint32_t triangle) {
    visit(triangle);
    return false;
  });
}

template <typename Visit>
void TriangleTree::for_each_along(const std::array<Vec3, 3>& corners, const Visit& visit) const {
  Box own;
  for (const Vec3& corner : corners) own.extend(corner);
  const auto touches = [&](const Box& box) {
    return (box.min.array() <= own.max.array()).all() && (box.max.array() >= own.min.array()).all() &&
           may_touch(corners, box);
  };
  const auto enter = [&](const BvhNode& node) {
    const auto& [min, max] = node.bounds;
    return touches({Vec3(min[0], min[1], min[2]), Vec3(max[0], max[1], max[2])});
  };
  walk_bvh(bvh_, enter, [&](std::uint32_t i) {
    if (touches(triangle_box(mesh_, order_[i]))) visit(order_[i]);
  });
}

}  // namespace vantage::internal::core
