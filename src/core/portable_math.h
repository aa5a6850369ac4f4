// Angle functions with the same bits everywhere. C libraries disagree in the last digits of std::sin and its like, so
// that a volume would depend on the machine. These are made of + - * / and the square root, which IEEE 754 rounds in
// one way; they need a compiler that does not fuse them (-ffp-contract=off).
// How good they are is measured, beside long double: tests/test_portable_math.cpp.
#pragma once

#include <cmath>

namespace vantage::internal::portable {

struct SineCosine {
  double sine, cosine;
};

/// The sine and the cosine of an angle in radians, each within 1.2 units in the last place for angles of less than a
/// million. Cody and Waite's reduction to a quarter turn ("Software Manual for the Elementary Functions", 1980, chapter
/// 8), then Taylor's series.
SineCosine sine_cosine(double angle);

inline double sin(double angle) { return sine_cosine(angle).sine; }
inline double cos(double angle) { return sine_cosine(angle).cosine; }

/// Within 3 units in the last place, as far as sine_cosine() is good.
inline double tan(double angle) {
  const SineCosine both = sine_cosine(angle);
  return both.sine / both.cosine;
}

/// The angle of (x, y), -pi to pi, as std::atan2 tells it; NaN where both are infinite. Within 3 units in the last
/// place: from the nearest sixteenth by the difference formula, then Taylor's series.
double atan2(double y, double x);

inline double atan(double tangent) { return atan2(tangent, 1); }

/// Takes -1 to 1; NaN for all else. Within 3 units in the last place.
inline double acos(double cosine) { return atan2(std::sqrt((1 - cosine) * (1 + cosine)), cosine); }

/// Within 1.3 units in the last place, where the squares neither overflow nor vanish: 1e-150 to 1e150.
inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace vantage::internal::portable
