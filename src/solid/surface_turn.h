// How much a surface of polygons turns about each of them.
#pragma once

#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// Of each polygon the sine of the largest angle between its normal and that of a polygon about one of its corners. 1
/// where that is unknown: at the surface's border, where edges of neighbours are not the same or do not run in opposite
/// directions, where an angle is above 45 degrees. `is_known`: whether a polygon's normal is, for each; one without is
/// no neighbour. Corners that meet have equal coordinates. Cost: linear.
///
/// A point whose nearest point of the surface is in such a polygon has its foot in the polygon's plane, and no farther
/// aside from the polygon than this part of its distance: docs/theory.md, "Cuts".
std::vector<double> sines_of_turns(std::span<const std::vector<Vec3>> polygons, const std::vector<bool>& is_known);

}  // namespace vantage::internal::solid
