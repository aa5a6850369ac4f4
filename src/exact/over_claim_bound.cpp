#include "exact/over_claim_bound.h"

#include <algorithm>
#include <limits>

namespace vantage::internal::exact {

double OverClaimBound::greatest_rise(int quadrant, const std::array<OctahedralPoint, 3>& points,
                                     const std::array<double, 3>& gauges, double allowed) {
  for (std::size_t i = 0; i < 3; ++i) corners_[i] = to_direction(points[i]) / gauges[i];
  leaves_.clear();
  tree_.leaves_over(quadrant, points, leaves_);
  double greatest = 0;
  for (const DirectionTree::Leaf* leaf : leaves_) greatest = std::max(greatest, rise_in(*leaf, allowed));
  return greatest;
}

// The few planes that the leaf keeps of a blocker nearly always tell that it stays under the facet.
double OverClaimBound::rise_in(const DirectionTree::Leaf& leaf, double allowed) {
  const auto stays_under = [&](std::uint32_t plane) {
    return rise_of_plane(blockers_.planes[plane]).maxCoeff() <= allowed;
  };
  double greatest = 0;
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    if (std::none_of(leaf.planes.begin() + leaf.first_plane[i], leaf.planes.begin() + leaf.first_plane[i + 1],
                     stays_under))
      greatest = std::max(greatest, rise_of(leaf.blockers[i], allowed));
  }
  return greatest;
}

// Over the facet each plane of the blocker rises linearly. Where all of them rise more than is allowed is a convex
// part of the facet, and the blocker rises there no more than any one plane does.
double OverClaimBound::rise_of(std::uint32_t blocker, double allowed) {
  rises_.clear();
  for (const Plane& plane : blockers_.planes_of(blocker)) {
    const Weights rise = rise_of_plane(plane);
    if (rise.maxCoeff() <= allowed) return 0;
    rises_.push_back(rise);
  }
  part_.assign({Weights::UnitX(), Weights::UnitY(), Weights::UnitZ()});
  for (const Weights& rise : rises_) {
    if (rise.minCoeff() >= allowed) continue;
    scratch_.clear();
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const Weights &from = part_[i], &to = part_[i + 1 == part_.size() ? 0 : i + 1];
      const double a = rise.dot(from) - allowed, b = rise.dot(to) - allowed;
      if (a >= 0) scratch_.push_back(from);
      if ((a > 0 && b < 0) || (a < 0 && b > 0)) scratch_.push_back(from + a / (a - b) * (to - from));
    }
    part_.swap(scratch_);
    if (part_.size() < 3) return 0;
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Weights& rise : rises_) {
    double greatest = 0;
    for (const Weights& corner : part_) greatest = std::max(greatest, rise.dot(corner));
    least = std::min(least, greatest);
  }
  return least;
}

}  // namespace vantage::internal::exact
