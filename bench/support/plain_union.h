// The plain alternative to the engine: the range region minus the union of one convex hull per scene triangle.
#pragma once

#include "core/progress_reporter.h"
#include "solid/csg.h"
#include "support/internals.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::bench {

/// What a plain program spends its time on: blockers of all triangles that reach into the region, their union, and the
/// difference. `region`: the range region in the target's frame, above its plane. Throws Error(cancelled) when told to
/// stop. Shares nothing with the engine but the target's frame.
solid::Solid plain_visibility(const Scene& scene, const TargetFrame& frame, const solid::Solid& region,
                              double max_range, const core::ProgressReporter& progress);

}  // namespace vantage::bench
