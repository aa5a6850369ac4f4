// Makes one ring of a polygon with holes, so that it can be cut into triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::io {

/// Joins the holes of a polygon to its border by edges that are run twice, as triangulate_polygon takes them: a bridge
/// runs from the hole's corner that lies farthest along an axis of the polygon's plane to a corner of the border that
/// it sees (D. Eberly, Triangulation by Ear Clipping, Geometric Tools 2002, section 3). A hole that touches the border
/// in a corner is joined there.
///
/// `points`: the corners of the border, then those of each hole, either turn; `ends`: where each ring ends in `points`,
/// the border first; each ring has 3 corners or more. Returns indices into `points`: the border in its own turn, with
/// the holes let in. Holes may touch the border and each other, in one corner that both have. One that lies outside the
/// border is left out, and counted in `left_out`; of one that crosses the border, or another, what the result covers is
/// not defined.
///
/// Cost: the square of the corners, at most.
std::vector<std::uint32_t> join_holes(const std::vector<Vec3>& points, const std::vector<std::size_t>& ends,
                                      std::size_t& left_out);

}  // namespace vantage::internal::io
