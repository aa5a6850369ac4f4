// What every method asks of the range before it begins.
#pragma once

#include "vantage/export.h"
#include "vantage/navigation.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::target {

/// Whether some point is within range of the whole target.
inline bool can_reach(const TargetFrame& frame, const Sensor& sensor) {
  return frame.enclosing_radius_m * (1 + 1e-9) < range_limit_m(sensor);
}

/// The outcome where none is.
VANTAGE_INTERNAL_API void set_out_of_range(const TargetFrame& frame, const Sensor& sensor, Volume& volume);

}  // namespace vantage::internal::target
