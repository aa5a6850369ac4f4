// Where a tour begins, in the scene frame.
#pragma once

#include <array>
#include <string>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Sets `mission.home` where the mission file gives one; the ground must have been found. Throws Error(input) with the
/// place of the tour for: a latitude and a longitude in a scene without a place on the earth, or where there is no
/// ground, and a place far away.
void place_home(Mission& mission);

/// A place that a flight starts from or must reach, for messages.
struct PlaceOfFlight {
  std::string name;     ///< "tour.home"
  std::string instead;  ///< how it is given in the scene frame: "tour.home as [x, y, z]"
  std::string where;    ///< in the mission file
};

/// Of a latitude and a longitude, so high above the highest ground there. Throws as place_home does.
Vec3 on_the_ground(const Mission& mission, const std::array<double, 2>& at_deg, const PlaceOfFlight& place,
                   double above_m = 0);
/// Of coordinates as the mission's `crs` says.
Vec3 in_the_frame(const Mission& mission, const Vec3& position, const PlaceOfFlight& place);

}  // namespace vantage::internal::app
