// Whether a point sees all of a polygon, by the definition: no triangle of the scene may reach into the pyramid between
// them. No rays and no samples, but a loop over all triangles in extended precision. Shares nothing with the library.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::testing {

class ClipOracle {
 public:
  /// Copies what it needs. `polygon`: convex to rounding, counter-clockwise seen from its front; scene frame.
  ClipOracle(const Mesh& scene, const std::vector<Vec3>& polygon);

  /// Whether a triangle reaches into the pyramid between the viewpoint and the polygon, deeper than `margin` metres
  /// from each of its sides and its base. However thin it is, a triangle counts as much as a wide one.
  bool is_hidden_from(const Vec3& viewpoint, double margin) const;

 private:
  using Point = Eigen::Matrix<long double, 3, 1>;

  Point origin_, normal_;
  std::vector<Point> polygon_;
  std::vector<std::array<Point, 3>> triangles_;
};

}  // namespace vantage::testing
