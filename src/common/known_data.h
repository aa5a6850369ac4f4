// Where a scene's data end.
#pragma once

#include <span>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"

namespace vantage {

/// For a flight: range_beyond_data where positions (scene frame) lie more than a metre beyond the map, the raster or
/// the ground of the mission's scene: of what stands between them nothing is known there. Nothing is said of other
/// meshes, which may be all that there is. And scene_incomplete where something of the scene's ledger lies within range
/// of the flight. `positions`: those of the flight in order, and of what it must see. The mission is resolved.
VANTAGE_API std::vector<Warning> beyond_data_warnings(const Mission& mission, std::span<const Vec3> positions);

}  // namespace vantage
