// The target as the oracle takes it, made from the mission alone.
#pragma once

#include <vector>

#include "exact.h"
#include "vantage/target.h"

namespace attack {

/// A convex polygon or a point, in the oracle's coordinates. A polygon is the fan of triangles about its first corner.
struct SeenTarget {
  std::vector<Vec3> corners;  ///< counter-clockwise seen from the front
  Vec3 normal;                ///< towards the front
  Vec3 centre;                ///< mean of the corners
  bool all_sides = false;     ///< a point without a front

  bool is_point() const { return corners.size() == 1; }
  std::size_t fan() const { return corners.size() < 3 ? 0 : corners.size() - 2; }
  Corners fan_triangle(std::size_t i) const { return {corners[0], corners[i + 1], corners[i + 2]}; }
  double height(const Vec3& point) const { return normal.dot(point - centre); }
};

/// By the rules of vantage/target.h: offset and lift along the normal, the mean plane of vertices that rounding moved
/// out of one. Coordinates are relative to `origin`.
SeenTarget make_seen_target(const vantage::Target& target, double lift, const Vec3& origin);

/// The same with every side moved in by `margin` (below 0: out), and raised by `rise`. May be left with fewer than 3
/// corners: then it has no area, and nothing hides it.
SeenTarget moved_in(const SeenTarget& target, double margin, double rise);

/// Radius of a circle about some point that holds all corners, at most 1e-9 of it above the smallest.
double enclosing_radius(const SeenTarget& target);

}  // namespace attack
