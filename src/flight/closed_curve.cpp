#include "flight/closed_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vantage::internal::flight {
namespace {

Vec3 unit(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

}  // namespace

double ClosedCurve::length_m() const { return 2 * std::numbers::pi * radius_m + 4 * half_straight_m; }

Vec3 ClosedCurve::at(double way_m) const {
  const Vec3 along = half_straight_m * unit(angle);
  const double turn = std::numbers::pi * radius_m, straight = 2 * half_straight_m;
  for (const double half : {0.0, 1.0}) {
    const double side = half == 0 ? 1 : -1;
    const double right = angle + (half - 0.5) * std::numbers::pi;
    if (way_m < straight) {
      return centre + radius_m * unit(right) + side * (way_m / half_straight_m - 1) * along;
    }
    way_m -= straight;
    if (way_m < turn || half == 1) return centre + side * along + radius_m * unit(right + way_m / radius_m);
    way_m -= turn;
  }
  return centre;
}

double ClosedCurve::distance_outside(const Vec3& place) const {
  const Vec3 direction = unit(angle);
  const Vec3 offset = place - centre;
  const double along = std::clamp(direction.dot(offset), -half_straight_m, half_straight_m);
  return std::max(0.0, (offset - along * direction).head<2>().norm() - radius_m);
}

std::vector<Vec3> ClosedCurve::corners(double chord_error_m) const {
  const double share = std::min(1.0, chord_error_m / radius_m);
  // A chord of the angle a is r (1 - cos(a / 2)) from its arc.
  const double most_angle = 2 * std::acos(1 - share);
  constexpr double kFewest = 4;
  const auto count = static_cast<std::size_t>(std::max(kFewest, std::ceil(std::numbers::pi / most_angle)));
  const double turn = std::numbers::pi * radius_m, straight = 2 * half_straight_m;
  std::vector<Vec3> result;
  for (const double begin : {straight, 2 * straight + turn}) {
    const std::size_t more = half_straight_m > 0 ? 1 : 0;  // else the next turn has the same point
    for (std::size_t i = 0; i < count + more; ++i) {
      result.push_back(at(begin + turn * static_cast<double>(i) / static_cast<double>(count)));
    }
  }
  return result;
}

std::vector<Vec3> ClosedCurve::points(std::size_t count) const {
  std::vector<Vec3> result;
  result.reserve(count);
  if (half_straight_m > 0) {
    for (std::size_t i = 0; i < count; ++i) {
      result.push_back(at(length_m() * static_cast<double>(i) / static_cast<double>(count)));
    }
    return result;
  }
  // The same for circles: turned from point to point. Each turn rounds by some 1e-16 of the radius.
  const double step = 2 * std::numbers::pi / static_cast<double>(count);
  const double cosine = std::cos(step), sine = std::sin(step);
  Vec3 offset = radius_m * unit(angle - std::numbers::pi / 2);
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(centre + offset);
    offset = Vec3(cosine * offset.x() - sine * offset.y(), sine * offset.x() + cosine * offset.y(), 0);
  }
  return result;
}

}  // namespace vantage::internal::flight
