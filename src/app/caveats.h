// What a mission's result does not know.
#pragma once

#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::app {

/// Sentences for people: LoadedScene::notes; that map, raster or ground end within the range, where what would hide
/// part of the target is missing; that a target looks as if it were given in degrees; those of scene_caveats. `mission`
/// placed in the frame of `loaded`; `volume`, where there is one.
std::vector<std::string> caveats(const Mission& mission, const LoadedScene& loaded, const Volume* volume = nullptr);

}  // namespace vantage::app
