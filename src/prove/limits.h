// All that a volume claims besides sight, range and front.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/navigation.h"
#include "vantage/sensor.h"

namespace vantage::internal::prove {

/// A claim for each limit that is given, navigation first. `seen`: what the sensor's limits are about, the volume or
/// the part of it in front of the target. Throws Error(input) for limits that are wrong in themselves.
std::vector<ClaimProof> prove_limits(const LimitedVolume& volume, const LimitedVolume& seen,
                                     const std::vector<View>& parts, const Sensor& sensor, const Navigation& navigation,
                                     const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
