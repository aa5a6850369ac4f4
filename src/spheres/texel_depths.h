// What a texel of a cube map says, for inner bounds.
#pragma once

#include <cmath>

#include "spheres/cube_grid.h"
#include "spheres/numerics.h"
#include "spheres/sphere_mesh.h"

namespace vantage::internal::spheres {

/// Nearest inverse depths, where texels behind the target count as empty.
class TexelDepths {
 public:
  TexelDepths(const CubeMap& cube, const CubeGrid& grid, const Vec3* front)
      : cube_(cube), grid_(grid), front_(front), half_(front ? front->lpNorm<1>() / cube.face_size : 0) {}

  /// 0: nothing there, or nothing that matters.
  float nearest(const FaceCell& texel) const {
    return front_ && is_behind(texel) ? 0 : cube_.inverse_depths[grid_.texel_index(texel)];
  }

 private:
  // Over the texel's square front . d varies about the centre by no more than half its side times |front|_1. What is in
  // the plane but for rounding is cut away there too.
  bool is_behind(const FaceCell& texel) const {
    const double middle = front_->dot(grid_.texel_direction(texel));
    return middle + half_ - std::abs((*front_)[texel.face / 2]) / cube_.face_size <= numerics::kInPlane;
  }

  const CubeMap& cube_;
  const CubeGrid& grid_;
  const Vec3* front_;
  double half_;
};

}  // namespace vantage::internal::spheres
