// What the corners of a target say of a position.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "prove/view.h"

namespace vantage::internal::prove {

/// The largest of what a function says of a position relative to a corner, and the normal of its part.
template <typename Excess>
double largest_of_corners(const std::vector<View>& parts, const Vec3& origin, const Vec3& position,
                          const Excess& excess) {
  double most = -std::numeric_limits<double>::infinity();
  for (const View& part : parts) {
    for (const Vec3& corner : part.whole) {
      most = std::max(most, excess(Vec3(position - (part.origin - origin + corner)), part.normal));
    }
  }
  return most;
}

}  // namespace vantage::internal::prove
