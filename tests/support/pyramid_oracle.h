// Depth images by the definition, in double precision: one texel against every triangle. Slow, and shares nothing with
// the back ends but the axes of the cube's faces.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

#include "depth/depth.h"
#include "support/internals.h"

namespace vantage::testing {

/// Triangles about an eye, as (right, up, forward) of one face of the cube.
using FaceTriangles = std::vector<std::array<Vec3, 3>>;

inline FaceTriangles triangles_of_face(const Mesh& mesh, const Vec3& eye, int face) {
  const depth::CubeFace& axes = depth::cube_faces()[face];
  FaceTriangles triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> corners;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.vertices[t[k]] - eye;
      corners[k] = {axes.right.dot(p), axes.up.dot(p), axes.forward.dot(p)};
    }
    triangles.push_back(corners);
  }
  return triangles;
}

/// The greatest inverse depth along (u, v, 1); 0: nothing there.
inline double inverse_depth_along(const FaceTriangles& triangles, double u, double v) {
  const Vec3 direction(u, v, 1);
  double best = 0;
  for (const auto& [a, b, c] : triangles) {
    const double ab = a.cross(b).dot(direction), bc = b.cross(c).dot(direction), ca = c.cross(a).dot(direction);
    if (!((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) continue;
    const Vec3 normal = (b - a).cross(c - a);
    const double distance = normal.dot(a);
    if (distance != 0) best = std::max(best, normal.dot(direction) / distance);
  }
  return best;
}

/// The greatest inverse depth over the rectangle about (u, v), of `half` width: of each triangle's part in its pyramid.
inline double inverse_depth_over(const FaceTriangles& triangles, double u, double v, double half) {
  const std::array<Vec3, 4> planes{{{-1, 0, u + half}, {1, 0, half - u}, {0, -1, v + half}, {0, 1, half - v}}};
  double best = 0;
  std::vector<Vec3> polygon, cut;
  for (const auto& triangle : triangles) {
    const bool beside = std::any_of(planes.begin(), planes.end(), [&](const Vec3& plane) {
      return plane.dot(triangle[0]) < 0 && plane.dot(triangle[1]) < 0 && plane.dot(triangle[2]) < 0;
    });
    if (beside) continue;
    polygon.assign(triangle.begin(), triangle.end());
    for (const Vec3& plane : planes) {
      cut.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
        const double at_from = plane.dot(from), at_to = plane.dot(to);
        if (at_from >= 0) cut.push_back(from);
        if ((at_from < 0) != (at_to < 0)) cut.push_back(from + at_from / (at_from - at_to) * (to - from));
      }
      polygon.swap(cut);
      if (polygon.empty()) break;
    }
    for (const Vec3& p : polygon) best = std::max(best, 1 / std::max(p.z(), 1e-9));
  }
  return best;
}

}  // namespace vantage::testing
