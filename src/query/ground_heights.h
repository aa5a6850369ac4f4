// How high the ground is at a place, and where lines come to a height above it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/bvh.h"
#include "vantage/ground.h"

namespace vantage::internal::query {

class GroundHeights {
 public:
  /// Cost: O(n log n) in the triangles.
  explicit GroundHeights(Ground ground);

  /// z of the lowest and the highest piece of ground at a place. Nothing where there is no ground. A place within a few
  /// roundings of the border of the ground may be taken for either side.
  struct Range {
    double lowest_m, highest_m;
  };
  std::optional<Range> at(double x, double y) const;

  /// Distances along the line (unit direction) up to `reach` where it comes to `above_m` above a triangle, or in plan
  /// to the border of the ground; and some where it does not.
  void add_crossings(const Vec3& origin, const Vec3& direction, double reach, double above_m,
                     std::vector<double>& out) const;

 private:
  void add_border_crossing(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b,
                           std::vector<double>& out) const;

  Ground ground_;
  struct Piece {
    std::uint32_t triangle;
    bool is_at_border;
  };
  std::vector<Piece> pieces_;  ///< in the order of the hierarchy's leaves
  core::Bvh bvh_;              ///< of the triangles in plan: z is 0
};

}  // namespace vantage::internal::query
