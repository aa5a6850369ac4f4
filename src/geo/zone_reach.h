// How far from the scene zones of the earth are asked about.
#pragma once

#include "vantage/geometry.h"
#include "vantage/mission.h"

namespace vantage::internal::geo {

/// Where positions may be that a mission's limits are asked about: no farther from the box about the scene, the targets
/// and the home of a tour than the sensor's range, and below the highest altitude. Nothing is in an empty one. A
/// mission of volumes alone has no range.
struct ZoneReach {
  double farthest_m = 0;               ///< from the origin, in plan
  double lowest_m = 0, highest_m = 0;  ///< z

  static constexpr double kAboutVolumesM = 500;  ///< in place of that range

  bool holds(const Vec3& position) const;
};

/// `mission`: with its targets, and `home`, in the frame.
ZoneReach zone_reach(const Mission& mission);

}  // namespace vantage::internal::geo
