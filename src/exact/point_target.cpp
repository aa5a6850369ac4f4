#include "exact/point_target.h"

#include <Eigen/Geometry>
#include <cmath>

#include "exact/target_check.h"

namespace vantage::exact {
namespace {

TargetFrame with_triangle(TargetFrame frame) {
  const double half = 0.5 * std::sqrt(3.0) * kPointRadius;
  frame.polygon = {{kPointRadius, 0}, {-0.5 * kPointRadius, half}, {-0.5 * kPointRadius, -half}};
  frame.enclosing_radius_m = kPointRadius;
  return frame;
}

// Scenes are full of surfaces near the horizontal and the vertical through a point, and the engine is coarse beside
// geometry that all but lies in its plane. This one is steeper than roofs are, and along no street.
TargetFrame tilted(const TargetFrame& frame) {
  constexpr double kTilt = 70 * M_PI / 180, kAzimuth = 0.4142;
  TargetFrame result = frame;
  result.normal = {std::sin(kTilt) * std::cos(kAzimuth), std::sin(kTilt) * std::sin(kAzimuth), std::cos(kTilt)};
  result.axis_u = Vec3(-std::sin(kAzimuth), std::cos(kAzimuth), 0);
  result.axis_v = result.normal.cross(result.axis_u);
  return result;
}

// Turned about the u axis: (u, v, n) of one is (u, -v, -n) of the other.
TargetFrame looking_back(const TargetFrame& frame) {
  TargetFrame back = frame;
  back.normal = -frame.normal;
  back.axis_v = -frame.axis_v;
  return back;
}

}  // namespace

PointSides make_point_sides(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                            double reach) {
  PointSides sides;
  sides.front = with_triangle(frame);
  const Vec3 origin = frame.origin;
  if (frame.all_sides) {
    sides.lift = height_off_surface(scene, sides.front);
    sides.front.origin = origin + sides.lift * frame.normal;
    refuse_steep_nearby(scene, target, sides.front);
  }
  sides.lift += clearing_lift(scene, target, sides.front, reach);
  sides.front.origin = origin + sides.lift * frame.normal;
  if (frame.all_sides) {
    sides.front = tilted(sides.front);
    sides.back = looking_back(sides.front);
  }
  return sides;
}

}  // namespace vantage::exact
