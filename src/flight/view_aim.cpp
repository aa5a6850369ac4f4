#include "flight/view_aim.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensor/aim.h"
#include "sensor/find_aim.h"
#include "vantage/target.h"

namespace vantage::internal::flight {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

void add_corners(const Target& target, std::vector<Vec3>& corners) {
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const TargetFrame frame = make_target_frame(target, i);
    for (const Eigen::Vector2d& corner : frame.polygon) corners.push_back(frame.to_scene({corner.x(), corner.y(), 0}));
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

// Of several lists each must be seen, and of a list one target. All lists count as one picture.
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

bool ViewAim::has_all(const std::vector<Vec3>& corners, const Vec3& position, const Aim& aim) const {
  const sensor::PictureEdges edges = sensor::picture_edges(*camera_, {aim.yaw_deg * kRadian, aim.pitch_deg * kRadian},
                                                           sensor::Angle(mount_.roll_deg * kRadian));
  return std::all_of(edges.begin(), edges.end(), [&](const Vec3& edge) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vec3& corner) { return edge.dot(corner - position) >= 0; });
  });
}

std::optional<ViewAim::Fit> ViewAim::best_fit(const std::vector<Vec3>& corners, const Vec3& position) const {
  constexpr double kFine = 1e-4, kTouches = 1e-6;  // sines; the second for positions on the border of the volume
  constexpr int kMostPitches = 1000;
  std::vector<Vec3> seen;
  for (const Vec3& corner : corners) seen.push_back(corner - position);
  std::optional<Fit> best;
  double low = -kTouches, high = 1;  // of the room
  for (double room = low; high - low > kFine; room = 0.5 * (low + high)) {
    const auto found = sensor::find_aim(*camera_, mount_, seen, kFine / 10, {.outside = -room}, kMostPitches).aim;
    if (!found) {
      if (!best) return best;
      high = room;
      continue;
    }
    const double yaw = std::fmod(found->yaw / kRadian, 360);
    best = {{yaw < 0 ? yaw + 360 : yaw, found->pitch / kRadian}, room};
    low = room;
  }
  return best;
}

AimedCamera ViewAim::at(const Vec3& position, const Vec3& centre) const {
  const Vec3 line = centre - position;
  const AimedCamera nearest = allowed(aim_at(position, centre), !(line.head<2>().norm() > 0), mount_);
  if (!camera_) return nearest;
  const auto is_whole = [&](const std::vector<Vec3>& corners) { return has_all(corners, position, nearest.aim); };
  if (nearest.is_centred && std::any_of(choices_.begin(), choices_.end(), is_whole)) return nearest;
  std::optional<Fit> best;
  for (const std::vector<Vec3>& corners : choices_) {
    const std::optional<Fit> fit = best_fit(corners, position);
    if (fit && (!best || fit->room > best->room)) best = fit;
  }
  return best ? AimedCamera{best->aim, false} : AimedCamera{nearest.aim, false};
}

}  // namespace vantage::internal::flight
