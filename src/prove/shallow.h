// Whether what is hidden of a volume lies no deeper below its surface than rounding can have moved that.
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
/// is convex. Where each of a few pieces of that is near to one facet, or is not in the volume, no position that is
/// deeper below its surface is hidden by O.
class Shallow {
 public:
  /// `mesh`: closed, about the origin of its view.
  Shallow(const Mesh& mesh, const View& view);

  /// Whether all that the obstacle hides on the ways to the facet is nearer than `depth_m` to some facet of the mesh.
  bool is_shallow(const std::array<Vec3, 3>& facet, const Piece& obstacle, double depth_m) const;

 private:
  std::vector<Vec3> outline_, target_;  ///< View::corners, and a strip of four margins less
  RoundedSurface surface_;
  Vec3 front_;
};

}  // namespace vantage::internal::prove
