// The ground that a mission's heights are measured from.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// What `ground` names, or else the scene's. Throws as find_ground, with `where`.
Ground ground_for(const Mission& mission, const std::string& where);

/// Gives all limits above the ground their ground: what `ground` names, or else the scene's. Throws Error(input) with
/// the place in the mission file for a scene that does not say what of it is ground, and for an object that it does not
/// have, or has several of.
void find_ground(Mission& mission);

/// Gives the clearance its obstacles: all of the scene but its ground, and the object that `ground` names. Where that
/// is all, a note says so. Throws Error(input) as above.
void find_obstacles(Mission& mission);

}  // namespace vantage::internal::app
