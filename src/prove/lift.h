// How far the parts of a target may have been raised.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::internal::prove {

/// As vantage::lifts_needed_m. Asks whether to go on, and leaves the progress as it is.
std::vector<double> lifts_needed_m(const Scene& scene, const Target& target, double range_m,
                                   const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
