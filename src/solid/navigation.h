// Cutting a volume to the limits that it was not computed with.
#pragma once

#include <span>

#include "vantage/each_limit.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {

/// As cut_to_limits. `done`: limits of the sensor that the volume keeps.
Volume cut_to_other_limits(const Volume& volume, const PreparedTarget& target, std::span<const Limit> done,
                           const Navigation& navigation, const Progress& progress, double work_limit);

}  // namespace vantage::internal::solid
