// Targets on the ground of the scene: docs/mission-file.md.
#pragma once

#include "geo/local_frame.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Lays the target that `mission.as_written.ground_target` describes on the ground of the scene, in `frame`:
/// that of the scene, which only outlines can do without. Throws Error(component_missing) without maps.
void put_on_ground(Mission& mission, const geo::LocalFrame* frame, const Progress& progress);

}  // namespace vantage::internal::app
