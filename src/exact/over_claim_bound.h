// How far the gauge rises above a facet anywhere on it: the check that a facet claims nothing that is hidden.
#pragma once

#include <array>
#include <vector>

#include "exact/direction_tree.h"

namespace vantage::internal::exact {

/// One for each thread.
class OverClaimBound {
 public:
  /// Keeps references.
  OverClaimBound(const BlockerSet& blockers, const DirectionTree& tree) : blockers_(blockers), tree_(tree) {}

  /// An upper bound on how far, in parts of the distance, a facet reaches into a blocker: 0 where none of them holds
  /// more than `allowed` of it. The facet has its corners at `points` of one quadrant of the octahedral map, with these
  /// inverse depths. Range is not looked at: its gauge is convex.
  double greatest_rise(int quadrant, const std::array<OctahedralPoint, 3>& points, const std::array<double, 3>& gauges,
                       double allowed);

 private:
  using Weights = Eigen::Vector3d;  // of the corners; also a linear function by its values at the corners

  double rise_of(std::uint32_t blocker, double allowed);
  double rise_in(const DirectionTree::Leaf& leaf, double allowed);
  Weights rise_of_plane(const Plane& plane) const {
    return {plane.dot(corners_[0]) - 1, plane.dot(corners_[1]) - 1, plane.dot(corners_[2]) - 1};
  }

  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  std::vector<const DirectionTree::Leaf*> leaves_;
  std::array<Vec3, 3> corners_;  // of the facet
  std::vector<Weights> rises_, part_, scratch_;
};

}  // namespace vantage::internal::exact
