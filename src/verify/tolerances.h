// Every numeric constant of the check, with its derivation. Rounding errors and forgiven lengths never share a name.
#pragma once

#include <cstddef>
#include <limits>
#include <numbers>

namespace vantage::internal::verify {

/// In radians.
inline constexpr double kDegree = std::numbers::pi / 180;

/// Metres. Farther coordinates are refused: their products are no numbers, and neither are those that Embree makes.
inline constexpr double kFarthestCoordinate = 1e9;

/// Unit roundoff of a double.
inline constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;

/// Bound on the rounding error of normal · (point - corner), in units of |point - corner| times the squared longest
/// edge. Two rounded edges and their cross product lose less than 14 roundoffs of the squared edge (7 an axis, times
/// the square root of 3, rounded up), the difference and the dot product another 6; doubled and rounded up to a power
/// of two.
inline constexpr double kPlaneError = 64 * kRoundoff;

/// Bound on the rounding error of the place of a point along a unit axis, in units of the lengths in it: differences,
/// dot products and the axis' own length lose less than 12 roundoffs together; rounded up to a power of two.
inline constexpr double kApartError = 32 * kRoundoff;

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

/// A limit that is an angle is broken by more than this, in radians, or not at all: far above the rounding of a
/// direction, far below what a claim that is too deep is off by.
inline constexpr double kAngleSlack = 1e-12;

/// What enters the zone of a radio link by less than this part of its radius touches it: nanometres, and far more than
/// what rounding costs.
inline constexpr double kLinkGrazing = 1e-9;

/// A share of the target is missed by more than this, or not at all: the areas of cells, and the strips along their
/// outlines that numbers cannot tell, amount to less.
inline constexpr double kShareSlack = 1e-7;

/// ... beside what coordinates are rounded by, along the outlines of all cells, in roundoffs of the largest one.
inline constexpr double kOutlineRoundoffs = 64;

/// Bound on the rounding of a direction's place in a picture, in radians: a unit vector, two turned axes and a product
/// lose less than 30 roundoffs together.
inline constexpr double kAngleError = 64 * kRoundoff;

/// The search for an orientation gives up after so many cells, some milliseconds, ...
inline constexpr std::size_t kMostCells = 20000;

/// ... and does not halve those whose half sides, in radians, sum to less: in it a margin is linear but for 5e-13.
inline constexpr double kSmallestCell = 1e-6;

// What a computed volume may leave out at each limit besides: its surfaces are made of facets on the safe side.
// docs/camera.md states the same figures; what they forgive is only what a volume lacks, never what it claims.

/// The surface about what is too near lies farther out by up to this part of min_range.
inline constexpr double kMinRangeLoose = 2e-3;

/// The ball of the largest pixel loses up to this part of its radius.
inline constexpr double kPixelLoose = 5e-4;

/// Cones have this many sides. They stay inside the cone of the incidence and outside that of the sun: the tangent is
/// off by the cosine of pi over this.
inline constexpr int kConeSides = 128;

/// The surface of a camera on a gimbal lies farther out by up to about 1 % of the distance to the target's centre;
/// twice that, as the centre may be chosen in more than one way. Where the gimbal's pitch is the limit the surface runs
/// along the lines of sight: so the same holds for what lies beside a viewpoint.
inline constexpr double kFrameLoose = 2e-2;

/// The scene is grown by up to so many times the zone's radius: 1.25, as pieces count with their widest place, times
/// 1.16 of their polytopes; ...
inline constexpr double kLinkRadiusLoose = 1.45;

/// ... and by a little more, in metres: the least radius, and the triangle that stands for the antenna.
inline constexpr double kLinkLeastRadius = 5e-3;

/// How far boxes handed to Embree are grown, relative to the largest coordinate of any query. Embree walks its
/// hierarchy in single precision (roundoff 2^-24): the rounded origin, the rounded direction, the approximate
/// reciprocal and two fused operations each shift a box face by at most 2^-22 of that coordinate. 2^-18 is three times
/// their sum.
inline constexpr double kBoxGrowth = 1.0 / (1 << 18);

}  // namespace vantage::internal::verify
