// Points that several solids have in common: the deepest one, and whether there is none. Branch and bound over boxes,
// see box_search.h: a depth changes by no more than the point moves, so the least of several depths does neither.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "core/progress_reporter.h"
#include "flight/solid_depth.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

struct CommonRequest {
  double least_m = 0;      ///< > 0: points count at this depth and deeper, in each of the solids
  double share = 0.9;      ///< of the greatest depth: a point that deep is deep enough; 0 to 1
  double finest_m = 0.05;  ///< > 0: boxes that reach no farther than this from their middle are not halved
  std::size_t most_boxes = 20'000;
  std::function<bool(const Vec3&)> is_allowed = {};  ///< asked of each point (scene frame) before it counts
};

struct CommonPoint {
  std::optional<Vec3> point;  ///< scene frame; nothing: none was found, which is no proof
  double depth_m = 0;         ///< of the point: the least of its depths
};

/// A point that lies deep in all solids, of which there is at least one. The same every time. Throws Error(cancelled).
CommonPoint deepest_common_point(std::span<const SolidDepth* const> solids, const CommonRequest& request,
                                 const core::ProgressReporter& progress);

/// Whether it is certain that no point is in all of the solids, closed sets, or comes as near as `within_m` >= 0 to
/// all. False where it is not found out with so many boxes. Throws Error(cancelled).
bool are_surely_apart(std::span<const SolidDepth* const> solids, double within_m, std::size_t most_boxes,
                      const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
