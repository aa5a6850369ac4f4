#include "sensor/best_aim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::internal::sensor {

double AimedView::distance(const Vec3& direction, const std::array<double, 4>& slack) const {
  double farthest = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double speed = approach(k, direction);
    if (!(speed > 0)) return std::numeric_limits<double>::infinity();
    farthest = std::max(farthest, (need[k] + slack[k]) / speed);
  }
  return farthest;
}

AimFinder::AimFinder(const std::vector<Vec3>& corners, const Pinhole& camera, const Mount& mount, double least)
    : corners_(corners), camera_(camera), least_(least) {
  constexpr double kDegree = std::numbers::pi / 180;
  roll_ = Angle(mount.roll_deg * kDegree);
  min_pitch_ = std::max(mount.min_pitch_deg * kDegree, -std::numbers::pi / 2);
  max_pitch_ = std::min(mount.max_pitch_deg * kDegree, std::numbers::pi / 2);
  if (mount.yaw_deg) yaw_ = *mount.yaw_deg * kDegree;
}

Aim AimFinder::allowed(Aim aim) const {
  return {yaw_.value_or(aim.yaw), std::clamp(aim.pitch, min_pitch_, max_pitch_)};
}

bool AimFinder::is_at_limit(const Aim& aim) const { return aim.pitch <= min_pitch_ || aim.pitch >= max_pitch_; }

AimedView AimFinder::view(const Aim& aim) const {
  AimedView view{aim, picture_edges(camera_, aim, roll_), {}};
  for (std::size_t k = 0; k < 4; ++k) {
    view.need[k] = least_;
    for (const Vec3& corner : corners_) view.need[k] = std::max(view.need[k], -view.edges[k].dot(corner));
  }
  return view;
}

/// How far a place is outside of each edge's plane: what view() computes, where opposite edges share their terms.
AimFinder::PerEdge AimFinder::across_edges(const PictureAxes& axes, const Vec3& place) const {
  const double wide = camera_.half_width * axes.ahead.dot(place), high = camera_.half_height * axes.ahead.dot(place);
  const double aside = axes.right.dot(place), above = axes.up.dot(place);
  return {-wide - aside, -wide + aside, -high - above, -high + above};
}

/// The inverse of the distance where it is positive; below that it tells how far the direction is out of the picture.
double AimFinder::nearness(const Aim& aim, const Vec3& direction) const {
  const PictureAxes axes = picture_axes(Angle(aim.yaw), Angle(aim.pitch), roll_);
  PerEdge need{least_, least_, least_, least_};
  for (const Vec3& corner : corners_) {
    const PerEdge of_corner = across_edges(axes, corner);
    for (std::size_t k = 0; k < 4; ++k) need[k] = std::max(need[k], of_corner[k]);
  }
  const PerEdge approach = across_edges(axes, direction);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) least = std::min(least, approach[k] / need[k]);
  return least;
}

/// The nearness is the least of what edges and corners allow. Of each that matters near an aim, the plane that touches
/// it there, over small turns.
void AimFinder::nearness_planes(const Aim& aim, const Vec3& direction, std::vector<Plane2>& planes) const {
  // A corner that is so much farther inside than another one stays so.
  constexpr double kMatters = 0.3;
  const Angle yaw(aim.yaw);
  const PictureAxes axes = picture_axes(yaw, Angle(aim.pitch), roll_);
  const Vec3 level(yaw.cosine, -yaw.sine, 0);
  // Turning the camera is turning what it looks at the other way.
  struct Turning {
    PerEdge now, by_yaw, by_pitch;
  };
  const auto turning = [&](const Vec3& place) {
    return Turning{across_edges(axes, place), across_edges(axes, Vec3(-place.y(), place.x(), 0)),
                   across_edges(axes, place.cross(level))};
  };
  const Turning approach = turning(direction);
  const auto add = [&](std::size_t k, double need, double need_by_yaw, double need_by_pitch) {
    const double value = approach.now[k] / need;
    const double by_yaw = (approach.by_yaw[k] - value * need_by_yaw) / need;
    planes.push_back({value, {yaw_ ? 0.0 : by_yaw, (approach.by_pitch[k] - value * need_by_pitch) / need}});
  };
  PerEdge most{least_, least_, least_, least_};
  for (const Vec3& corner : corners_) {
    const PerEdge of_corner = across_edges(axes, corner);
    for (std::size_t k = 0; k < 4; ++k) most[k] = std::max(most[k], of_corner[k]);
  }
  planes.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    if (most[k] <= least_) add(k, least_, 0, 0);
  }
  for (const Vec3& corner : corners_) {
    const Turning of_corner = turning(corner);
    for (std::size_t k = 0; k < 4; ++k) {
      if (of_corner.now[k] > std::max(least_, kMatters * most[k])) {
        add(k, of_corner.now[k], of_corner.by_yaw[k], of_corner.by_pitch[k]);
      }
    }
  }
}

/// Goes to the top of the planes that touch the nearness, not farther than they were found good for, again and again.
Aim AimFinder::climbed(Aim aim, const Vec3& direction, double first_turn) const {
  constexpr double kFarthest = 0.5, kLast = 1e-3;  // radians
  constexpr double kLeastGain = 5e-4;
  constexpr int kMostSteps = 40;
  std::vector<Plane2> planes;
  double best = nearness(aim, direction), reach = first_turn;
  bool is_new = true;
  for (int i = 0; i < kMostSteps && reach > kLast; ++i) {
    if (is_new) nearness_planes(aim, direction, planes);
    constexpr double kAnywhere = std::numeric_limits<double>::infinity();
    const Eigen::Vector2d turn =
        rise(planes,
             {.reach = reach, .min = {-kAnywhere, min_pitch_ - aim.pitch}, .max = {kAnywhere, max_pitch_ - aim.pitch}});
    double hoped = std::numeric_limits<double>::infinity();
    for (const Plane2& plane : planes) hoped = std::min(hoped, plane.at(turn));
    if (!(hoped - best > kLeastGain * std::abs(best))) break;
    const Aim next = allowed({aim.yaw + turn.x(), aim.pitch + turn.y()});
    const double value = nearness(next, direction), gain = (value - best) / (hoped - best);
    is_new = gain > 0;
    if (is_new) {
      aim = next;
      best = value;
    }
    const double farthest = turn.cwiseAbs().maxCoeff();
    if (gain < 0.25) reach = farthest / 4;
    if (gain > 0.75) reach = std::clamp(2 * farthest, reach, kFarthest);
  }
  return aim;
}

AimedView AimFinder::next_to(const Aim& aim) const { return view(allowed(aim)); }

AimedView AimFinder::best(const Vec3& direction, const std::optional<Aim>& near) const {
  constexpr double kFirst = 0.3, kFirstNear = 0.05;  // radians
  if (near) return view(climbed(*near, direction, kFirstNear));
  const Aim at_centre = allowed(aim_along(-direction));
  Aim start = at_centre;
  // Next to the vertical another yaw may be much better, and no small turn leads there.
  constexpr double kSteep = 0.8;  // radians
  constexpr int kYaws = 24;
  if (std::abs(at_centre.pitch) > kSteep) {
    for (int i = 0; i < kYaws; ++i) {
      const Aim turned = allowed({2 * std::numbers::pi * i / kYaws, at_centre.pitch});
      if (nearness(turned, direction) > nearness(start, direction)) start = turned;
    }
  }
  return view(climbed(start, direction, kFirst));
}

}  // namespace vantage::internal::sensor
