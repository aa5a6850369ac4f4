#include "flight/view_aim.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/format.h"
#include "flight/target_view.h"
#include "vantage/camera.h"
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

/// The one that a mission names; null where it names none.
const Camera* known_camera(const Mission& mission) {
  const std::optional<CameraSource>& source = mission.as_written.camera;
  const auto* const model = source ? std::get_if<CameraModel>(&*source) : nullptr;
  if (model == nullptr) return nullptr;
  const std::vector<Camera>& all = known_cameras();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Camera& one) { return one.name == model->name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::optional<DjiAircraft> aircraft_of_camera(const Mission& mission) {
  const Camera* const camera = known_camera(mission);
  if (camera == nullptr || !camera->carrier.dji_drone) return std::nullopt;
  DjiAircraft aircraft;
  aircraft.drone = *camera->carrier.dji_drone;
  aircraft.drone_sub_type = camera->carrier.dji_drone_sub_type.value_or(0);
  aircraft.payload = camera->carrier.dji_payload;
  return aircraft;
}

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

std::optional<std::string> AskedPitches::note(const Mission& mission) const {
  if (!(lowest_deg_ <= highest_deg_)) return std::nullopt;
  constexpr double kRoundingDeg = 0.01;
  const auto reaches = [this](double min_deg, double max_deg) {
    return lowest_deg_ >= min_deg - kRoundingDeg && highest_deg_ <= max_deg + kRoundingDeg;
  };
  const std::string asked = core::format("the camera has to take pitches from {:.1f} to {:.1f} degrees",
                                         lowest_deg_ + 0.0, highest_deg_ + 0.0);
  const Camera* const camera = known_camera(mission);
  if (camera != nullptr && camera->carrier.pitch_deg) {
    const auto [min_deg, max_deg] = *camera->carrier.pitch_deg;
    if (reaches(min_deg, max_deg)) return std::nullopt;
    return core::format("{}, and the gimbal of {} takes {:g} to {:g}", asked, camera->name, min_deg, max_deg);
  }
  const Mount& mount = mission.sensor.mount;
  const bool is_said = mission.sensor.camera && (mount.min_pitch_deg > -90 || mount.max_pitch_deg < 90);
  if (is_said && reaches(mount.min_pitch_deg, mount.max_pitch_deg)) return std::nullopt;
  // Every gimbal that carries a camera through the air reaches these.
  if (!is_said && reaches(-90, 0)) return std::nullopt;
  return asked + (is_said ? ", and the mission's mount does not"
                          : ", and what the gimbal reaches is not known: give 'sensor.gimbal.pitch', or the model of a "
                            "camera whose gimbal 'vantage cameras' lists");
}

}  // namespace vantage::internal::flight
