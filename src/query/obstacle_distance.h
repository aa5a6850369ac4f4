// Which points are nearer to obstacles than a clearance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "vantage/navigation.h"

namespace vantage::internal::query {

class ObstacleDistance {
 public:
  /// Cost: O(n log n) in the triangles.
  explicit ObstacleDistance(const Clearance& clearance);

  /// Whether a triangle is nearer than the clearance.
  bool is_too_near(const Vec3& point) const;

  /// Distances along the line (unit direction) up to `reach` where it comes to the clearance from a triangle; and some
  /// where it does not.
  void add_crossings(const Vec3& origin, const Vec3& direction, double reach, std::vector<double>& out) const;

 private:
  std::array<Vec3, 3> corners(std::uint32_t item) const;

  Clearance clearance_;
  std::vector<std::uint32_t> triangles_;  ///< in the order of the hierarchy's leaves
  core::Bvh bvh_;                         ///< of boxes that are grown by the clearance
};

}  // namespace vantage::internal::query
