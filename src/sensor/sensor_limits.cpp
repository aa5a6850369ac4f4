#include "sensor/sensor_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/portable_math.h"
#include "sensor/best_aim.h"
#include "sensor/find_aim.h"

namespace vantage::internal::sensor {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return a + share * along;
}

/// Whether a point lies over or under the polygon, along its normal.
bool is_over(const ViewedPart& part, const Vec3& point) {
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    const Vec3& a = part.corners[i];
    const Vec3 edge = part.corners[(i + 1) % part.corners.size()] - a;
    if (part.normal->cross(edge).dot(point - a) < 0) return false;
  }
  return true;
}

/// The cosine of the angle between `direction`, of unit length, and `x`; 1 for no x.
double cosine_to(const Vec3& x, const Vec3& direction) {
  const double length = x.norm();
  return length > 0 ? x.dot(direction) / length : 1.0;
}

/// The largest cosine to `direction` on the segment from a to b: at an end, or where the derivative, which is linear
/// but for a positive factor, vanishes.
double largest_cosine(const Vec3& a, const Vec3& b, const Vec3& direction) {
  double largest = std::max(cosine_to(a, direction), cosine_to(b, direction));
  const Vec3 e = b - a;
  const double ae = a.dot(e), as = a.dot(direction), es = e.dot(direction);
  const double share = (es * a.squaredNorm() - as * ae) / (as * e.squaredNorm() - es * ae);
  if (share > 0 && share < 1) largest = std::max(largest, cosine_to(a + share * e, direction));
  return largest;
}

/// Where a limit changes along a line: `margin` is >= 0 where it is kept, and either the places where it is kept or
/// those where it is broken are one interval, about its one maximum or minimum.
template <typename Margin>
void add_changes(const Margin& margin, double sign, double reach, std::vector<double>& out) {
  // With the sign, the interval is where the values are largest.
  const auto value = [&](double t) { return sign * margin(t); };
  constexpr int kSamples = 32, kSteps = 60;
  int best = 0;
  for (int i = 1; i <= kSamples; ++i) {
    if (value(reach * i / kSamples) > value(reach * best / kSamples)) best = i;
  }
  double low = reach * std::max(best - 1, 0) / kSamples, high = reach * std::min(best + 1, kSamples) / kSamples;
  for (int i = 0; i < kSteps; ++i) {
    const double third = (high - low) / 3;
    (value(low + third) < value(high - third) ? low : high) =
        value(low + third) < value(high - third) ? low + third : high - third;
  }
  const double top = (low + high) / 2;
  if (value(top) < 0) return;
  for (const double end : {0.0, reach}) {
    if (value(end) >= 0) continue;
    double inside = top, outside = end;
    for (int i = 0; i < kSteps; ++i) {
      const double middle = (inside + outside) / 2;
      (value(middle) >= 0 ? inside : outside) = middle;
    }
    out.push_back((inside + outside) / 2);
  }
}

}  // namespace

double distance_to(const ViewedPart& part, const Vec3& point) {
  const std::vector<Vec3>& corners = part.corners;
  if (corners.size() > 1 && is_over(part, point)) return std::abs(part.normal->dot(point - corners[0]));
  double least = kUnlimited;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    least = std::min(least, (point - nearest_on_segment(corners[i], corners[(i + 1) % corners.size()], point)).norm());
  }
  return least;
}

double least_angle(const ViewedPart& part, const Vec3& point, const Vec3& direction) {
  const std::vector<Vec3>& corners = part.corners;
  if (corners.size() > 1) {
    const double towards = part.normal->dot(direction);
    const double distance = part.normal->dot(corners[0] - point) / towards;
    if (towards != 0 && distance >= 0 && is_over(part, point + distance * direction)) return 0;
  }
  double largest = -1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    largest =
        std::max(largest, largest_cosine(corners[i] - point, corners[(i + 1) % corners.size()] - point, direction));
  }
  return portable::acos(std::clamp(largest, -1.0, 1.0));
}

SensorLimits::SensorLimits(const Viewed& viewed, const Sensor& sensor) : viewed_(viewed), sensor_(sensor) {
  if (sensor.sun) sun_ = sensor.sun->direction.normalized();
}

double SensorLimits::incidence_margin(const ViewedPart& part, const Vec3& point) const {
  const double angle = *sensor_.incidence_deg * kDegree;
  double least = kUnlimited;
  for (const Vec3& corner : part.corners) {
    const Vec3 x = point - corner;
    const double height = part.normal->dot(x);
    const double aside = (x - height * *part.normal).norm();
    least = std::min(least, height * portable::sin(angle) - aside * portable::cos(angle));
  }
  return least;
}

/// A viewpoint keeps the limit of a corner in the ball that touches the target's plane there.
double SensorLimits::pixel_margin(const ViewedPart& part, const Vec3& point) const {
  const double diameter = sensor_.pixel->size_m * *sensor_.camera->focal_px;
  double least = kUnlimited;
  for (const Vec3& corner : part.corners) {
    const Vec3 x = point - corner;
    least = std::min(least, part.normal->dot(x) - x.squaredNorm() / diameter);
  }
  return least;
}

double SensorLimits::sun_margin(const ViewedPart& part, const Vec3& point) const {
  return least_angle(part, point, sun_) - sensor_.sun->exclude_deg * kDegree;
}

bool SensorLimits::fits(const Vec3& point, const Mount& mount) const {
  // Mostly an aim that is good enough is found at once, from how the target lies.
  const double distance = point.norm();
  if (distance > 0) {
    const AimFinder finder(viewed_.corners, *sensor_.camera, mount, 0);
    const Vec3 direction = point / distance;
    if (finder.best(direction).distance(direction) <= distance) return true;
  }
  std::vector<Vec3> seen;
  seen.reserve(viewed_.corners.size());
  for (const Vec3& corner : viewed_.corners) seen.push_back(corner - point);
  return find_aim(*sensor_.camera, mount, seen).aim.has_value();
}

// All members of Sensor are named, here and below: a limit that is added does not compile before it is answered.

std::vector<std::string> SensorLimits::broken(const Vec3& scene_point) const {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor_;
  const Vec3 point = scene_point - viewed_.origin;
  const auto some_part = [&](const auto& breaks) {
    return std::any_of(viewed_.parts.begin(), viewed_.parts.end(), breaks);
  };
  std::vector<std::string> broken;
  if (min_range_m > 0 &&
      some_part([&](const ViewedPart& part) { return distance_to(part, point) < sensor_.min_range_m; })) {
    broken.push_back("min_range");
  }
  if (incidence_deg && some_part([&](const ViewedPart& part) { return incidence_margin(part, point) < 0; })) {
    broken.push_back("incidence");
  }
  if (pixel && pixel->kind == PixelLimit::Kind::worst &&
      some_part([&](const ViewedPart& part) { return pixel_margin(part, point) < 0; })) {
    broken.push_back("pixel");
  }
  if (camera && !fits(point, mount)) {
    const Mount free{.yaw_deg = {}, .roll_deg = mount.roll_deg};
    broken.push_back(fits(point, free) ? "gimbal" : "frame");
  }
  if (sun && some_part([&](const ViewedPart& part) { return sun_margin(part, point) < 0; })) broken.push_back("sun");
  return broken;
}

std::vector<double> SensorLimits::changes(const Vec3& origin, const Vec3& direction, double reach) const {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor_;
  const Vec3 start = origin - viewed_.origin;
  const auto at = [&](double t) { return Vec3(start + t * direction); };
  std::vector<double> out;
  for (const ViewedPart& part : viewed_.parts) {
    if (min_range_m > 0) {
      add_changes([&](double t) { return distance_to(part, at(t)) - sensor_.min_range_m; }, -1, reach, out);
    }
    if (incidence_deg) add_changes([&](double t) { return incidence_margin(part, at(t)); }, 1, reach, out);
    if (pixel && pixel->kind == PixelLimit::Kind::worst) {
      add_changes([&](double t) { return pixel_margin(part, at(t)); }, 1, reach, out);
    }
    if (sun) add_changes([&](double t) { return sun_margin(part, at(t)); }, -1, reach, out);
  }
  if (camera) {
    // From a point among the corners a camera that takes them all in goes on doing so farther out.
    std::vector<Vec3> corners;
    for (const Vec3& corner : viewed_.corners) corners.push_back(corner - start);
    const double distance = AimFinder(corners, *camera, mount, 0).best(direction).distance(direction);
    if (distance < reach) out.push_back(distance);
  }
  return out;
}

}  // namespace vantage::internal::sensor
