// Finds the blockers that may be seen from a target, nearest first, without looking at the rest of the city.
#pragma once

#include "core/progress_reporter.h"
#include "exact/blocker.h"
#include "exact/direction_tree.h"
#include "scene/prepared_data.h"
#include "vantage/target.h"

namespace vantage::internal::exact {

/// Walks the scene's hierarchy by distance from the target's centre; skips what is behind the target, out of range or
/// hidden behind what was found before. Fills `blockers` and inserts into `tree`, which must refer to `blockers`.
/// Blockers come in the order found, which does not depend on anything but the input.
void collect_blockers(const PreparedScene::Data& scene, const TargetFrame& frame, const target::LocalTarget& target,
                      const target::RangeRegion& range, BlockerSet& blockers, DirectionTree& tree,
                      const core::ProgressReporter& progress);

}  // namespace vantage::internal::exact
