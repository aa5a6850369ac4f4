#include "flight/judge/big_integer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vantage::internal::flight::judge {
namespace {

constexpr unsigned kLimbBits = 32;
constexpr int kDoubleBits = 53;

/// value = mantissa * 2^exponent, the mantissa odd; of 0: 0 and 0.
std::pair<std::int64_t, int> parts_of(double value) {
  if (value == 0) return {0, 0};
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), kDoubleBits));
  exponent -= kDoubleBits;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa / (std::int64_t{1} << zeros), exponent + zeros};
}

}  // namespace

int fraction_bits(double value) { return std::max(0, -parts_of(value).second); }

BigInteger::BigInteger(std::int64_t value) : is_negative_(value < 0) {
  auto left = value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  for (; left != 0; left >>= kLimbBits) limbs_.push_back(static_cast<std::uint32_t>(left));
}

BigInteger BigInteger::scaled(double value, int bits) {
  const auto [mantissa, exponent] = parts_of(value);
  BigInteger result(mantissa);
  if (mantissa == 0) return result;
  const int places = exponent + bits;
  if (places < 0) throw std::length_error("a number with a fraction");
  result.limbs_ = shifted_up(result.limbs_, static_cast<std::size_t>(places));
  return result;
}

std::size_t BigInteger::bit_length() const {
  return limbs_.empty() ? 0 : kLimbBits * limbs_.size() - static_cast<std::size_t>(std::countl_zero(limbs_.back()));
}

void BigInteger::trim() {
  while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  if (limbs_.empty()) is_negative_ = false;
  if (limbs_.size() > kMostBits / kLimbBits) throw std::length_error("a number is too long");
}

BigInteger BigInteger::operator-() const {
  BigInteger result = *this;
  result.is_negative_ = !is_negative_ && !limbs_.empty();
  return result;
}

int BigInteger::compare_limbs(const Limbs& a, const Limbs& b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = a.size(); i-- > 0;) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

int BigInteger::compare(const BigInteger& a, const BigInteger& b) {
  if (a.sign() != b.sign()) return a.sign() < b.sign() ? -1 : 1;
  return a.sign() * compare_limbs(a.limbs_, b.limbs_);
}

void BigInteger::add_limbs(Limbs& a, const Limbs& b) {
  if (a.size() < b.size()) a.resize(b.size());
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < a.size() && (i < b.size() || carry != 0); ++i) {
    carry += std::uint64_t{a[i]} + (i < b.size() ? b[i] : 0);
    a[i] = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;
  }
  if (carry != 0) a.push_back(static_cast<std::uint32_t>(carry));
}

void BigInteger::subtract_limbs(Limbs& a, const Limbs& b) {
  std::int64_t borrow = 0;
  for (std::size_t i = 0; i < a.size() && (i < b.size() || borrow != 0); ++i) {
    std::int64_t left = std::int64_t{a[i]} - (i < b.size() ? std::int64_t{b[i]} : 0) - borrow;
    borrow = left < 0 ? 1 : 0;
    if (left < 0) left += std::int64_t{1} << kLimbBits;
    a[i] = static_cast<std::uint32_t>(left);
  }
}

BigInteger& BigInteger::operator+=(const BigInteger& other) {
  if (other.limbs_.empty()) return *this;
  if (limbs_.empty()) return *this = other;
  if (is_negative_ == other.is_negative_) {
    add_limbs(limbs_, other.limbs_);
  } else if (compare_limbs(limbs_, other.limbs_) >= 0) {
    subtract_limbs(limbs_, other.limbs_);
  } else {
    Limbs larger = other.limbs_;
    subtract_limbs(larger, limbs_);
    limbs_ = std::move(larger);
    is_negative_ = other.is_negative_;
  }
  trim();
  return *this;
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
  BigInteger result;
  if (a.limbs_.empty() || b.limbs_.empty()) return result;
  result.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t k = 0; k < b.limbs_.size(); ++k) {
      carry += std::uint64_t{a.limbs_[i]} * b.limbs_[k] + result.limbs_[i + k];
      result.limbs_[i + k] = static_cast<std::uint32_t>(carry);
      carry >>= kLimbBits;
    }
    result.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
  }
  result.is_negative_ = a.is_negative_ != b.is_negative_;
  result.trim();
  return result;
}

BigInteger::Limbs BigInteger::shifted_up(const Limbs& a, std::size_t bits) {
  if (bits > kMostBits) throw std::length_error("a number is too long");
  const std::size_t whole = bits / kLimbBits, rest = bits % kLimbBits;
  Limbs result(whole, 0);
  std::uint64_t carry = 0;
  for (const std::uint32_t limb : a) {
    carry |= std::uint64_t{limb} << rest;
    result.push_back(static_cast<std::uint32_t>(carry));
    carry >>= kLimbBits;
  }
  if (carry != 0) result.push_back(static_cast<std::uint32_t>(carry));
  return result;
}

// Knuth, The Art of Computer Programming, volume 2, 4.3.1, algorithm D.
BigInteger::Limbs BigInteger::divided(const Limbs& a, const Limbs& b, Limbs& rest) {
  if (compare_limbs(a, b) < 0) {
    rest = a;
    return {};
  }
  constexpr std::uint64_t kBase = std::uint64_t{1} << kLimbBits;
  const auto shift = static_cast<std::size_t>(std::countl_zero(b.back()));
  const Limbs divisor = shifted_up(b, shift);
  Limbs left = shifted_up(a, shift);
  const std::size_t n = divisor.size();
  left.resize(a.size() + 1, 0);
  Limbs quotient(left.size() - n, 0);
  for (std::size_t j = quotient.size(); j-- > 0;) {
    const std::uint64_t top = (std::uint64_t{left[j + n]} << kLimbBits) | left[j + n - 1];
    std::uint64_t guess = top / divisor[n - 1], over = top % divisor[n - 1];
    while (guess >= kBase || (n > 1 && guess * divisor[n - 2] > ((over << kLimbBits) | left[j + n - 2]))) {
      --guess;
      over += divisor[n - 1];
      if (over >= kBase) break;
    }
    std::uint64_t carry = 0;
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      carry += i < n ? guess * divisor[i] : 0;
      std::int64_t digit = std::int64_t{left[i + j]} - static_cast<std::int64_t>(carry & (kBase - 1)) - borrow;
      borrow = digit < 0 ? 1 : 0;
      if (digit < 0) digit += static_cast<std::int64_t>(kBase);
      left[i + j] = static_cast<std::uint32_t>(digit);
      carry >>= kLimbBits;
    }
    if (borrow != 0) {  // the guess was one too many
      --guess;
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i <= n; ++i) {
        sum += std::uint64_t{left[i + j]} + (i < n ? divisor[i] : 0);
        left[i + j] = static_cast<std::uint32_t>(sum);
        sum >>= kLimbBits;
      }
    }
    quotient[j] = static_cast<std::uint32_t>(guess);
  }
  // What is left was shifted with the divisor: back down.
  rest.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t two = (std::uint64_t{left[i + 1]} << kLimbBits) | left[i];
    rest[i] = static_cast<std::uint32_t>((i + 1 < n ? two : std::uint64_t{left[i]}) >> shift);
  }
  return quotient;
}

BigInteger floor_divided(const BigInteger& a, const BigInteger& b) {
  if (b.sign() <= 0) throw std::domain_error("division by what is not positive");
  BigInteger quotient, rest;
  quotient.limbs_ = BigInteger::divided(a.limbs_, b.limbs_, rest.limbs_);
  rest.trim();
  quotient.trim();
  quotient.is_negative_ = a.is_negative_ && !quotient.limbs_.empty();
  if (a.is_negative_ && rest.sign() != 0) quotient += BigInteger(-1);
  return quotient;
}

BigInteger root_down(const BigInteger& square) {
  if (square.sign() < 0) throw std::domain_error("root of what is negative");
  if (square.sign() == 0) return {};
  // Newton's steps from above go down until they are there.
  BigInteger root;
  root.limbs_ = BigInteger::shifted_up({1}, (square.bit_length() + 1) / 2);
  for (;;) {
    BigInteger next = floor_divided(root + floor_divided(square, root), BigInteger(2));
    if (next >= root) return root;
    root = std::move(next);
  }
}

BigInteger common_divisor(BigInteger a, BigInteger b) {
  a.is_negative_ = b.is_negative_ = false;
  while (b.sign() != 0) {
    BigInteger rest;
    BigInteger::divided(a.limbs_, b.limbs_, rest.limbs_);
    rest.trim();
    a = std::move(b);
    b = std::move(rest);
  }
  return a;
}

double BigInteger::scaled_down(int bits) const {
  const std::size_t length = bit_length();
  const std::size_t drop = length > kDoubleBits ? length - kDoubleBits : 0;
  BigInteger unit(1);
  unit.limbs_ = shifted_up(unit.limbs_, drop);
  const BigInteger top = floor_divided(*this, unit);  // at most 2^53 in absolute value: a double holds it
  double value = 0;
  for (std::size_t i = top.limbs_.size(); i-- > 0;) value = value * 4294967296.0 + top.limbs_[i];
  return std::ldexp(top.is_negative_ ? -value : value, static_cast<int>(drop) - bits);
}

}  // namespace vantage::internal::flight::judge
