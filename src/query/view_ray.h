// A line of sight.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::query {

/// From the target's centre to the front. Scene frame.
struct ViewRay {
  Vec3 origin, direction;  ///< unit length
  double reach = 0;        ///< metres from the origin up to which the whole target is visible and in range; 0: nowhere

  Vec3 at(double distance) const { return origin + distance * direction; }
};

}  // namespace vantage::internal::query
