// Zones of a coordinate reference system in the scene frame.
#pragma once

#include <Eigen/Core>
#include <functional>

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
/// twice what they curve by. A corner moves farther, by that over the sine of half its angle. z is left alone.
///
/// Throws Error(input) for a zone of which nothing lies within geo::kFarthestM of the frame's origin, for one that
/// reaches farther than kFarthestCornerM, and for one that is narrower than what its sides are moved by. Where is
/// empty. `order_advice`: what to do about coordinates that lead far away.
Zone placed_zone(const Zone& zone, ZoneUse use, const ToFrame& to_frame, const char* order_advice);

/// The frame's distances are no longer good there.
inline constexpr double kFarthestCornerM = 3000e3;

}  // namespace vantage::internal::app
