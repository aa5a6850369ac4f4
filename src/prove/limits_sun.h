// The sun: no point of the target may be seen near to it.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/sensor.h"

namespace vantage::internal::prove {

ClaimProof prove_sun(const LimitedVolume& volume, const SunLimit& sun, const std::vector<View>& parts,
                     const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
