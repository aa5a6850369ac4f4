#include "geo/zone_reach.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage::internal::geo {

bool ZoneReach::holds(const Vec3& position) const {
  return position.head<2>().norm() <= farthest_m && lowest_m <= position.z() && position.z() <= highest_m;
}

ZoneReach zone_reach(const Mission& mission) {
  Box box = bounding_box(mission.scene().mesh);
  double offset = 0;
  const auto add = [&](const Target& target) {
    offset = std::max(offset, std::abs(target.offset_m));
    for (const std::vector<Vec3>& part : target.parts) {
      for (const Vec3& corner : part) box.extend(corner);
    }
    if (target.volume) box.extend(bounding_box(target.volume->mesh));
  };
  add(mission.target);
  for (const std::vector<Target>& view : mission.views) std::for_each(view.begin(), view.end(), add);
  if (mission.home) box.extend(*mission.home);
  if (box.empty()) return {};
  const double limit = range_limit_m(mission.sensor);
  const double range = (std::isfinite(limit) ? limit : ZoneReach::kAboutVolumesM) + offset;
  const double farthest = box.min.head<2>().cwiseAbs().cwiseMax(box.max.head<2>().cwiseAbs()).norm();
  ZoneReach reach{farthest + range, box.min.z() - range, box.max.z() + range};
  if (const auto& altitude = mission.navigation.altitude) {
    // Flights come up from below the lowest altitude, and are judged there too.
    reach.lowest_m = std::max(reach.lowest_m, std::min(altitude->min_m, box.min.z()));
    reach.highest_m = std::min(reach.highest_m, altitude->max_m);
  }
  return reach;
}

}  // namespace vantage::internal::geo
