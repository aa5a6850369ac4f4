// Why navigation limits leave nothing of a volume.
#pragma once

#include <string>

#include "solid/regions.h"

namespace vantage::internal::solid {

/// Applies the limits one after the other to find the one that leaves nothing. `volume` is relative to regions.origin.
Emptiness explain_emptiness(const Solid& volume, const Regions& regions, const core::ProgressReporter& progress = {});

/// A piece of what is cut from `volume` whose volume is less than this times its area is rounding error. Metres.
double sliver_thickness(const Solid& volume);

}  // namespace vantage::internal::solid
