// Every numeric constant of this module, with where it comes from. What the user asks for (tolerance_m) is not here:
// these are allowances for rounding.
#pragma once

#include <cstddef>

namespace vantage::internal::solid::numerics {

/// Cut faces are put back into their planes exactly. A boolean operation leaves them within its epsilon (1e-12 of the
/// largest local coordinate), and adding the local origin back rounds once more; anything farther off is a defect.
constexpr double kSnapEpsilons = 100;

/// A piece whose volume is less than its area times this many epsilons of the booleans is rounding error, not space.
constexpr double kSliverEpsilons = 10;

/// Boxes that stand for half-spaces reach beyond the volume by this part of its diagonal, so that only the face that is
/// meant can cut it.
constexpr double kOvershoot = 0.125;

/// Cleaning after booleans takes away edges shorter than this part of the volume's tolerance: a micrometre at the usual
/// centimetre, and nothing that anyone asked for.
constexpr double kCleanPart = 1e-4;

/// ... and than this part of the volume's diagonal, whatever the tolerance,
constexpr double kCleanLargest = 1e-6;

/// ... but no less than this many times what booleans, and coordinates in the scene frame, resolve: two vertices that
/// stay must stay two.
constexpr double kCleanEpsilons = 16;

/// How far cleaning may move a vertex in all, in lengths of the edges that it takes away: a few merges in a row.
constexpr double kFarthestMove = 4;

/// What merges in a row may add to the solid, in epsilons of the booleans.
constexpr double kMostRaises = 10;

/// Vertices nearer to each other than this part of the edges that go, and than kMostRaises epsilons, are merged
/// whatever that adds: to programs that join vertices (some do to 1e-8) they are one. 1e-8 m at the usual tolerance,
/// 6e-9 m in a volume of 600 m.
constexpr double kMergeAnyway = 1e-2;

/// A facet narrower than this part of the edges that go has no direction to keep: rounding tilts it by a degree and
/// more.
constexpr double kTurnable = 1e-3;

/// The bounds of the farthest point agree to this part of it.
constexpr double kFarthestPart = 0.01;

/// ... or to this part of the diagonal of both solids: rounding of distances, and of the booleans.
constexpr double kNegligible = 1e-12;

/// Pieces of facets, and cubes of space, that are looked at before the two bounds are left apart: seconds, and some
/// hundred megabytes.
constexpr std::size_t kMostPatches = 2'000'000, kMostCells = 300'000;

/// With more facets than this near a cube it is halved before a point behind all of them is looked for.
constexpr std::size_t kMostFacetsOfCell = 2000;

/// How far behind all facets that point must lie, in parts of the space that they lie in: well above rounding.
constexpr double kKernelMargin = 1e-10;

/// Facets for the surface about a target that is nearer than the least range lie farther out by up to this part of it,
constexpr double kMinRangeShare = 2e-3;

/// and sides of those for the largest pixel farther in by this part of the distance from a point deep inside: less than
/// a thousandth of the volume.
constexpr double kPixelShare = 5e-4;

/// Vertices of facets that must lie inside of a curved surface are moved in by this part of their distance: rounding.
constexpr double kInward = 1e-12;

/// Facets of limits have no longer sides than this part of the range: what booleans cost grows with their boxes.
constexpr double kLongestSide = 1.0;

/// A camera that can look at a point from anywhere may not come nearer to it than this part of the range.
constexpr double kLeastDistance = 1e-6;

}  // namespace vantage::internal::solid::numerics
