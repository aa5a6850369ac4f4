// Points, boxes and triangle meshes. Lengths are metres, angles degrees where a name ends in _deg, else radians. The
// scene frame is right-handed with z up.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "vantage/export.h"

namespace vantage {

using Vec3 = Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

/// The direction of a finite vector but 0, of length 1: also of one whose square is no double.
inline Vec3 unit(const Vec3& vector) {
  const int exponent = std::ilogb(vector.cwiseAbs().maxCoeff());
  return vector.unaryExpr([&](double x) { return std::ldexp(x, -exponent); }).normalized();
}

/// Axis-aligned box. The default one is empty (min > max).
struct Box {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return (min.array() > max.array()).any(); }
  void extend(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void extend(const Box& box) {
    min = min.cwiseMin(box.min);
    max = max.cwiseMax(box.max);
  }
};

/// Indexed triangles. `triangles[i]` holds three indices into `vertices`, counter-clockwise seen from outside where the
/// mesh bounds a solid. Nothing else is promised: a scene mesh may be any soup.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  bool empty() const { return triangles.empty(); }
};

/// Of the triangles: a vertex that none of them uses does not count. Indices must be in range.
VANTAGE_API Box bounding_box(const Mesh& mesh);

/// Volume enclosed by a closed, outward-oriented mesh, in cubic metres (divergence theorem, about the first vertex).
VANTAGE_API double enclosed_volume(const Mesh& mesh);

/// Sum of the triangles' areas, in square metres.
VANTAGE_API double surface_area(const Mesh& mesh);

}  // namespace vantage
