// Convex solids from half-spaces, on the side that is asked for.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "solid/kernel_point.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// The boundary of what half-spaces share, closed and oriented. `inside`: a point strictly in all of them. They must
/// bound a region; their normals may have any length. Every vertex lies in all of them, to rounding; where planes
/// nearly coincide a corner may be missing. Cost: O(n log n) expected.
Mesh intersect_half_spaces(std::span<const HalfSpace> half_spaces, const Vec3& inside);

/// The normal of the triangle, as long as twice its area; its direction is right to rounding however narrow it is.
Vec3 sure_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// A convex mesh that holds `inside` is scaled about that point until the convex set with the support function `most`
/// (the largest product of a direction with one of its points) is in it, but for what sticks out of facets that are not
/// `asked`.
template <typename Support, typename Asked>
void grow_to_hold(Mesh& convex, const Vec3& inside, const Support& most, const Asked& asked) {
  double scale = 1;
  for (const Triangle& t : convex.triangles) {
    if (!asked(t)) continue;
    const Vec3& a = convex.vertices[t[0]];
    const Vec3 normal = sure_normal(a, convex.vertices[t[1]], convex.vertices[t[2]]);
    const double distance = normal.dot(a - inside);
    if (distance > 0) scale = std::max(scale, (most(normal) - normal.dot(inside)) / distance);
  }
  for (Vec3& vertex : convex.vertices) vertex = inside + scale * (1 + 1e-12) * (vertex - inside);
}
template <typename Support>
void grow_to_hold(Mesh& convex, const Vec3& inside, const Support& most) {
  grow_to_hold(convex, inside, most, [](const Triangle&) { return true; });
}

/// Directions spread evenly over the sphere.
struct SphereMesh {
  Mesh mesh;         ///< vertices of unit length
  double cover = 0;  ///< every direction lies within this angle of a vertex, radians
};

/// An icosahedron's facets cut in so many parts along each side: 20 n^2 facets.
SphereMesh make_sphere(int parts);

/// One whose vertices leave so little between them that a ball of radius 1 and its polytope with a facet at each differ
/// by no more than `share`.
SphereMesh make_sphere_for(double share);

}  // namespace vantage::internal::solid
