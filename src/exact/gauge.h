// The envelope, evaluated: docs/theory.md, "The gauge".
#pragma once

#include <algorithm>
#include <limits>

#include "exact/direction_tree.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// What bounds the view in one direction.
struct GaugeValue {
  static constexpr std::uint32_t kRange = ~0u;
  double value;           ///< inverse depth, for a direction of |x| + |y| + z = 1
  std::uint32_t blocker;  ///< index of the blocker, or kRange
};

/// The greatest inverse depth over the range region and the blockers that the tree lists. Exact to rounding.
inline GaugeValue evaluate_gauge(const BlockerSet& blockers, const DirectionTree& tree,
                                 const target::RangeRegion& range, const OctahedralPoint& point) {
  const Vec3 direction = to_direction(point);
  GaugeValue greatest{range.gauge(direction), GaugeValue::kRange};
  const DirectionTree::Leaf& leaf = tree.leaf_at(point);
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = leaf.first_plane[i]; k < leaf.first_plane[i + 1]; ++k) {
      least = std::min(least, blockers.planes[leaf.planes[k]].dot(direction));
      if (least <= greatest.value) break;
    }
    if (least > greatest.value) greatest = {least, leaf.blockers[i]};
  }
  return greatest;
}

}  // namespace vantage::internal::exact
