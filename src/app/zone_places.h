// Zones of a coordinate reference system in the scene frame.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "geo/on_globe.h"
#include "geo/zone_reach.h"
#include "vantage/mission.h"
#include "vantage/navigation.h"

namespace vantage::internal::app {

enum class ZoneUse {
  keep_in,  ///< may shrink, and never grows
  keep_out  ///< may grow, and never shrinks
};

/// x and y of the scene frame for a position of another system.
using ToFrame = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

/// A zone whose sides are straight in another system. In the frame they curve (a parallel of 2 km at 45 degrees by
/// 8 cm): each is cut into parts that curve by no more than a tenth of a millimetre (more where that takes more than
/// 256 parts of a side, or Zone::kMostCorners), and all of them are moved inward (keep_in) or outward (keep_out) by
/// twice what they curve by, and by `lean_m` (ZoneWalls). A corner moves farther, by that over the sine of half its
/// angle. z is left alone.
///
/// Throws Error(input) for a zone of which nothing lies within geo::kFarthestM of the frame's origin, for one that
/// reaches farther than kFarthestCornerM, and for one that is narrower than what its sides are moved by. Where is
/// empty. `order_advice`: what to do about coordinates that lead far away.
Zone placed_zone(const Zone& zone, ZoneUse use, const ToFrame& to_frame, const char* order_advice, double lean_m = 0);

struct Heights {
  double low_m = 0, high_m = 0;
};

/// How far from the origin a zone is, in plan.
struct Extent {
  double nearest_m = 0, farthest_m = 0;
};
Extent extent_of(const Box& box);  ///< z is not used
Extent extent_of(const Zone::Ring& ring, const ToFrame& to_frame);

/// Zones are upright on the earth, and level. In the frame of a scene from a tileset their walls lean, by d / R at the
/// distance d from the origin, and their floors and ceilings fall away, by d * d / 2R. They become upright and level
/// there: with walls where the zone is in the middle of the heights that positions may have, moved to the safe side by
/// what it leans by from there, and floors and ceilings at the safe one of their bounds. That is so within the
/// reach (geo::ZoneReach). In a map all is as it is.
class ZoneWalls {
 public:
  /// `mission`: with its targets in the frame.
  ZoneWalls(const geo::OnGlobe& globe, const Mission& mission);

  /// `heights`: of the zone, above the zero of the scene's heights; they may be infinite.
  double middle_z_m(const Heights& heights) const;
  double lean_m(const Heights& heights, double farthest_m) const;
  /// Throws Error(input) where a zone to stay in is too low to hold a level; `where` is empty.
  Heights z_of(const Heights& heights, const Extent& extent, ZoneUse use) const;

 private:
  Heights within_reach(const Heights& heights) const;

  bool is_map_;
  geo::ZoneReach reach_;
};

/// The frame's distances are no longer good there.
inline constexpr double kFarthestCornerM = 3000e3;

}  // namespace vantage::internal::app
