#include "exact/circle_arcs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "exact/segment_cover.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kArcRounding = 1e-14;

double unrolled(double angle) {
  angle = std::fmod(angle, kTurn);
  return angle < 0 ? angle + kTurn : angle;
}

}  // namespace

CircleArcs::Wave CircleArcs::wave_of(const Vec3& normal, double height) const {
  const double a = circle_.radius * normal.dot(circle_.axis_1), b = circle_.radius * normal.dot(circle_.axis_2);
  return {a, b, portable::hypot(a, b), height - normal.dot(circle_.centre)};
}

CircleArcs::Cut CircleArcs::cut(const Wave& wave, double margin) {
  if (wave.level >= wave.amplitude - margin) return Cut::none;
  return wave.level <= -wave.amplitude + margin ? Cut::all : Cut::some;
}

// Takes out of `parts` where a wave is below its level.
void CircleArcs::subtract_below(const Wave& wave, IntervalSet& parts) {
  const double middle = portable::atan2(wave.b, wave.a);
  const double half_width = portable::acos(std::clamp(wave.level / wave.amplitude, -1.0, 1.0));
  const double begin = unrolled(middle + half_width), length = kTurn - 2 * half_width;
  parts.subtract(begin, std::min(begin + length, kTurn));
  if (begin + length > kTurn) parts.subtract(-1, begin + length - kTurn);
}

void CircleArcs::keep(const Vec3& normal, double height) {
  const Wave wave = wave_of(normal, height);
  const Cut found = cut(wave, 0);
  if (found == Cut::none) parts_.assign(0, 0);
  if (found == Cut::some) subtract_below(wave, parts_);
}

// What is hidden is the intersection of the arcs beyond the planes, and of what is left: soon it is nothing.
void CircleArcs::subtract_blocker(std::span<const Plane> planes, bool owns_ties) {
  const double size = circle_.centre.norm() + circle_.radius;
  if (is_clear_of(planes, size)) return;
  hidden_ = parts_;
  for (const Plane& plane : planes) {
    const double margin = tie_margin(plane, size);
    const Wave wave = wave_of(plane, 1);
    if (std::abs(wave.level) <= margin && wave.amplitude <= margin) {
      if (!owns_ties) return;
      continue;
    }
    const Cut found = cut(wave, margin);
    if (found == Cut::some) subtract_below(wave, hidden_);
    if (found == Cut::none || hidden_.empty()) return;
  }
  for (const Interval& part : hidden_.parts()) parts_.subtract(part.begin, part.end);
}

void CircleArcs::subtract_body(std::span<const Plane> planes, std::span<const Vec3> cone) {
  const double size = circle_.centre.norm() + circle_.radius;
  hidden_ = parts_;
  for (const Vec3& side : cone) {
    const Wave wave = wave_of(side, 0);
    const Cut found = cut(wave, 0);
    if (found == Cut::some) subtract_below(wave, hidden_);
    if (found == Cut::none || hidden_.empty()) return;
  }
  for (const Plane& plane : planes) {
    const Wave wave = wave_of(-plane, -1);
    const Cut found = cut(wave, tie_margin(plane, size));
    if (found == Cut::some) subtract_below(wave, hidden_);
    if (found == Cut::none || hidden_.empty()) return;
  }
  for (const Interval& part : hidden_.parts()) parts_.subtract(part.begin, part.end);
}

// Whether the circle lies wholly on the near side of one of the planes: told without an angle.
bool CircleArcs::is_clear_of(std::span<const Plane> planes, double size) const {
  return std::ranges::any_of(planes, [&](const Plane& plane) {
    const double a = circle_.radius * plane.dot(circle_.axis_1), b = circle_.radius * plane.dot(circle_.axis_2);
    const double level = 1 - plane.dot(circle_.centre), margin = tie_margin(plane, size);
    return level > margin && (level + margin) * (level + margin) > (1 + kArcRounding) * (a * a + b * b);
  });
}

}  // namespace vantage::internal::exact
