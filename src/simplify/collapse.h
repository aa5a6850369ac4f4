// Where an edge may be collapsed to, what is lost by it, and whether the surface stays clean.
#pragma once

#include <optional>
#include <vector>

#include "simplify/surface.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

/// A point to which an edge may be collapsed, as far as rounded numbers tell.
struct Place {
  Vec3 at = Vec3::Zero();
  double loss_m3 = 0;
  bool is_new = false;  ///< not one of the edge's ends
};

/// The places on the inner side of all facets of the patch, the one that loses least first: a new one, and the ends.
void find_places(const Surface& surface, const Patch& patch, std::vector<Place>& places);

/// Whether `place` lies exactly on the inner side, or in the plane, of every facet of the patch.
bool is_inner(const Surface& surface, const Patch& patch, const Vec3& place);

/// Whether the patch's facets, moved to `place`, are wider than `narrowest_m`, have no point with other facets besides
/// the vertices and edges that they share, and are not folded onto their neighbours or as near as `narrowest_m`; and no
/// other piece lies in what is lost.
bool is_clean(const Surface& surface, const Patch& patch, const Vec3& place, double narrowest_m);

}  // namespace vantage::internal::simplify
