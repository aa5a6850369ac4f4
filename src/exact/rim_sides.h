// Which facets of a triangulation lie on which side of the rim.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "exact/constrained_delaunay.h"
#include "exact/constraint_graph.h"

namespace vantage::internal::exact {

/// The floor may lie this fraction nearer than the envelope on what is kept: more, and they have met where nobody
/// looked.
inline constexpr double kMostCrossing = 1e-6;

/// The rim is a set of closed curves, but for where it ends at the horizon, and a side of it is a matter of counting
/// how often it is crossed: both sheets find the same, whatever rounding does to their facets.
class RimSides {
 public:
  /// Of the triangulation's vertices; any order.
  explicit RimSides(std::vector<ConstraintGraph::Edge> rim);

  bool empty() const { return rim_.empty(); }

  /// Sets, per facet that is not outside, whether it is on the side that is beyond the floor. `is_beyond` is asked of
  /// one point, the middle of the largest facet. Why it is of no use, where a piece of the rim is no side of facets, or
  /// the curves are not closed; else empty.
  const char* find(const ConstrainedDelaunay& delaunay, const std::function<bool(const Triangle&)>& is_outside,
                   const std::function<bool(const OctahedralPoint&)>& is_beyond, std::vector<char>& found);

  /// Where the triangulation has split pieces of the rim: at vertices that lie on them, but for `snap`.
  std::vector<OctahedralPoint> splits(const ConstrainedDelaunay& delaunay, double snap) const;

 private:
  bool is_piece(std::uint32_t a, std::uint32_t b) const;

  std::vector<ConstraintGraph::Edge> rim_;  // sorted
  std::vector<char> state_;                 // per facet: whether it is on the first one's side
  std::vector<std::uint32_t> open_;
};

}  // namespace vantage::internal::exact
