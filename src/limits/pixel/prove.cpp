// d * d / (f h) <= size: the ball that touches the target's plane in the corner and is size * f high.
#include "prove/largest_of_corners.h"
#include "prove/limit_proof.h"

namespace vantage::internal::prove {

template <>
ClaimProof prove_limit<Limit::pixel>(const PixelLimit& pixel, const Claimant& of,
                                     const core::ProgressReporter& /*progress*/) {
  check_has_plane(of, Limit::pixel);
  const double height_m = pixel.size_m * *of.sensor.camera->focal_px;
  return of.volume.judged_at_vertices("pixel", [&](const Vec3& vertex) {
    return largest_of_corners(of.parts, of.volume.origin(), vertex, [&](const Vec3& from, const Vec3& normal) {
      return (from - height_m / 2 * normal).norm() - height_m / 2;
    });
  });
}

}  // namespace vantage::internal::prove
