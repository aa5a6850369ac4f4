// Limits of the sensor besides its range.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/sensor.h"

namespace vantage::internal::prove {

/// A claim for each limit that the sensor has. Throws Error(input) for a limit that is about the plane of a point
/// without a front.
std::vector<ClaimProof> prove_sensor(const LimitedVolume& volume, const Sensor& sensor, const std::vector<View>& parts,
                                     const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
