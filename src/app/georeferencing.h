// Targets and limits that a mission gives on the earth -> the scene frame, once the scene says where that lies.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Turns the coordinates of `mission.as_written.crs` into the scene frame, but for those of limits, and finds out where
/// each of `mission.as_written.targets` lies: on the ground, on faces of the scene, in a file. Afterwards targets are
/// in the frame, their parts are checked, and what is asked of them is `mission.target` and `mission.views`. The
/// direction to the sun follows from its time. `mission.navigation` begins as the file has it. Throws Error(input),
/// with places in the mission file, for: a scene without a place on the earth, a position that the CRS has no value
/// for, an object that is not in the map or no area, a target off the ground, and all that make_target_frame refuses.
/// Flat ground is extended to hold the target (`loaded.notes`); throws TerrainTooSmall where terrain has to be.
void georeference(Mission& mission, const Progress& progress);

/// Turns the limits that are given in that reference system into the scene frame, for the targets and the home that the
/// mission has there. Throws Error(input) with their places.
void georeference_limits(Mission& mission);

}  // namespace vantage::internal::app
