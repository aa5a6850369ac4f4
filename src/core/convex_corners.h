// Which vertices of a polygon are its corners, where rounding has bent what was straight or convex.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// How far a vertex that is not a corner may lie from the outline of the corners, in metres.
struct CornerSlack {
  double inside;   ///< the outline of the corners passes outside the vertex: what it bounds grows
  double outside;  ///< the vertex is cut off: what is bounded shrinks. At least the rounding of the coordinates
};

/// The corners of a polygon whose vertices (at least 3, no two at one place) run counter-clockwise seen from `normal`
/// (unit): the corners of its convex hull, less those that stick out by no more than `slack.outside`. Both distances
/// are measured from the outline of the corners that are left, so they do not add up along a row of vertices.
///
/// Returns, for each vertex, whether it is a corner: at least 3, and their outline turns left at each. Returns nothing
/// where that is impossible: a vertex lies deeper inside the hull than `slack.inside`, the outline runs back along
/// itself by more than that, winds round more than once, or is all thinner than `slack.outside`. Cost: O(n) for a
/// polygon that turns left everywhere, O(n^2) at worst.
std::optional<std::vector<bool>> find_corners(std::span<const Vec3> polygon, const Vec3& normal,
                                              const CornerSlack& slack);

/// Distance of b from the line through a and c: positive on its right, seen from `normal`.
double distance_right_of(const Vec3& a, const Vec3& c, const Vec3& b, const Vec3& normal);

}  // namespace vantage::internal::core
