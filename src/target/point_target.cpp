#include "target/point_target.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/portable_math.h"
#include "target/numerics.h"
#include "target/target_check.h"

namespace vantage::internal::target {
namespace {

TargetFrame with_triangle(TargetFrame frame, double radius) {
  const double half = 0.5 * std::sqrt(3.0) * radius;
  frame.polygon = {{radius, 0}, {-0.5 * radius, half}, {-0.5 * radius, -half}};
  frame.enclosing_radius_m = radius;
  return frame;
}

// Scenes are full of surfaces near the horizontal and the vertical through a point, and the engine is coarse beside
// geometry that all but lies in its plane. This one is steeper than roofs are, and along no street.
TargetFrame tilted(const TargetFrame& frame) {
  constexpr double kTilt = 70 * std::numbers::pi / 180, kAzimuth = 0.4142;
  TargetFrame result = frame;
  const portable::SineCosine tilt = portable::sine_cosine(kTilt), azimuth = portable::sine_cosine(kAzimuth);
  result.normal = {tilt.sine * azimuth.cosine, tilt.sine * azimuth.sine, tilt.cosine};
  result.axis_u = Vec3(-azimuth.sine, azimuth.cosine, 0);
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
                            double max_range) {
  PointSides sides;
  sides.front = with_triangle(frame, kPointRadius * std::min(1.0, max_range / numerics::kFullRange));
  const Vec3 origin = frame.origin;
  if (frame.all_sides) {
    sides.lift = height_off_surface(scene, sides.front, max_range);
    sides.front.origin = origin + sides.lift * frame.normal;
    refuse_steep_nearby(scene, target, sides.front, max_range);
  }
  Clearance clearance = clear_target(scene, target, sides.front, max_range, sides.lift > 0);
  sides.lift += clearance.lift_m;
  sides.notes = std::move(clearance.notes);
  sides.front.origin = origin + sides.lift * frame.normal;
  if (frame.all_sides) {
    sides.front = tilted(sides.front);
    sides.back = looking_back(sides.front);
  }
  return sides;
}

}  // namespace vantage::internal::target
