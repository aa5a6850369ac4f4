// What every method asks of the range before it begins.
#pragma once

#include "vantage/constraints.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::target {

/// Whether some point is within range of the whole target.
bool can_reach(const TargetFrame& frame, const Sensor& sensor);

/// The outcome where none is.
void set_out_of_range(const TargetFrame& frame, const Sensor& sensor, Volume& volume);

}  // namespace vantage::internal::target
