// Where a scene's data end.
#pragma once

#include <optional>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"

namespace vantage {

/// What is asked of a flight; scene frame.
struct FlownPlaces {
  std::vector<Vec3> positions;    ///< of its points, in order
  std::vector<Vec3> seen;         ///< of what it must see
  std::vector<FlightLink> links;  ///< which it must keep
  double tube_radius_m = 0;       ///< with the flight's chord error: all must hold so near to it
  double clearance_m = 0;         ///< from the scene; that of Mission::navigation counts besides
};

/// scene_incomplete, where something of the ledger of the mission's scene hides too little, stands in for what is not
/// known, or must be kept away from: within range of the targets and, of positions there, within the clearance. The
/// mission is resolved. `volume`: tells how near such things are to its sight lines.
VANTAGE_API std::optional<Warning> incomplete_warning(const Mission& mission, const Volume* volume = nullptr);

/// For a flight: range_beyond_data where it, or what it must see, lies more than a metre beyond the map, the raster or
/// the ground of the mission's scene: of what stands between them nothing is known there. Nothing is said of other
/// meshes, which may be all that there is. And scene_incomplete where something of the scene's ledger lies within range
/// or clearance of the flight, or between it and the point of a link. The mission is resolved. Throws Error(cancelled).
VANTAGE_API std::vector<Warning> beyond_data_warnings(const Mission& mission, const FlownPlaces& flown,
                                                      const Progress& progress = {});

}  // namespace vantage
