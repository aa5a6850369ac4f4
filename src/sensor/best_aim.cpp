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
  min_pitch_ = Angle(std::max(mount.min_pitch_deg * kDegree, -std::numbers::pi / 2));
  max_pitch_ = Angle(std::min(mount.max_pitch_deg * kDegree, std::numbers::pi / 2));
  if (mount.yaw_deg) yaw_ = Angle(*mount.yaw_deg * kDegree);
}

Aim AimFinder::allowed(Aim aim) const {
  return {yaw_ ? yaw_->radians : aim.yaw, std::clamp(aim.pitch, min_pitch_.radians, max_pitch_.radians)};
}

bool AimFinder::is_at_limit(const Aim& aim) const {
  return aim.pitch <= min_pitch_.radians || aim.pitch >= max_pitch_.radians;
}

AimedView AimFinder::view(const Aim& aim) const {
  AimedView view{aim, picture_edges(camera_, aim, roll_.radians), {}};
  for (std::size_t k = 0; k < 4; ++k) {
    view.need[k] = least_;
    for (const Vec3& corner : corners_) view.need[k] = std::max(view.need[k], -view.edges[k].dot(corner));
  }
  return view;
}

/// The inverse of the distance where it is positive; below that it tells how far the direction is out of the picture.
double AimFinder::nearness(const Angle& yaw, const Angle& pitch, const Vec3& direction) const {
  const PictureAxes axes = picture_axes(yaw, pitch, roll_);
  // What view() does, edge by edge: the products with opposite edges share their terms.
  const auto across_edges = [&](const Vec3& x) {
    const double wide = camera_.half_width * axes.ahead.dot(x), high = camera_.half_height * axes.ahead.dot(x);
    const double aside = axes.right.dot(x), above = axes.up.dot(x);
    return std::array{-wide - aside, -wide + aside, -high - above, -high + above};
  };
  std::array<double, 4> need{least_, least_, least_, least_};
  for (const Vec3& corner : corners_) {
    const std::array<double, 4> of_corner = across_edges(corner);
    for (std::size_t k = 0; k < 4; ++k) need[k] = std::max(need[k], of_corner[k]);
  }
  const std::array<double, 4> approach = across_edges(direction);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) least = std::min(least, approach[k] / need[k]);
  return least;
}

/// Turns the camera until opposite edges of the picture let the target in at the same distance: Newton's method with
/// differences.
Aim AimFinder::balanced(Aim aim, const Vec3& direction) const {
  constexpr int kSteps = 4;
  constexpr double kSmall = 1e-6, kLongest = 0.3;  // radians
  const auto imbalance = [&](const Aim& at) {
    const AimedView seen = view(at);
    const auto value = [&](std::size_t k) { return seen.approach(k, direction) / seen.need[k]; };
    return Eigen::Vector2d(value(0) - value(1), value(2) - value(3));
  };
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector2d now = imbalance(aim);
    Eigen::Matrix2d slope;
    slope.col(0) = (imbalance({aim.yaw + kSmall, aim.pitch}) - now) / kSmall;
    slope.col(1) = (imbalance({aim.yaw, aim.pitch + kSmall}) - now) / kSmall;
    if (std::abs(slope.determinant()) < 1e-12 * slope.squaredNorm()) break;
    Eigen::Vector2d step = -slope.inverse() * now;
    if (!step.allFinite()) break;
    const double length = step.norm();
    if (length > kLongest) step *= kLongest / length;
    aim = {aim.yaw + step.x(), aim.pitch + step.y()};
    if (length < 1e-9) break;
  }
  return aim;
}

/// Goes to whichever of eight neighbours is better, with steps that halve where none is.
Aim AimFinder::climbed(Aim aim, const Vec3& direction) const {
  constexpr double kFirst = 0.02, kLast = 1e-4;  // radians
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  // By no, one or a diagonal step, to one side or the other.
  constexpr std::array<std::array<int, 2>, 8> kWays = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 2}, {2, -2}, {-2, 2}, {-2, -2}}};
  Angle yaw(aim.yaw), pitch(aim.pitch);
  double best = nearness(yaw, pitch, direction);
  for (double step = kFirst; step > kLast;) {
    const std::array kSteps = {Angle(0), Angle(step), Angle(step * kDiagonal)};
    const auto turn_by = [&](int way) {
      return way < 0 ? -kSteps[static_cast<std::size_t>(-way)] : kSteps[static_cast<std::size_t>(way)];
    };
    bool is_better = false;
    for (const auto& [aside, up] : kWays) {
      const Angle next_yaw = yaw_ ? *yaw_ : yaw + turn_by(aside);
      Angle next_pitch = pitch + turn_by(up);
      if (next_pitch.radians < min_pitch_.radians) next_pitch = min_pitch_;
      if (next_pitch.radians > max_pitch_.radians) next_pitch = max_pitch_;
      const double value = nearness(next_yaw, next_pitch, direction);
      if (value <= best) continue;
      best = value;
      yaw = next_yaw;
      pitch = next_pitch;
      is_better = true;
      break;
    }
    if (!is_better) step /= 2;
  }
  return {yaw.radians, pitch.radians};
}

AimedView AimFinder::next_to(const Aim& aim) const { return view(allowed(aim)); }

AimedView AimFinder::best(const Vec3& direction, const std::optional<Aim>& near) const {
  if (near) return view(climbed(*near, direction));
  const Aim at_centre = allowed(aim_along(-direction));
  Aim start = allowed(balanced(at_centre, direction));
  if (!(nearness(start, direction) > nearness(at_centre, direction))) start = at_centre;
  // Next to the vertical another yaw may be much better, and no small turn leads there.
  constexpr double kSteep = 0.8;  // radians
  constexpr int kYaws = 24;
  if (std::abs(at_centre.pitch) > kSteep) {
    for (int i = 0; i < kYaws; ++i) {
      const Aim turned = allowed({2 * std::numbers::pi * i / kYaws, at_centre.pitch});
      if (nearness(turned, direction) > nearness(start, direction)) start = turned;
    }
  }
  return view(climbed(start, direction));
}

}  // namespace vantage::internal::sensor
