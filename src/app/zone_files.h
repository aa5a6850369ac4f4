// Zones of files in the scene frame.
#pragma once

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Adds the zones of `mission.as_written.keep_in_files` and `keep_out_files` to those of `mission.navigation`: moved as
/// placed_zone does, circles made polygons, inscribed to stay in and circumscribed to stay out of, heights made z. What
/// of a file was not taken is told in `mission.notes`: what is no area, fences of the other kind, zones so far
/// away that no viewpoint can be in them.
///
/// Throws Error(input), with the places in the mission file and in the file, for: a scene without a place on the earth,
/// a file that cannot be read, has no zone to take or none near the scene, a zone that crosses itself, zones without
/// heights where the mission gives none, and heights that the scene cannot relate to its own;
/// Error(cancelled) when told to stop.
void add_file_zones(Mission& mission, const Progress& progress);

}  // namespace vantage::internal::app
