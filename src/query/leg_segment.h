// How near a segment comes to convex sets.
#pragma once

#include <span>

#include "core/bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::query {

/// A pair of nearest points: of a segment, as a share of it, and of something else.
struct NearestPair {
  double squared_distance;
  double share;  ///< 0 to 1
  Vec3 point;
};

/// The nearest points of the segment and a convex polygon, planar but for rounding, of 1 corner or more; without area
/// too. Where they meet, a point that they share. Cost: linear in the corners.
NearestPair nearest_to_polygon(const Vec3& from, const Vec3& to, std::span<const Vec3> corners);

/// A lower bound of the distance of a segment from a box: the least distance of its points, but for rounding.
double distance_to_box(const Vec3& from, const Vec3& to, const core::Bounds& bounds);

}  // namespace vantage::internal::query
