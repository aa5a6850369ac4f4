// Whether a point is nearer to obstacles than a clearance, for the check.
#pragma once

#include <optional>
#include <vector>

#include "vantage/navigation.h"
#include "verify/box_index.h"

namespace vantage::internal::verify {

class ObstacleProbe {
 public:
  /// Throws Error(input) for a clearance that is not positive, and one without obstacles.
  explicit ObstacleProbe(const Clearance& clearance);

  /// Whether the point (scene frame) is nearer to a triangle than the clearance, by more than rounding. `slack`: than
  /// so many times the clearance more.
  bool is_too_near(const Vec3& point, double slack = 0) const;

 private:
  Clearance clearance_;
  double allowance_m_ = 0;  ///< for rounding
  Box bounds_;              ///< of all that may be too near
  std::optional<BoxIndex> index_;
};

}  // namespace vantage::internal::verify
