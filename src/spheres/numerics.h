// The numeric constants of this module, with their derivations. Lengths in metres.
#pragma once

namespace vantage::internal::spheres::numerics {

/// A sphere mesh reaches at least this far along the longest axis of every direction, so that its facets have an area
/// and it is star-shaped about the viewpoint, also where a surface begins at the viewpoint itself. It is the one
/// over-claim of a conservative sphere: within sqrt(3) times this of the viewpoint, two micrometres, where no vehicle
/// is. Well above what booleans resolve (1e-12 of the range).
inline constexpr double kFloor = 1e-6;

/// Every radius of a conservative sphere is shortened by this part: ten thousand times what 1 / w, range / |d|, the
/// turn into the target's frame and the way back to the scene frame can cost in doubles (a few 2^-53 each), and 0.6
/// micrometres at 600 m.
inline constexpr double kShrink = 1e-9;

/// A direction (longest axis 1) less than this above or below the target's plane lies in it: rounding of the
/// directions is 1e-16, and the height that is dropped is 0.6 micrometres at 600 m.
inline constexpr double kInPlane = 1e-9;

/// How much the ranges of longitude and latitude of a texel are widened, in radians, so that rounding of atan2 never
/// leaves out a cell that the texel touches.
inline constexpr double kAngle = 1e-9;

/// A piece whose volume is less than its area times this many epsilons of the booleans is rounding error, not space.
inline constexpr double kSliverEpsilons = 10;

}  // namespace vantage::internal::spheres::numerics
