// Targets on the ground of the scene: docs/mission-file.md.
#pragma once

#include "geo/local_frame.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Of a mission with one target, which is to be put on the ground; else null.
inline const GroundTarget* only_ground_target(const MissionFile& mission) {
  return mission.targets.size() == 1 ? std::get_if<GroundTarget>(&mission.targets.front().source) : nullptr;
}

/// Lays the one target of `mission.as_written`, a GroundTarget, on the ground of the scene, in `frame`: that of the
/// scene, which only outlines can do without. Throws Error(component_missing) without maps.
void put_on_ground(Mission& mission, const geo::LocalFrame* frame, const Progress& progress);

}  // namespace vantage::internal::app
