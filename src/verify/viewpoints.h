// Where the check looks from.
#pragma once

#include <vector>

#include "verify/closed_mesh.h"
#include "verify/random.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

struct Viewpoint {
  Vec3 position;         ///< local
  bool uniform = false;  ///< if inside the volume, then uniform over it and independent of the others
};

/// Draws viewpoint number i of n, from its random numbers alone. Of eight viewpoints four lie near the boundary, two
/// inside the volume, one anywhere in its bounding box and a tenth around it, one anywhere in the range's half ball, or
/// ball for a point that is seen from all sides.
class Viewpoints {
 public:
  /// Keeps references.
  Viewpoints(const ClosedMesh& volume, const TargetView& view, double max_range, std::size_t count);

  Viewpoint draw(std::size_t number, Random& random) const;

 private:
  Viewpoint inside(Random& random) const;
  Viewpoint around(Random& random) const;
  Viewpoint in_range(Random& random) const;
  Viewpoint near_boundary(std::size_t number, Random& random) const;
  Vec3 on_facet(std::size_t facet, Random& random) const;

  const ClosedMesh& volume_;
  const TargetView& view_;
  double max_range_;
  std::size_t count_;
  std::vector<double> area_;  ///< running sum over the facets, m2
};

}  // namespace vantage::internal::verify
