#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensor/aim.h"
#include "sensor/find_aim.h"
#include "vantage/sensor.h"

namespace vantage {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

CameraAim degrees_of(const internal::sensor::Aim& aim) {
  const double yaw = std::fmod(aim.yaw / kRadian, 360), turned = yaw < 0 ? yaw + 360 : yaw;
  return {turned < 360 ? turned : 0, aim.pitch / kRadian};
}

}  // namespace

bool is_in_picture(const Pinhole& camera, double roll_deg, const CameraAim& aim, const std::vector<Vec3>& points) {
  const internal::sensor::PictureEdges edges = internal::sensor::picture_edges(
      camera, {aim.yaw_deg * kRadian, aim.pitch_deg * kRadian}, internal::sensor::Angle(roll_deg * kRadian));
  return std::all_of(edges.begin(), edges.end(), [&](const Vec3& edge) {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& point) { return edge.dot(point) >= 0; });
  });
}

std::optional<FittingAim> fit_in_picture(const Pinhole& camera, const Mount& mount, const std::vector<Vec3>& points,
                                         double outside_deg) {
  constexpr double kFine = 1e-4, kTouches = 1e-6, kFinest = 1e-7;  // sines
  constexpr int kMostPitches = 1000;
  std::optional<FittingAim> best;
  const auto is_finite = [](const Vec3& point) { return point.allFinite(); };
  if (!std::all_of(points.begin(), points.end(), is_finite)) return best;
  double low = -kTouches - std::sin(outside_deg * kRadian), high = 1;  // of the room
  for (double room = low; high - low > kFine; room = 0.5 * (low + high)) {
    const double slack = best ? kFine / 10 : kFinest;
    const auto found = internal::sensor::find_aim(camera, mount, points, slack, {.outside = -room}, kMostPitches).aim;
    if (!found && !best) return best;
    if (found) best = {degrees_of(*found), std::asin(room) / kRadian};
    (found ? low : high) = room;
  }
  return best;
}

}  // namespace vantage
