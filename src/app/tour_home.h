// Where a tour begins, in the scene frame.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Sets `mission.home` where the mission file gives one; the ground must have been found. Throws Error(input) with the
/// place of the tour for: a latitude and a longitude in a scene without a place on the earth, or where there is no
/// ground, and a place far away.
void place_home(Mission& mission);

}  // namespace vantage::internal::app
