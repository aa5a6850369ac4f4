// Targets and limits that a mission gives on the earth -> the scene frame, once the scene says where that lies.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Turns the coordinates of `mission.as_written.crs` into the scene frame, and finds out where each of
/// `mission.as_written.targets` lies: on the ground, on faces of the scene, in a file. Afterwards targets and boxes are
/// in the frame, the targets' parts are checked, and what is asked of them is `mission.target` and `mission.views`. The
/// direction to the sun follows from its time. `mission.navigation` begins as the file has it. Throws Error(input),
/// with places in the mission file, for: a scene without a place on the earth, a position that the CRS has no value
/// for, an object that is not in the map or no area, a target off the ground, and all that make_target_frame refuses.
/// Flat ground is extended to hold the target (`loaded.notes`); throws TerrainTooSmall where terrain has to be.
void georeference(Mission& mission, const Progress& progress);

}  // namespace vantage::internal::app
