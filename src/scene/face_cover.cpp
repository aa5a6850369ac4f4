#include "scene/face_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vantage::internal::scene {
namespace {

Box box_of(const PlanePieces& pieces) {
  Box box;
  for (const std::vector<Vec3>& piece : pieces) {
    for (const Vec3& corner : piece) box.extend(corner);
  }
  return box;
}

/// The part of a convex polygon where `height` of its corners is at least `low`; in the same order.
void keep_above(std::vector<Vec3>& polygon, std::vector<double>& height, double low) {
  std::vector<Vec3> kept;
  std::vector<double> kept_height;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (height[i] >= low) {
      kept.push_back(polygon[i]);
      kept_height.push_back(height[i]);
    }
    if ((height[i] < low) == (height[next] < low)) continue;
    const double share = (low - height[i]) / (height[next] - height[i]);
    kept.push_back(polygon[i] + share * (polygon[next] - polygon[i]));
    kept_height.push_back(low);
  }
  polygon = std::move(kept);
  height = std::move(kept_height);
}

class Cover {
 public:
  Cover(const TriangleIndex& index, const std::vector<Box>& boxes, const FacePlane& plane, double sliver,
        PlanePieces& pieces)
      : index_(index), boxes_(boxes), plane_(plane), sliver_(sliver), pieces_(pieces) {}

  void cut() {
    Box box = box_of(pieces_);
    box.min.array() -= kInFront;
    box.max.array() += kInFront;
    std::vector<std::uint32_t> found;
    index_.near(box, [&](std::uint32_t triangle) { found.push_back(triangle); });
    std::sort(found.begin(), found.end());
    for (const std::uint32_t triangle : found) {
      if (!std::binary_search(plane_.triangles.begin(), plane_.triangles.end(), triangle)) cut_triangle(triangle);
      if (pieces_.empty()) return;
    }
    if (plane_.is_facade) cut_ground();
    std::erase_if(pieces_, [&](const std::vector<Vec3>& piece) { return is_in_solid(piece); });
  }

 private:
  double height_of(const Vec3& point) const { return plane_.normal.dot(point) - plane_.at; }

  /// Takes a polygon away. One that is upright in the plane leaves a segment: on one side of it may be a solid.
  void take(std::vector<Vec3> polygon) {
    for (Vec3& corner : polygon) corner -= height_of(corner) * plane_.normal;
    if (!is_sliver(polygon, sliver_)) return subtract(pieces_, polygon, plane_.normal, sliver_);
    Vec3 from = polygon[0], to = polygon[0];
    for (const Vec3& a : polygon) {
      for (const Vec3& b : polygon) {
        if ((b - a).norm() > (to - from).norm()) {
          from = a;
          to = b;
        }
      }
    }
    split_along(pieces_, from, to, plane_.normal, sliver_);
  }

  /// Nothing of the scene is between the face and kInFront any more, and no piece is on both sides of a wall.
  bool is_in_solid(const std::vector<Vec3>& piece) const {
    const Scene& scene = index_.scene();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : piece) middle += corner / static_cast<double>(piece.size());
    const Vec3 before = middle + 0.5 * kInFront * plane_.normal;
    for (std::uint32_t object = 0; object < boxes_.size(); ++object) {
      const Box& box = boxes_[object];
      if ((before.array() < box.min.array()).any() || (before.array() > box.max.array()).any()) continue;
      const ObjectKind kind = object < scene.objects.size() ? scene.objects[object].kind : ObjectKind::other;
      if (kind == ObjectKind::ground || kind == ObjectKind::surface) continue;
      if (index_.side_of(before, object) == Side::inside) return true;
    }
    return false;
  }

  void cut_triangle(std::uint32_t triangle) {
    const TriangleCorners corners = index_.corners(triangle);
    std::vector<Vec3> polygon(corners.begin(), corners.end());
    std::vector<double> height;
    for (const Vec3& corner : corners) height.push_back(height_of(corner));
    const auto [low, high] = std::minmax_element(height.begin(), height.end());
    if (*low >= -kInPlane && *high <= kInPlane) {
      if (is_wall_against(corners, triangle)) take(std::move(polygon));
      return;
    }
    if (*high <= 0 || *low >= kInFront) return;
    keep_above(polygon, height, 0);
    for (double& value : height) value = -value;
    keep_above(polygon, height, -kInFront);
    if (polygon.size() >= 3) take(std::move(polygon));
  }

  /// Whether a triangle in the plane bounds a solid in front of it.
  bool is_wall_against(const TriangleCorners& c, std::uint32_t triangle) const {
    constexpr double kStep = 1e-2;  // metres
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3;
    const double step = std::min(kStep, 0.1 * std::sqrt((c[1] - c[0]).cross(c[2] - c[0]).norm())) + kInPlane;
    return index_.side_of(middle + step * plane_.normal, index_.object_of(triangle)) == Side::inside;
  }

  /// What is below the line in which the ground meets the plane.
  void cut_ground() {
    const Scene& scene = index_.scene();
    Box column = box_of(pieces_);
    const double lowest = column.min.z() - 1;
    column.min.z() = -INFINITY;
    column.max.z() = INFINITY;
    std::vector<std::uint32_t> ground;
    index_.near(column, [&](std::uint32_t triangle) {
      const std::uint32_t object = index_.object_of(triangle);
      if (object < scene.objects.size() && scene.objects[object].kind == ObjectKind::ground) ground.push_back(triangle);
    });
    std::sort(ground.begin(), ground.end());
    for (const std::uint32_t triangle : ground) {
      std::vector<Vec3> line = crossing_of(index_.corners(triangle));
      if (line.size() != 2) continue;
      // Straight down in the plane, which is all but upright.
      const Vec3 down = (-Vec3::UnitZ() + plane_.normal.z() * plane_.normal).normalized();
      const double deep = (std::max(line[0].z(), line[1].z()) - lowest) / -down.z();
      if (deep <= 0) continue;
      take({line[0], line[1], line[1] + deep * down, line[0] + deep * down});
    }
  }

  /// The segment in which a triangle meets the plane.
  std::vector<Vec3> crossing_of(const TriangleCorners& corners) const {
    std::vector<Vec3> line;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
      const double from = height_of(a), to = height_of(b);
      if ((from > 0) != (to > 0)) line.push_back(a + (b - a) * (from / (from - to)));
    }
    return line;
  }

  const TriangleIndex& index_;
  const std::vector<Box>& boxes_;
  const FacePlane& plane_;
  double sliver_;
  PlanePieces& pieces_;
};

}  // namespace

void cut_covered(const TriangleIndex& index, const std::vector<Box>& boxes, const FacePlane& plane, double sliver,
                 PlanePieces& pieces) {
  Cover(index, boxes, plane, sliver, pieces).cut();
}

}  // namespace vantage::internal::scene
