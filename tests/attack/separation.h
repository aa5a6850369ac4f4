// Whether a triangle comes between: exact tests of convex sets given by their corners.
#pragma once

#include <span>
#include <vector>

#include "exact.h"

namespace attack {

/// Whether the interior of the convex hull of `points` holds no point of the triangle. Touching is missing. Exact.
/// The triangle has an area. True where the hull has no interior.
///
/// By the theorem on separation: two convex polytopes whose relative interiors do not meet are separated by a plane,
/// which can be turned until it goes through two corners of one and one of the other. All such planes are tried: a
/// plane is taken by the signs of all corners, so nothing is computed that could be rounded.
bool interior_misses(std::span<const Vec3> points, const Corners& triangle);

/// A plane through two points of the hull and a corner of the triangle, or the other way round, by their numbers.
struct SeparatingPlane {
  int first = -1, second = 0;  ///< points; of the triangle where `by_side`
  int third = 0;
  bool by_side = false;
};

/// The same for a facet (the first three points) and a polygon in order (the others) by the planes of their sides
/// alone: true is certain, false is not. `last`: the plane that was found, and which one to try first.
bool hull_of_two_misses(std::span<const Vec3> points, const Corners& triangle, SeparatingPlane& last);

/// Whether the open segment from `from` to `to` passes from one side of the triangle to the other through its interior.
/// Exact.
bool segment_crosses(const Vec3& from, const Vec3& to, const Corners& triangle);

}  // namespace attack
