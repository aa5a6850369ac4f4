#include "prove/winding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prove/distance.h"

namespace vantage::internal::prove {

/// Signed solid angles (van Oosterom and Strackee 1983).
void Winding::add(const std::array<Vec3, 3>& corners) {
  const Vec3 a = corners[0] - point_, b = corners[1] - point_, c = corners[2] - point_;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  angle_ += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  nearest_m_ = std::min(nearest_m_, distance_from(point_, corners));
}

std::optional<int> Winding::turns(double unsure_m) const {
  const double turns = angle_ / (4 * std::numbers::pi);
  constexpr double kSure = 0.01;
  if (!(nearest_m_ > unsure_m && std::abs(turns - std::round(turns)) < kSure)) return std::nullopt;
  return static_cast<int>(std::lround(turns));
}

}  // namespace vantage::internal::prove
