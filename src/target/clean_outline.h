// The corners of a convex polygon that cuts or rounding have left with more than these.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace vantage::internal::target {

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Replacing short edges makes a polygon larger by no more than this part of its extent, of its largest coordinate.
constexpr double kMostOutlineGrowth = 1e-6;

/// `polygon`: convex to rounding, counter-clockwise. Vertices that lie in a row become one edge, also where rounding
/// has bent it, as in make_target_frame. Edges shorter than 1e-9 of the extent are replaced by the corner that the
/// edges beside them make where that is no farther off than kMostOutlineGrowth, and else stay. Nothing is lost but
/// 2^-50 of the extent at vertices that are left out.
std::vector<Eigen::Vector2d> cleaned_outline(std::vector<Eigen::Vector2d> polygon, double extent);

}  // namespace vantage::internal::target
