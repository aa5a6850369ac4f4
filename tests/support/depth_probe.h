// Depth cube maps in tests: rendering one, finding texels, and a plain loop over triangles as the truth.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "depth/depth.h"
#include "support/internals.h"

namespace vantage::testing {

struct DepthMap {
  int size = 0;
  std::vector<float> inverse_depths;

  float at(int face, int row, int column) const {
    return inverse_depths[(static_cast<std::size_t>(face) * size + row) * size + column];
  }
};

inline DepthMap render_one(depth::DepthRenderer& renderer, const Vec3& viewpoint, int size, depth::Sampling sampling,
                           double range = 1e9) {
  DepthMap map;
  map.size = size;
  renderer.render({{&viewpoint, 1}, size, sampling, range}, [&](std::size_t, std::span<const float> image) {
    map.inverse_depths.assign(image.begin(), image.end());
  });
  return map;
}

/// (u, v, inverse depth) of a point relative to the viewpoint, on a face; the depth may be negative.
inline Vec3 on_face(int face, const Vec3& point) {
  const depth::CubeFace& axes = depth::cube_faces()[face];
  const double forward = axes.forward.dot(point);
  return {axes.right.dot(point) / forward, axes.up.dot(point) / forward, 1 / forward};
}

inline Vec3 direction_on_face(int face, double u, double v) {
  const depth::CubeFace& axes = depth::cube_faces()[face];
  return axes.forward + u * axes.right + v * axes.up;
}

/// Of the centre of column or row i, of -1 to 1 across a face.
inline double texel_centre(int i, int size) { return (2.0 * i + 1) / size - 1; }

/// Triangles relative to a viewpoint.
using SeenTriangles = std::vector<std::array<Vec3, 3>>;

inline SeenTriangles seen_from(const Mesh& mesh, const Vec3& viewpoint) {
  SeenTriangles seen;
  for (const Triangle& t : mesh.triangles) {
    seen.push_back({mesh.vertices[t[0]] - viewpoint, mesh.vertices[t[1]] - viewpoint, mesh.vertices[t[2]] - viewpoint});
  }
  return seen;
}

struct RayHit {
  double inverse = 0;    ///< 1 over the distance along the ray, in lengths of its direction; 0: none
  bool is_clear = true;  ///< no triangle's border within about `border` (an angle) of the ray
};

/// First hit of a ray from the viewpoint: a loop over all triangles.
inline RayHit first_hit(const SeenTriangles& triangles, const Vec3& direction, double border) {
  RayHit hit;
  for (const auto& [a, b, c] : triangles) {
    const std::array<Vec3, 3> sides{b.cross(c), c.cross(a), a.cross(b)};
    const Vec3 normal = (b - a).cross(c - a);
    double least = 1e300, most = -1e300;
    for (const Vec3& side : sides) {
      if (side.norm() == 0) continue;
      const double signed_angle = side.dot(direction) / (side.norm() * direction.norm());
      least = std::min(least, signed_angle);
      most = std::max(most, signed_angle);
    }
    const bool inside = least >= 0 || most <= 0;
    const double inverse = normal.dot(direction) / normal.dot(a);
    if (!(inverse > 0)) continue;
    if ((inside && std::min(std::abs(least), std::abs(most)) < border) ||
        (!inside && (least > -border || most < border))) {
      hit.is_clear = false;
    }
    if (inside) hit.inverse = std::max(hit.inverse, inverse);
  }
  return hit;
}

}  // namespace vantage::testing
