// How far what was lost lies from what is left.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "simplify/surface.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

struct FacetBound {
  std::uint32_t facet = 0;
  double bound_m = 0;
};

/// Keeps for each facet a bound: every point that was lost is bound to a point of one facet, and no farther from it
/// than the facet's bound. A collapse loses the tetrahedra between the patch's facets and the new place, and binds what
/// was bound to a facet, part by part, to facets that are left.
class LostDistance {
 public:
  /// Bounds below `worth_m` need not be tight; with a limit, that does not grow with them.
  LostDistance(std::size_t facets, double worth_m, bool is_limited)
      : bound_m_(facets, 0.0), worth_m_(worth_m), is_limited_(is_limited) {}

  /// Fills in the bounds after a collapse of those facets that get others; returns the largest of these,
  /// or the first that is found to be above the limit.
  double after(const Surface& surface, const Patch& patch, const Vec3& place, double limit_m,
               std::vector<FacetBound>& bounds) const;

  void set(const std::vector<FacetBound>& bounds);

  /// The bound of facet `to` if whole facets are lost: all that was bound to them is then bound to a corner of it.
  double after_drop(const Surface& surface, std::span<const std::uint32_t> facets, std::uint32_t to) const;

  double largest_m(const Surface& surface) const;

 private:
  std::vector<double> bound_m_;
  double worth_m_;
  bool is_limited_;
};

/// The largest distance from one of the points to the mesh's surface.
double farthest_m(const std::vector<Vec3>& points, const Mesh& mesh, const core::ProgressReporter& progress);

}  // namespace vantage::internal::simplify
