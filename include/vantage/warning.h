// What to know before relying on a result, though nothing is wrong by itself.
#pragma once

#include <span>
#include <string>

#include "vantage/export.h"

namespace vantage {

/// What a warning tells, for programs. Codes and their names stay as they are from version to version, the words may
/// change: docs/errors.md.
enum class WarningCode {
  range_beyond_data,   ///< the range reaches beyond the map, the raster or the ground: what hides there is missing
  range_beyond_scene,  ///< nothing of the scene is within range of the target
  scene_on_its_side,   ///< the scene seems to lie on its side
  target_in_degrees,   ///< the target is so small that its vertices seem to be longitudes and latitudes
  target_underground,  ///< the target seems to lie under the ground
  target_inside,       ///< the target lies inside a closed object of the scene
  target_from_below,   ///< the target is looked at from below, where nothing of the scene is
  volume_below_scene,  ///< the whole volume lies below the scene
  pixel_in_metres,     ///< the size of a pixel on the target is so large that centimetres seem to be meant
  ground_extended,     ///< the ground was made larger to hold the target
  zones_left_out,      ///< a file of zones holds what was not taken as a zone
  clearance_from_all,  ///< the scene does not say what of it is ground: the clearance is kept from all of it
  above_surface,       ///< heights above the ground are measured from a raster's surface, with roofs and trees
  faces_together,      ///< the target is several faces of an object, all of which must be seen from one position
  plan_left_out,       ///< a plan of a flight holds what is not flown here
  plan_joined,         ///< several tracks of a plan are flown one after the other
  plan_assumed,        ///< a plan leaves something open, and it says what was taken
  volume_small,        ///< the volume is smaller than a cubic metre, far less than the range allows
  // of a volume's file
  volume_changed,           ///< the mesh is not the one that the file was written with
  volume_of_other_scene,    ///< the volume was computed in another scene
  volume_of_other_mission,  ///< the volume was computed for another mission
  volume_moved,             ///< the volume lies about another origin on the earth and was moved
  heights_differ,           ///< heights are measured from another level than the scene's
  rounding_overstated,      ///< the file states a larger rounding than its numbers can have
};

/// All codes, in the order of their declaration.
VANTAGE_API std::span<const WarningCode> warning_codes();

/// "range-beyond-data".
VANTAGE_API const char* name_of(WarningCode code);

struct Warning {
  WarningCode code;
  std::string text;  ///< a sentence for people, without a full stop

  bool operator==(const Warning&) const = default;
};

}  // namespace vantage
