// A convex polygon cut into convex cells of the same area. docs/theory.md, "A share of the
// target as a volume", uses them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "target/clean_outline.h"

namespace vantage::internal::target {

/// `count` >= 1 convex cells that together hold every point of the polygon (convex, counter-clockwise, at least 3
/// corners, metres about a point inside it). Each has corners counter-clockwise, at least 3 of them.
///
/// By halves: a polygon that is to become n cells is cut across its long direction, at right angles to the edge over
/// which it is lowest, into areas of n / 2, rounded down, and the rest. So twice as many cells are halves of these
/// where the count is a power of two.
///
/// Rounding: every cut is made twice, 2^-44 of the extent to either side, and its ends are moved outward by as much,
/// 64 times what they are rounded by. So cells overlap in strips, and leave no gap. Areas differ from equal ones by
/// what these strips have, 20 of them at most: 2^-39 times the extent times the cell's outline. Cells are
/// cleaned (clean_outline.h), and reach over their own border by no more than kMostOutlineGrowth. Cost: O(count) for
/// few corners.
std::vector<std::vector<Eigen::Vector2d>> equal_cells(const std::vector<Eigen::Vector2d>& polygon, std::size_t count);

/// Square metres, of a counter-clockwise polygon.
double area_of(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace vantage::internal::target
