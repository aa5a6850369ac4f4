// The directions in which one convex polygon is seen.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <vector>

#include "exact/octahedral_map.h"

namespace vantage::internal::exact {

/// The cone over a convex polygon, as far as it decides which cells of the octahedral map the polygon misses.
class PolygonCone {
 public:
  /// Corners in order, z >= 0, in a plane that does not pass through the origin.
  void assign(std::span<const Vec3> corners) {
    corners_.assign(corners.begin(), corners.end());
    for (Vec3& c : corners_) c /= c.lpNorm<1>();
    sides_.clear();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& c : corners_) middle += c;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec3 side = corners_[i].cross(corners_[(i + 1) % corners_.size()]);
      sides_.push_back(side.dot(middle) < 0 ? Vec3(-side) : side);
    }
  }

  /// True only if no direction of the cell meets the polygon.
  bool misses(const OctahedralCell& cell) const {
    const double sx = cell.quadrant & 1 ? -1 : 1, sy = cell.quadrant & 2 ? -1 : 1;
    bool left = true, right = true, under = true, over = true;
    for (const Vec3& c : corners_) {
      const double x = sx * c.x(), y = sy * c.y(), sum = x + y + c.z();
      left = left && x < cell.a * sum - kMargin;
      right = right && x > (cell.a + cell.size) * sum + kMargin;
      under = under && y < cell.b * sum - kMargin;
      over = over && y > (cell.b + cell.size) * sum + kMargin;
    }
    if (left || right || under || over) return true;
    return std::any_of(sides_.begin(), sides_.end(), [&](const Vec3& side) {
      const CellCorners values = cell.at_corners(on_quadrant(side, cell.quadrant));
      return *std::max_element(values.begin(), values.end()) < -kMargin;
    });
  }

 private:
  static constexpr double kMargin = 1e-8;  // corners and sides are at most about 1; polygons are not quite planar

  std::vector<Vec3> corners_, sides_;
};

}  // namespace vantage::internal::exact
