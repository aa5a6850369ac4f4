#include "target/lengths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace vantage::internal::target {
namespace {

// The rounding of coordinates: as they are given, about the scene's origin, and in the target's frame.
double coordinate_rounding(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range) {
  const double largest = frame.origin.cwiseAbs().maxCoeff() + (frame.origin - scene.origin).cwiseAbs().maxCoeff() +
                         frame.enclosing_radius_m + max_range;
  return numerics::kRoundings * std::numeric_limits<double>::epsilon() * largest;
}

}  // namespace

Lengths lengths_of(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range) {
  const double rounding = coordinate_rounding(scene, frame, max_range);
  const double slack = std::max(rounding, numerics::kOnTarget * std::min(1.0, frame.enclosing_radius_m));
  const double small = std::min(1.0, max_range / numerics::kFullRange);
  const double clear = std::max(numerics::kClear * small, 4 * slack);
  return {rounding, slack, clear, std::max(numerics::kMaxLift * small, 4 * clear)};
}

}  // namespace vantage::internal::target
