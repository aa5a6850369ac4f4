// Numbers of 106 binary digits that know how far off they may be: their signs are certain, or said to be unknown.
#pragma once

#include <array>
#include <cmath>

#include "core/twofold.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// The number itself is no farther than `error` from `value`. The bounds hold while nothing overflows, and no product
/// is below some 1e-290.
struct Bounded {
  Twofold value{0, 0};
  double error = 0;

  double near() const { return value.high; }
  double size() const { return std::abs(value.high); }
  /// 1 or -1; 0 where the sign is not certain. The high part is the whole value, rounded once.
  int sign() const {
    constexpr double kRoundedOnce = 1 + 0x1p-50;
    return size() > error * kRoundedOnce ? (value.high > 0 ? 1 : -1) : 0;
  }
};

// Sums and products of two Twofold are off by less than 2^-100 of their operands, and of themselves: Joldes, Muller and
// Popescu (Tight and rigorous error bounds for basic building blocks of double-word arithmetic, 2017) show less than
// 2^-102 for what is like them. Sums of bounds are rounded, too.
namespace bounding {
constexpr double kUnit = 0x1p-100, kUp = 1 + 0x1p-49;
}  // namespace bounding

/// Of two doubles; no error.
inline Bounded bounded_difference(double a, double b) { return {exact_difference(a, b), 0}; }

inline Bounded operator-(const Bounded& a) { return {{-a.value.high, -a.value.low}, a.error}; }
inline Bounded operator-(const Bounded& a, const Bounded& b) {
  return {a.value - b.value, (a.error + b.error + bounding::kUnit * (a.size() + b.size())) * bounding::kUp};
}
inline Bounded operator+(const Bounded& a, const Bounded& b) { return a - (-b); }
inline Bounded operator*(const Bounded& a, const Bounded& b) {
  const double error = a.size() * b.error + b.size() * a.error + a.error * b.error;
  return {a.value * b.value, (error + bounding::kUnit * (a.size() * b.size())) * bounding::kUp};
}

using BoundedVec3 = std::array<Bounded, 3>;

inline BoundedVec3 bounded_difference(const Vec3& a, const Vec3& b) {
  return {bounded_difference(a.x(), b.x()), bounded_difference(a.y(), b.y()), bounded_difference(a.z(), b.z())};
}
inline Bounded dot(const BoundedVec3& a, const BoundedVec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline BoundedVec3 cross(const BoundedVec3& a, const BoundedVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace vantage::internal::core
