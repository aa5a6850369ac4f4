#include <vector>

#include "prove/limit_proof.h"
#include "prove/too_near.h"

namespace vantage::internal::prove {

template <>
ClaimProof prove_limit<Limit::min_range>(const double& min_range_m, const Claimant& of,
                                         const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  TooNear target{{}, min_range_m};
  std::vector<Piece> triangles;
  std::vector<Vec3> middles;
  for (const View& part : of.parts) {
    const Vec3 shift = part.origin - volume.origin();
    middles.push_back(shift);
    const std::vector<Vec3>& corners = part.whole;
    const Vec3 first = shift + corners[0];
    if (corners.size() == 1) triangles.push_back(Piece::triangle({first, first, first}, 0));
    for (std::size_t k = 2; k < corners.size(); ++k) {
      triangles.push_back(Piece::triangle({first, shift + corners[k - 1], shift + corners[k]}, 0));
    }
  }
  target.tree = make_tree(std::move(triangles));
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& facet, FacetFinding& finding) { target.look(volume, facet, finding); },
      progress);
  const std::string limit = "the least range";
  ClaimProof claim =
      volume.judged("min_range", findings, "no facet is too near to the target, which is outside", limit);
  return with_points_outside(claim, volume, min_range_m, middles, limit);
}

}  // namespace vantage::internal::prove
