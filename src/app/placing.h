// Targets and limits that a mission gives on the earth -> the scene frame, once the scene says where that lies.
#pragma once

#include "vantage/mission.h"

namespace vantage::app {

/// Turns coordinates of `mission.crs` into the scene frame and puts `mission.ground_target` on the ground; both are
/// then empty, `target` and `other_parts` complete and checked. Does nothing where neither is set. Throws Error(input),
/// with places in the mission file, for: a scene without a place on the earth, a position that the CRS has no value
/// for, an object that is not in the map or no area, a target off the ground, and all that make_target_frame refuses.
/// Flat ground is extended to hold the target (`loaded.notes`); throws TerrainTooSmall where terrain has to be.
void place_mission(Mission& mission, LoadedScene& loaded, const Progress& progress);

}  // namespace vantage::app
