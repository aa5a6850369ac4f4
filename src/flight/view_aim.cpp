#include "flight/view_aim.h"

#include <algorithm>
#include <cmath>

#include "flight/target_view.h"
#include "vantage/sensor.h"

namespace vantage::internal::flight {
namespace {

void add_corners(const Target& target, std::vector<Vec3>& corners) {
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const std::vector<Vec3> of_part = corners_of(make_target_frame(target, i));
    corners.insert(corners.end(), of_part.begin(), of_part.end());
  }
}

/// The nearest that the mount allows.
AimedCamera allowed(const Aim& aim, bool is_vertical, const Mount& mount) {
  constexpr double kSame = 1e-9;  // degrees: rounding of a direction at the border of what is allowed
  AimedCamera camera{aim, true};
  camera.aim.pitch_deg = std::clamp(aim.pitch_deg, mount.min_pitch_deg, mount.max_pitch_deg);
  if (std::abs(camera.aim.pitch_deg - aim.pitch_deg) > kSame) camera.is_centred = false;
  if (!mount.yaw_deg) return camera;
  // Straight up or down all yaws are centred.
  if (std::abs(std::remainder(*mount.yaw_deg - aim.yaw_deg, 360)) > kSame && !is_vertical) camera.is_centred = false;
  camera.aim.yaw_deg = std::fmod(std::fmod(*mount.yaw_deg, 360) + 360, 360);
  return camera;
}

}  // namespace

// If there are several lists, each must be seen; of a list one target. All lists count as one picture.
ViewAim::ViewAim(const Mission& mission) : mount_(mission.sensor.mount) {
  if (mission.sensor.camera) camera_ = *mission.sensor.camera;
  if (mission.views.size() == 1) {
    for (const Target& target : mission.views.front()) add_corners(target, choices_.emplace_back());
    return;
  }
  std::vector<Vec3>& all = choices_.emplace_back();
  if (mission.views.empty()) add_corners(mission.target, all);
  for (const std::vector<Target>& view : mission.views) {
    if (!view.empty()) add_corners(view.front(), all);
  }
}

AimedCamera ViewAim::at(const Vec3& position, const Vec3& centre) const {
  const Vec3 line = centre - position;
  const AimedCamera nearest = allowed(aim_at(position, centre), !(line.head<2>().norm() > 0), mount_);
  if (!camera_) return nearest;
  std::vector<std::vector<Vec3>> seen = choices_;
  for (std::vector<Vec3>& corners : seen) {
    for (Vec3& corner : corners) corner -= position;
  }
  const CameraAim aim{nearest.aim.yaw_deg, nearest.aim.pitch_deg};
  if (nearest.is_centred && std::any_of(seen.begin(), seen.end(), [&](const std::vector<Vec3>& corners) {
        return is_in_picture(*camera_, mount_.roll_deg, aim, corners);
      })) {
    return nearest;
  }
  // Where the whole target is in no picture, by a rounding or more, as little as can be is outside.
  for (const double outside_deg : {0.0, 0.001, 0.01, 0.1, 1.0, 10.0, 45.0}) {
    std::optional<FittingAim> best;
    for (const std::vector<Vec3>& corners : seen) {
      const std::optional<FittingAim> fit = fit_in_picture(*camera_, mount_, corners, outside_deg);
      if (fit && (!best || fit->room_deg > best->room_deg)) best = fit;
    }
    if (best) return {{best->aim.yaw_deg, best->aim.pitch_deg}, false};
  }
  return {nearest.aim, false};
}

}  // namespace vantage::internal::flight
