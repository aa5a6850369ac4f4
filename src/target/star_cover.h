// Polygons that together are star-shaped, covered by convex ones about one point: docs/theory.md, "Targets of several
// parts".
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace vantage::internal::target {

/// Convex polygons, counter-clockwise, that overlap and all hold `centre` in their interior.
struct StarCover {
  Eigen::Vector2d centre;
  std::vector<std::vector<Eigen::Vector2d>> polygons;
  std::vector<Eigen::Vector2d> hull;  ///< of all of them
};

/// How far the cover may reach out of what it covers, in parts of the largest coordinate.
constexpr double kMostStarGrowth = 1e-9;

/// Covers `parts` (convex, counter-clockwise, at least 3 corners, metres) where every segment from some point to a
/// point of theirs lies in them. Of these points, which are a convex set, the middle becomes the centre. A polygon of
/// the cover is the convex hull of a part and of that set; where the hull of several lies in the parts, it is one.
/// Every point of the parts is covered, but for 2^-50 of the largest coordinate at corners that are left out as they
/// lie on an edge. Sides of two parts that are no farther apart than kMostStarGrowth touch.
///
/// nullopt where there is no such point, or none that is farther from the outline than a hundredth of its distance from
/// the farthest corner, and of more than 64 parts. Cost: O(n^2) in the corners, O(m^2 n) where m parts are joined to
/// larger ones.
std::optional<StarCover> star_cover(const std::vector<std::vector<Eigen::Vector2d>>& parts);

}  // namespace vantage::internal::target
