// Convex pieces that lie side by side, joined to polygons with holes.
#pragma once

#include <vector>

#include "query/shadow.h"

namespace vantage::internal::query {

using Ring = std::vector<Point2>;

struct JoinedPolygon {
  Ring outer;               ///< counter-clockwise
  std::vector<Ring> holes;  ///< clockwise
};

/// `pieces` do not overlap, but for rounding. Corners that are nearer to each other than `snap`, or to an edge, become
/// one corner, or one of that edge; what is thinner than that vanishes. No ring meets itself or another one along an
/// edge; they may touch in points. Cost: O(n^2) at worst in the corners, n log n where they are spread.
std::vector<JoinedPolygon> join_pieces(const Pieces& pieces, double snap);

}  // namespace vantage::internal::query
