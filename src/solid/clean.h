// Takes away what booleans leave of surfaces that all but coincide: edges and facets as small as rounding.
#pragma once

#include <cstddef>
#include <span>

#include "solid/csg.h"
#include "solid/regions.h"

namespace vantage::internal::solid {

struct CleaningLimits {
  double distance_m = 0;   ///< edges shorter than this go, and facets narrower
  double allowance_m = 0;  ///< what booleans may be off by, Solid::epsilon()
  /// False between booleans, where edges as short as rounding go: what then passes through itself, booleans have left
  /// so.
  bool is_checked = true;
};

struct Cleaning {
  std::size_t merged = 0;  ///< pairs of vertices that became one
  std::size_t left = 0;    ///< edges shorter than the distance that had to stay
  double moved_m = 0;      ///< no vertex, and so no point of the surface, has moved farther
};

/// Distances that suit a volume: a ten-thousandth of its tolerance, but well above what coordinates in the scene frame
/// and booleans resolve, and far below its size.
CleaningLimits cleaning_limits(double tolerance_m, double allowance_m, const Box& scene_bounds);

/// Merges the ends of short edges, and in narrow facets a corner with the side across from it, where the solid loses by
/// it: what a merge adds is thinner than the allowance, or than ten where the two are no farther apart than that and
/// than a hundredth of the distance. All merges together add no more than twenty allowances. No point of the surface
/// moves by more than numerics::kFarthestMove distances, and, if that is checked, no facet moves out through the other
/// side of the solid: where one would, vertices stay. The mesh must be closed with two triangles to an edge, as to_mesh
/// makes it, and stays so; it is in the scene frame, where `sources` (by label; none: no planes) say which facets lie
/// in a plane: those stay in it. `origin`: near the mesh. docs/theory.md, "Cleaning", has the argument. Cost: O(n log
/// n).
Cleaning clean_inward(LabelledMesh& labelled, const Vec3& origin, std::span<const FacetSource> sources,
                      const CleaningLimits& limits);

}  // namespace vantage::internal::solid
