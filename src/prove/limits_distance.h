// What must be kept at a distance: obstacles, and the target.
#pragma once

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/navigation.h"

namespace vantage::internal::prove {

ClaimProof prove_clearance(const LimitedVolume& volume, const Clearance& clearance,
                           const core::ProgressReporter& progress);

/// Proves the least distance to each part of the target.
ClaimProof prove_min_range(const LimitedVolume& volume, double min_range_m, const std::vector<View>& parts,
                           const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
