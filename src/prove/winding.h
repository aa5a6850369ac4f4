// How often a closed surface winds round a point.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// Add every triangle, then ask.
class Winding {
 public:
  explicit Winding(const Vec3& point) : point_(point) {}

  void add(const std::array<Vec3, 3>& corners);

  /// Nothing where a triangle is as near as `unsure_m`: on which side of it the point lies is then not known.
  std::optional<int> turns(double unsure_m) const;

 private:
  Vec3 point_;
  double angle_ = 0;
  double nearest_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace vantage::internal::prove
