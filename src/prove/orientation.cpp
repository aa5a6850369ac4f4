// Adaptive predicates (Shewchuk 1997), by William C. Lenthe: they come with CDT.
#include "prove/orientation.h"

#include <CDT.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace vantage::internal::prove {
namespace {

/// A sum of products of doubles in units of the smallest one, or of its square or cube: two's complement, with room for
/// the determinants below.
class WideInteger {
 public:
  explicit WideInteger(double number) {
    constexpr int kDigits = std::numeric_limits<double>::digits, kUnit = -1074;
    int exponent = 0;
    auto digits = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(number), &exponent), kDigits));
    int shift = exponent - kDigits - kUnit;
    if (shift < 0) {
      digits >>= -shift;  // of a number so small these are zero
      shift = 0;
    }
    for (int bit = 0; bit < kDigits; ++bit) {
      const int place = shift + bit;
      words_[static_cast<std::size_t>(place / 32)] |= static_cast<std::uint32_t>(digits >> bit & 1) << place % 32;
    }
    if (number < 0) *this = WideInteger(0) - *this;
  }

  int sign() const {
    if (words_.back() >> 31 != 0) return -1;
    return std::any_of(words_.begin(), words_.end(), [](std::uint32_t word) { return word != 0; }) ? 1 : 0;
  }

  WideInteger operator-(const WideInteger& other) const {
    WideInteger result(0);
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      const std::uint64_t word = std::uint64_t{words_[i]} - other.words_[i] - borrow;
      result.words_[i] = static_cast<std::uint32_t>(word);
      borrow = word >> 63;
    }
    return result;
  }

  WideInteger operator*(const WideInteger& other) const {
    WideInteger result(0);
    for (std::size_t i = 0; i < kWords; ++i) {
      std::uint64_t carry = 0;
      for (std::size_t k = 0; words_[i] != 0 && i + k < kWords; ++k) {
        carry += std::uint64_t{words_[i]} * other.words_[k] + result.words_[i + k];
        result.words_[i + k] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    return result;
  }

 private:
  static constexpr std::size_t kWords = 136;  // 4352 bits: any double squared, and the cube of 2^370
  std::array<std::uint32_t, kWords> words_{};
};

WideInteger minor_of(const WideInteger& ax, const WideInteger& ay, const WideInteger& bx, const WideInteger& by) {
  return ax * by - ay * bx;
}

/// Whether the sign of what a predicate returned stands: the products of very small coordinates underflow, those of
/// very large ones overflow. What underflow loses is less by far than what is asked of the result.
bool is_sure(double result, std::initializer_list<const double*> points, std::size_t dimension) {
  constexpr double kLost = 0x1p-900, kSmallestCubed = 0x1p-250, kLargestCubed = 0x1p+300;
  if (std::abs(result) > kLost && std::isfinite(result)) return true;
  bool all_moderate = true;
  for (const double* point : points) {
    for (std::size_t k = 0; k < dimension; ++k) {
      const double size = std::abs(point[k]);
      if (!std::isfinite(size)) return true;  // nothing else tells more
      all_moderate = all_moderate && (size == 0 || (size >= kSmallestCubed && size <= kLargestCubed));
    }
  }
  return all_moderate;
}

int sign_of(double number) { return (number > 0) - (number < 0); }

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto difference = [&](const Vec3& point, int axis) { return WideInteger(point[axis]) - WideInteger(d[axis]); };
  const WideInteger bx = difference(b, 0), by = difference(b, 1), bz = difference(b, 2);
  const WideInteger cx = difference(c, 0), cy = difference(c, 1), cz = difference(c, 2);
  const WideInteger first = difference(a, 0) * minor_of(by, bz, cy, cz),
                    second = difference(a, 1) * minor_of(bx, bz, cx, cz);
  const WideInteger third = difference(a, 2) * minor_of(bx, by, cx, cy);
  return (first - (second - third)).sign();
}

int exact_turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto difference = [&](const Eigen::Vector2d& point, int axis) {
    return WideInteger(point[axis]) - WideInteger(c[axis]);
  };
  return minor_of(difference(a, 0), difference(a, 1), difference(b, 0), difference(b, 1)).sign();
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double sign = predicates::orient3d(a.data(), b.data(), c.data(), d.data());
  return is_sure(sign, {a.data(), b.data(), c.data(), d.data()}, 3) ? sign_of(sign) : exact_orientation(a, b, c, d);
}

int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double sign = predicates::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
  return is_sure(sign, {a.data(), b.data(), c.data()}, 2) ? sign_of(sign) : exact_turn(a, b, c);
}

bool passes_through(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  if (orientation(a, b, c, from) * orientation(a, b, c, to) >= 0) return false;
  const int first = orientation(from, to, a, b);
  return first != 0 && orientation(from, to, b, c) == first && orientation(from, to, c, a) == first;
}

bool are_on_a_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    if (turn({a[x], a[y]}, {b[x], b[y]}, {c[x], c[y]}) != 0) return false;
  }
  return true;
}

}  // namespace vantage::internal::prove
