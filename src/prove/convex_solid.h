// Convex polyhedra, cut by planes.
#pragma once

#include <array>
#include <vector>

#include "prove/convex_polygon.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// By its faces. May be as thin as a polygon, a line or a point: then some faces are.
class ConvexSolid {
 public:
  static ConvexSolid tetrahedron(const std::array<Vec3, 4>& corners);

  bool empty() const { return faces_.empty(); }
  const std::vector<ConvexPolygon>& faces() const { return faces_; }
  Box box() const;
  Vec3 middle() const;

  /// What lies in the half-space; empty if it is the border alone. Corners on edges that are cut are rounded.
  ConvexSolid within(const HalfSpace& side) const;

 private:
  std::vector<ConvexPolygon> faces_;
};

}  // namespace vantage::internal::prove
