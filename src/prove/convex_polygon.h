// Facets and parts of them: convex polygons in space, cut by planes.
#pragma once

#include <array>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// Corners in order. May be as narrow as a line.
using ConvexPolygon = std::vector<Vec3>;

/// A half-space: the points at which `over` is at most 0.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();  ///< outward
  double offset = 0;

  double over(const Vec3& point) const { return normal.dot(point) - offset; }
};

/// The parts inside and outside of a half-space, which together are all of a polygon. A side or a corner on the border
/// alone is no part; a polygon that lies in the border is inside.
struct CutPolygon {
  ConvexPolygon inside, outside;
};
CutPolygon cut(const ConvexPolygon& polygon, const HalfSpace& side);

/// Takes a convex region away: what is left of each polygon goes to `left`, in convex pieces. A polygon that does not
/// meet the region's inside stays whole.
void subtract(const ConvexPolygon& polygon, const std::vector<HalfSpace>& region, std::vector<ConvexPolygon>& left);

/// The part in all of the half-spaces; empty where they have only borders in common with it.
ConvexPolygon part_within(ConvexPolygon polygon, const std::vector<HalfSpace>& region);

Vec3 middle_of(const ConvexPolygon& polygon);
Box box_of(const ConvexPolygon& polygon);

}  // namespace vantage::internal::prove
