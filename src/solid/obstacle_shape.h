// Obstacles that are convex, nearly so, or fall into convex columns.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

using Polygon = std::vector<Vec3>;

/// Each once.
std::vector<Vec3> corners_of(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members);

/// Gaps between polygons that a vehicle does not fit into anyhow, in parts of the clearance: how far from their middle
/// to the nearest polygon, and how much farther than the clearance may be cut away over them.
constexpr double kWidestGap = 0.3, kOverGaps = 0.13;

/// Whether the convex hull of the members, grown by `radius_m`, may stand for them: every point of a facet of it lies
/// no farther than kWidestGap from one of the polygons, and what lies the radius over it no farther than 1 + kOverGaps,
/// in parts of the radius. Members that bound a convex solid are, whatever the radius. No where there are many, or
/// where the hull is flat but for rounding. Cost: O(n^2) in the members' corners.
bool is_nearly_convex(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members, double radius_m);

/// What holds all of a component's polygons: convex columns, by their corners, and polygons beside them.
struct Columns {
  std::vector<std::vector<Vec3>> columns;
  std::vector<std::uint32_t> others;
};

/// Of members that bound what lies under roofs, over a level bottom and between upright walls: under each polygon of
/// the roof a column. No columns where the members bound no such solid. *Proof.* The surface is closed, each edge runs
/// both ways, and bottoms face down: so of a point on a bottom the winding number rises when it moves up, and there is
/// a roof over it. Walls are looked at one by one. ∎ Cost: O(n log n).
Columns columns_of(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members);

}  // namespace vantage::internal::solid
