// Numbers as the sum of two doubles that do not overlap: 106 binary digits.
#pragma once

#include <cmath>

namespace vantage::internal::core {

struct Twofold {
  double high, low = 0;
};

/// a - b without any rounding, whichever is larger (the two-sum of Knuth, The Art of Computer Programming 2, 4.2.2).
inline Twofold exact_difference(double a, double b) {
  const double high = a - b, of_a = high + b, of_b = of_a - high;
  return {high, (a - of_a) + (of_b - b)};
}

// To some 2^-100 of the operands (Dekker, A floating-point technique for extending the available precision, 1971).

inline Twofold renormalised(double high, double low) {
  const double sum = high + low;
  return {sum, low - (sum - high)};
}
inline Twofold operator-(const Twofold& a, const Twofold& b) {
  const Twofold difference = exact_difference(a.high, b.high);
  return renormalised(difference.high, difference.low + (a.low - b.low));
}
inline Twofold operator+(const Twofold& a, const Twofold& b) { return a - Twofold{-b.high, -b.low}; }
inline Twofold operator*(const Twofold& a, const Twofold& b) {
  const double product = a.high * b.high;
  return renormalised(product, std::fma(a.high, b.high, -product) + (a.high * b.low + a.low * b.high));
}
inline Twofold operator/(const Twofold& a, const Twofold& b) {
  const double first = a.high / b.high;
  return renormalised(first, (a - Twofold{first} * b).high / b.high);
}

}  // namespace vantage::internal::core
