// Cones about the normals, one at each corner, are convex.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "prove/largest_of_corners.h"
#include "prove/limit_proof.h"

namespace vantage::internal::prove {

template <>
ClaimProof prove_limit<Limit::incidence>(const double& incidence_deg, const Claimant& of,
                                         const core::ProgressReporter& /*progress*/) {
  check_has_plane(of, Limit::incidence);
  const double sine = std::sin(incidence_deg * std::numbers::pi / 180);
  const double cosine = std::cos(incidence_deg * std::numbers::pi / 180);
  return of.volume.judged_at_vertices("incidence", [&](const Vec3& vertex) {
    return largest_of_corners(of.parts, of.volume.origin(), vertex, [&](const Vec3& from, const Vec3& normal) {
      const double height = normal.dot(from);
      return (from - height * normal).norm() * cosine - height * sine;
    });
  });
}

}  // namespace vantage::internal::prove
