// How far what was lost lies from what is left.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "simplify/surface.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

struct FacetBound {
  std::uint32_t facet = 0;
  double bound_m = 0;       ///< without what is rounded
  std::uint32_t steps = 0;  ///< collapses, one after the other, that were added up: each was rounded
};

/// Keeps for each facet a bound: every point that was lost is bound to a point of one facet, and no farther from it
/// than the facet's bound. A collapse loses the tetrahedra between the patch's facets and the new place, and binds what
/// was bound to a facet, part by part, to facets that are left.
///
/// What is rounded in a step, in units of 2^-53 of the volume's size: corners are taken relative to the new place, 2
/// each; a cut of a part is off its line by 6, and a part is cut at most 37 times; distances, 8. That is less than 256.
class LostDistance {
 public:
  struct Lengths {
    double size_m = 0;   ///< of the volume: nothing is farther from anything else
    double worth_m = 0;  ///< bounds below it need not be tight; without a limit, it grows with them
    double flat_m = 0;   ///< sums of bounds up to it are always allowed: surfaces that are flat but for rounding
    std::optional<double> limit_m = {};  ///< other bounds may not be larger, with all that is rounded
  };

  LostDistance(std::size_t facets, const Lengths& lengths);

  /// Fills in the bounds after a collapse of those facets that get others; false where one is not allowed.
  bool after(const Surface& surface, const Patch& patch, const Vec3& place, std::vector<FacetBound>& bounds) const;

  /// The bound of facet `to` if whole facets are lost: all that was bound to them is then bound to a corner of it.
  FacetBound after_drop(const Surface& surface, std::span<const std::uint32_t> facets, std::uint32_t to) const;

  bool is_allowed(const FacetBound& bound) const;
  void set(const std::vector<FacetBound>& bounds);

  /// With all that is rounded.
  double largest_m(const Surface& surface) const;

 private:
  double with_rounding(const FacetBound& bound) const { return bound.bound_m + bound.steps * rounding_m_; }

  std::vector<FacetBound> bounds_;  ///< by facet
  Lengths lengths_;
  double rounding_m_;  ///< of a step
};

/// The largest distance from one of the points to the mesh's surface.
double farthest_m(const std::vector<Vec3>& points, const Mesh& mesh, const core::ProgressReporter& progress);

}  // namespace vantage::internal::simplify
