// Targets of several parts that are one star-shaped polygon: docs/theory.md, "Targets of several parts".
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vantage/target.h"

namespace vantage::internal::exact {

/// A target that is seen in one chart: one polygon, or several that overlap.
struct StarTarget {
  TargetFrame frame;  ///< about the middle of the points that see all of the target; its polygon is the convex hull
  std::vector<std::vector<Eigen::Vector2d>> cover;  ///< in the frame, convex; all hold its origin in their interior
};

/// Of one part its frame, with the polygon alone. Of several parts all in one frame, with the plane and the axes of the
/// first one's.
///
/// nullopt for a point, and for one part that is out of range. For several where they do not lie in one plane, all with
/// their fronts to the same side, within a quarter of Lengths::slack also at the end of the range; where no point in
/// them sees all of them, or one only that is too near to their outline (star_cover.h); and where that point is not
/// well within range of all corners.
std::optional<StarTarget> star_target(const PreparedTarget& target);

}  // namespace vantage::internal::exact
