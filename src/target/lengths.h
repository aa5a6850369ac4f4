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

/// A volume that ends this close to the target is of no use to anyone: the view is blocked at once.
inline double min_useful_depth(double max_range) {
  return numerics::kMinUsefulDepth * std::min(1.0, max_range / numerics::kFullRange);
}

}  // namespace vantage::internal::target
