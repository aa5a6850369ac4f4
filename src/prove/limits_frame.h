// The camera's picture: all of the target must be in it.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/sensor.h"

namespace vantage::internal::prove {

/// `sensor`: with a camera.
ClaimProof prove_frame(const LimitedVolume& volume, const Sensor& sensor, const std::vector<View>& parts,
                       const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
