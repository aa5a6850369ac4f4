// Convex polyhedra, cut by planes.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "prove/convex_polygon.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// By its faces: the hull of their corners. May be as thin as a polygon, a line or a point: then some faces are.
///
/// Where an edge is cut the new corner is rounded, inward as well. So a solid stands for one that is not rounded, all
/// of which is no farther from it than lost_m.
class ConvexSolid {
 public:
  static ConvexSolid tetrahedron(const std::array<Vec3, 4>& corners);

  bool empty() const { return faces_.empty(); }
  const std::vector<ConvexPolygon>& faces() const { return faces_; }
  double lost_m() const { return lost_m_; }
  std::size_t corner_count() const;  ///< of all faces: each corner once for each face that has it
  Box box() const;
  Vec3 middle() const;

  /// All that lies in the half-space, and what numbers cannot tell from it. Empty where nothing does.
  ConvexSolid within(const HalfSpace& side) const;

  /// The parts inside and outside, which together are all of it. One is empty where it would be the border alone.
  std::pair<ConvexSolid, ConvexSolid> split(const HalfSpace& side) const;

 private:
  double step_m() const;
  ConvexSolid part_in(const HalfSpace& side) const;

  std::vector<ConvexPolygon> faces_;
  double lost_m_ = 0, uneven_m_ = 0;  ///< `uneven_m_`: corners are as near to the planes of their faces
};

}  // namespace vantage::internal::prove
