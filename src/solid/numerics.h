// Every numeric constant of this room, with where it comes from. What the user asks for (tolerance_m) is not here:
// these are allowances for rounding.
#pragma once

namespace vantage::solid::numerics {

/// Parts of a navigation mesh that meet less deeply than this times the diagonal of the mesh's bounding box count as
/// touching. Single-precision files round each coordinate by 6e-8 of its size, so two walls drawn flush may cross by
/// 2 * sqrt(3) times that, and by a few times more where a narrow triangle is tilted.
constexpr double kTouching = 1e-6;

/// A crossing is looked at again with this part of the touching distance: well above the rounding of coordinates (1e-16
/// of the diagonal), and so little that what is nearer counts as touching anyway.
constexpr double kClosely = 1e-3;

/// How far off a facet, in units of the touching distance, winding numbers are taken: outside the zone in which
/// surfaces count as touching, and still close to the facet.
constexpr double kSampleOffset = 10;

/// Cut faces are put back into their planes exactly. A boolean operation leaves them within its epsilon (1e-12 of the
/// largest local coordinate), and adding the local origin back rounds once more; anything farther off is a defect.
constexpr double kSnapEpsilons = 100;

/// A piece whose volume is less than its area times this many epsilons of the booleans is rounding error, not space.
constexpr double kSliverEpsilons = 10;

/// Boxes that stand for half-spaces reach beyond the volume by this part of its diagonal, so that only the face that is
/// meant can cut it.
constexpr double kOvershoot = 0.125;

}  // namespace vantage::solid::numerics
