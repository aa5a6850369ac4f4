// Whole numbers of any length, for judges that may not round.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage::internal::flight::judge {

/// Exact: nothing is rounded and nothing overflows. Throws std::length_error for more than kMostBits bits, which no
/// honest certificate needs.
class BigInteger {
 public:
  static constexpr std::size_t kMostBits = std::size_t{1} << 17;

  BigInteger() = default;
  BigInteger(std::int64_t value);  // NOLINT(google-explicit-constructor): it is a number like others

  /// value * 2^bits, which must be whole: see fraction_bits. Finite.
  static BigInteger scaled(double value, int bits);

  /// -1, 0, 1.
  int sign() const { return limbs_.empty() ? 0 : is_negative_ ? -1 : 1; }
  std::size_t bit_length() const;  ///< of the absolute value; of 0: 0
  BigInteger operator-() const;
  BigInteger abs() const { return sign() < 0 ? -*this : *this; }
  BigInteger& operator+=(const BigInteger& other);
  BigInteger& operator-=(const BigInteger& other) { return *this += -other; }
  friend BigInteger operator+(BigInteger a, const BigInteger& b) { return a += b; }
  friend BigInteger operator-(BigInteger a, const BigInteger& b) { return a += -b; }
  friend BigInteger operator*(const BigInteger& a, const BigInteger& b);

  friend bool operator==(const BigInteger& a, const BigInteger& b) = default;
  friend bool operator<(const BigInteger& a, const BigInteger& b) { return compare(a, b) < 0; }
  friend bool operator>(const BigInteger& a, const BigInteger& b) { return compare(a, b) > 0; }
  friend bool operator<=(const BigInteger& a, const BigInteger& b) { return compare(a, b) <= 0; }
  friend bool operator>=(const BigInteger& a, const BigInteger& b) { return compare(a, b) >= 0; }

  /// The largest whole number that is not above a / b; b > 0.
  friend BigInteger floor_divided(const BigInteger& a, const BigInteger& b);
  /// The largest whole number whose square is not above `square`, which is 0 or more.
  friend BigInteger root_down(const BigInteger& square);
  /// Greatest common divisor, >= 0; of 0 and 0: 0.
  friend BigInteger common_divisor(BigInteger a, BigInteger b);

  /// The largest double that is not above value / 2^bits; for values far within the range of doubles.
  double scaled_down(int bits) const;

 private:
  using Limbs = std::vector<std::uint32_t>;  // lowest first, the last one not 0

  static int compare(const BigInteger& a, const BigInteger& b);
  static int compare_limbs(const Limbs& a, const Limbs& b);
  static void add_limbs(Limbs& a, const Limbs& b);
  static void subtract_limbs(Limbs& a, const Limbs& b);  // a >= b
  static Limbs shifted_up(const Limbs& a, std::size_t bits);
  static Limbs divided(const Limbs& a, const Limbs& b, Limbs& rest);
  void trim();

  Limbs limbs_;
  bool is_negative_ = false;  // never of 0
};

BigInteger floor_divided(const BigInteger& a, const BigInteger& b);
BigInteger common_divisor(BigInteger a, BigInteger b);
BigInteger root_down(const BigInteger& square);

/// How many binary places behind the point a finite number has, 0 to 1074.
int fraction_bits(double value);

}  // namespace vantage::internal::flight::judge
