// Lengths that go with the size of the world: the caps of numerics.h, less where the world is small.
#pragma once

#include <algorithm>

#include "scene/prepared_data.h"
#include "target/numerics.h"
#include "vantage/export.h"
#include "vantage/target.h"

namespace vantage::internal::target {

/// Metres. A scene, its target and its range scaled by the same factor give the same results, as long as all of them
/// are so small, or all so large, that caps do not come between.
struct Lengths {
  double rounding;  ///< what it may have moved a point of the target, or of the scene near it, by
  double slack;     ///< points this near to the target's plane, or to the line of one of its edges, are on it
  double clear;     ///< the target is raised so far above what it would touch: numerics::kClear
  double lift;      ///< and not more in all, but for three times `clear`: numerics::kMaxLift
};

/// The frame's polygon has at least 3 vertices. `max_range` is positive.
VANTAGE_INTERNAL_API Lengths lengths_of(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range);

/// What covers the target this closely was hardly meant to: numerics::kHandBreadth.
inline double hand_breadth(double max_range) {
  return numerics::kHandBreadth * std::min(1.0, max_range / numerics::kFullRange);
}

/// Lengths::lift, but for the cap: what ends lower than that over the target is its own surface.
inline double most_lift(double max_range) {
  return numerics::kMaxLift * std::min(1.0, max_range / numerics::kFullRange);
}

}  // namespace vantage::internal::target
