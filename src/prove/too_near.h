// What must be kept at a distance: obstacles, and the target. What lies too near to a triangle is convex, and holds it:
// no facet is so near, and one point of it is outside.
#pragma once

#include <string>
#include <vector>

#include "prove/limited_volume.h"
#include "prove/scene_tree.h"

namespace vantage::internal::prove {

/// Triangles to keep a distance from.
struct TooNear {
  SceneTree tree;
  double distance_m = 0;

  void look(const LimitedVolume& volume, const LimitedVolume::Corners& facet, FacetFinding& finding) const;
};

/// A claim about facets, and that points are outside of which no facet is near.
ClaimProof with_points_outside(const ClaimProof& claim, const LimitedVolume& volume, double distance_m,
                               const std::vector<Vec3>& points, const std::string& limit);

}  // namespace vantage::internal::prove
