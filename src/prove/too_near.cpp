#include "prove/too_near.h"

#include <optional>

#include "prove/tree_search.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {

void TooNear::look(const LimitedVolume& volume, const LimitedVolume::Corners& facet, FacetFinding& finding) const {
  const Box box = box_of(facet);
  double needed = distance_m - volume.tolerance_of(facet);
  search_tree(
      tree, [&](const Box& node) { return distance_of_boxes(node, box) >= needed; },
      [&](std::uint32_t i) {
        const std::array<Vec3, 3> triangle = tree.pieces[i].first_three();
        const NearestPoints nearest = nearest_points(facet, triangle);
        if (surely_apart_by(nearest, facet, triangle) >= needed) return;
        finding.is_open = true;
        finding.broken.see(distance_m - at_most_from(triangle, nearest.on_a), nearest.on_a);
        needed = nearest.distance;
      });
}

ClaimProof with_points_outside(const ClaimProof& claim, const LimitedVolume& volume, double distance_m,
                               const std::vector<Vec3>& points, const std::string& limit) {
  if (claim.verdict != ProofVerdict::proved) return claim;
  if (!points.empty() && !(distance_m > 2 * volume.tolerance_m())) {
    return not_proved(claim.name, "the distance is less than what numbers can tell");
  }
  for (const Vec3& point : points) {
    const std::optional<bool> is_outside = volume.is_outside(point);
    if (!is_outside) return not_proved(claim.name, "what it is about may be inside");
    if (!*is_outside) return volume.wrong(claim.name, {distance_m, point}, limit);
  }
  return claim;
}

}  // namespace vantage::internal::prove
