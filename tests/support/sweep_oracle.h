// How much of a polygon a point sees, by the definition: every triangle of the scene is clipped to the pyramid between
// them in space and projected, and a sweep over the plane adds up the gaps between the shadows. In extended precision,
// without samples; shares nothing with the library but the frame of the target.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/target.h"

namespace vantage::testing {

/// By area, solid angle and image area; the image's camera looks along the axis of the narrowest cone about the target.
struct SweptMeasures {
  long double area = 0, solid_angle = 0, pixels = 0;
};

struct SweptFraction {
  SweptMeasures seen, all;
};

class SweepOracle {
 public:
  /// Copies what it needs.
  SweepOracle(const Mesh& scene, const TargetFrame& frame);

  /// `eye` in front of the target and on no triangle. Cost: cubic in the triangles that hide some of it.
  SweptFraction look_from(const Vec3& eye) const;

 private:
  using Point = Eigen::Matrix<long double, 3, 1>;
  using Flat = Eigen::Matrix<long double, 2, 1>;

  std::vector<Flat> shadow_of(const std::array<Point, 3>& triangle, const Point& eye) const;
  Point local(const Vec3& point) const;

  TargetFrame frame_;
  std::vector<Flat> polygon_;
  std::vector<std::array<Point, 3>> triangles_;
};

}  // namespace vantage::testing
