// Every numeric constant of the check, with its derivation. Rounding errors and forgiven lengths never share a name.
#pragma once

#include <limits>

namespace vantage::internal::verify {

/// Unit roundoff of a double.
inline constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;

/// Bound on the rounding error of normal · (point - corner), in units of |point - corner| times the squared longest
/// edge. Two rounded edges and their cross product lose less than 14 roundoffs of the squared edge (7 an axis, times
/// the square root of 3, rounded up), the difference and the dot product another 6; doubled and rounded up to a power
/// of two.
inline constexpr double kPlaneError = 64 * kRoundoff;

/// A triangle thinner than this, relative to its longest edge, has a normal that is mostly rounding error: it hides
/// nothing.
inline constexpr double kThinnest = 64 * kRoundoff;

/// A crossing closer to the triangle's border than this (barycentric: relative to the triangle's height) grazes it.
inline constexpr double kGrazing = 1e-9;

/// A crossing closer than this to either end of the segment, relative to its length, is at the end: the segment is
/// open.
inline constexpr double kEnd = 1e-9;

/// Crossings lower than this over the target, and not farther than this outside its outline, belong to the surface that
/// the target lies on. Metres; part of the definition in vantage/verify.h.
inline constexpr double kSurfaceHeight = 1e-3;

/// A point has no surface: crossings closer to it than this, in metres, are what it lies on, and only those. The engine
/// keeps a point more than ten times as far from what it lies on; coordinates are relative to the point and lose
/// nothing.
inline constexpr double kPointSurface = 1e-7;

/// Relative slack of the range check: far above rounding, far below the depth tolerance of a claim.
inline constexpr double kRangeSlack = 1e-9;

/// How far boxes handed to Embree are grown, relative to the largest coordinate of any query. Embree walks its
/// hierarchy in single precision (roundoff 2^-24): the rounded origin, the rounded direction, the approximate
/// reciprocal and two fused operations each shift a box face by at most 2^-22 of that coordinate. 2^-18 is three times
/// their sum.
inline constexpr double kBoxGrowth = 1.0 / (1 << 18);

}  // namespace vantage::internal::verify
