// One interval of a segment: where it comes near a convex set.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "vantage/geometry.h"
#include "vantage/query.h"

namespace vantage::internal::query {

/// All x with normal . x >= height.
struct HalfSpace {
  Vec3 normal;  ///< unit length
  double height;
};

/// The part of the segment (0 at `from`, 1 at `to`) whose points are within `radius` >= 0 of what all half-spaces have
/// in common; nothing where there is none. Never less than that, but for the rounding of single products; more by at
/// most 1e-12 of the segment's distance. The border of the grown set is approached by Newton's method from outside:
/// each step is the tangent plane of the point of the set next to an end of the interval, a sum of the half-spaces that
/// bound it there. Cost: linear in the half-spaces; for a radius of more than 0 some ten times that.
std::optional<LegInterval> near_part(const Vec3& from, const Vec3& to, std::span<const HalfSpace> set, double radius);

/// Where a point of the segment is within `radius` of `centre`. `radius` < 0: nowhere. Rounding moves the border by no
/// more than 8 roundings of the distance to the farther end.
std::optional<LegInterval> ball_part(const Vec3& from, const Vec3& to, const Vec3& centre, double radius);

/// Where on [0, 1] a convex function is least: golden section, to about 1e-8 of the leg for a smooth function, which is
/// rounding of the value. Never worse than both ends and the middle.
template <typename Function>
double least_place(const Function& value) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 60;
  double low = 0, high = 1, a = 1 - kGolden, b = kGolden;
  double at_a = value(a), at_b = value(b);
  for (int i = 0; i < kSteps; ++i) {
    if (at_a <= at_b) {
      high = std::exchange(b, a);
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = value(a);
    } else {
      low = std::exchange(a, b);
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = value(b);
    }
  }
  double best = at_a <= at_b ? a : b, least = std::min(at_a, at_b);
  for (const double place : {0.0, 0.5, 1.0}) {
    if (const double other = value(place); other < least) {
      best = place;
      least = other;
    }
  }
  return best;
}

/// Where a convex function on [0, 1] is less than `level`, by halving to the last bit, with `least` as a place where it
/// is least; ends lie outside of that by less than a bit.
template <typename Function>
std::optional<LegInterval> below_level(const Function& value, double level, double least) {
  if (!(value(least) < level)) return std::nullopt;
  const auto border = [&](double outside) {
    if (value(outside) < level) return outside;
    double inside = least;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      if (middle == inside || middle == outside) break;
      (value(middle) < level ? inside : outside) = middle;
    }
    return outside;
  };
  return LegInterval{border(0), border(1)};
}
template <typename Function>
std::optional<LegInterval> below_level(const Function& value, double level) {
  return below_level(value, level, least_place(value));
}

}  // namespace vantage::internal::query
