// Whether what is hidden of a volume lies no deeper in it than rounding can have moved its surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "prove/rounded_surface.h"
#include "prove/scene_tree.h"
#include "prove/view.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// A position from which an obstacle O hides something is in B(O), a convex set that goes on away from c. So if it is
/// also on the way from c to a facet, it is in what B(O) and the tetrahedron of c and the facet have in common, which
/// is convex. Where each of a few pieces of that is near to places outside of the volume, or is outside itself, no
/// position that is deeper in the volume is hidden by O.
class Shallow {
 public:
  /// `mesh`: closed, about the origin of its view.
  Shallow(const Mesh& mesh, const View& view);

  /// Whether all that the obstacle hides on the ways to the facet, of View::inner, is nearer than `depth_m` to a place
  /// that the mesh does not wind round. Facets that bound nothing, as those of flaps and of shells inside of others, do
  /// not count. `depth_m`: at least 4096 roundings of the facet's coordinates.
  bool is_shallow(const std::array<Vec3, 3>& facet, const Piece& obstacle, double depth_m) const;

 private:
  const View& view_;
  RoundedSurface surface_;
  Vec3 front_;
};

}  // namespace vantage::internal::prove
