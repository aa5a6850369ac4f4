// Targets on the ground of the scene: docs/mission-file.md.
#pragma once

#include "geo/on_globe.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Of a mission with one target, which is to be put on the ground; else null.
inline const GroundTarget* only_ground_target(const MissionFile& mission) {
  return mission.targets.size() == 1 ? std::get_if<GroundTarget>(&mission.targets.front().source) : nullptr;
}

/// Lays the one target of `mission.as_written`, a GroundTarget, on the ground of the scene. `globe`: of the scene,
/// which only outlines can do without. Throws Error(component_missing) without maps.
void put_on_ground(Mission& mission, const geo::OnGlobe* globe, const Progress& progress);

/// z so far above the scene's ground; nothing beyond it. The mission must outlive it.
SurfaceZ above_ground(const Mission& mission, double above_m);

/// Corners of an outline that are longitude and latitude, with heights as z_m if it has any, into the frame; those
/// without heights are put on the ground.
void place_corners(const geo::OnGlobe& globe, const SurfaceZ& ground, TargetOutline& outline);

}  // namespace vantage::internal::app
