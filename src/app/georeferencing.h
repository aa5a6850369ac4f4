// Targets and limits that a mission gives on the earth -> the scene frame, once the scene says where that lies.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Turns the coordinates of `mission.as_written.crs` into the scene frame and puts `mission.as_written.ground_target`
/// on the ground, and looks up the faces of `mission.as_written.face_target`: afterwards target and boxes are in the
/// frame, and the target's parts are checked. So it is with each of `mission.as_written.targets`; what is asked of them
/// becomes `mission.target` and `mission.views`. The direction to the sun follows from its
/// time. `mission.target` and `mission.navigation` begin as the file has them. Throws Error(input), with places in the
/// mission file, for: a scene without a place on the earth, a position that the CRS has no value for, an object that is
/// not in the map or no area, a target off the ground, and all that make_target_frame refuses. Flat ground is extended
/// to hold the target (`loaded.notes`); throws TerrainTooSmall where terrain has to be.
void georeference(Mission& mission, const Progress& progress);

}  // namespace vantage::internal::app
