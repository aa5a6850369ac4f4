// The ground that a mission's heights are measured from.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Gives navigation.above_ground, where the mission has it, its ground: what `ground` names, or else the scene's.
/// Throws Error(input) with the place in the mission file for a scene that does not say what of it is ground, and for
/// an object that it does not have, or has several of.
void find_ground(Mission& mission);

}  // namespace vantage::internal::app
