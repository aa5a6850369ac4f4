// Whole numbers of any length, against the machine's own and against what divisions must undo.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "flight/judge/big_integer.h"
#include "support/random.h"

namespace vantage::internal::flight::judge {
namespace {

using testing::Random;

/// Few bits and many, zeros and ones in rows.
BigInteger random_whole(Random& random, int most_limbs) {
  BigInteger value;
  const BigInteger base(std::int64_t{1} << 32);
  for (int i = random.integer(0, most_limbs); i > 0; --i) {
    std::int64_t limb = random.integer(0, std::numeric_limits<int>::max());
    if (random.chance(0.2)) limb = 0;
    if (random.chance(0.2)) limb = 0xffffffff;
    if (random.chance(0.2)) limb = 0x80000000;
    value = value * base + BigInteger(limb);
  }
  return random.chance(0.5) ? -value : value;
}

TEST(BigInteger, AgreesWithTheMachine) {
  Random random(71);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t a = random.integer(-2000000000, 2000000000), b = random.integer(-50000, 50000);
    EXPECT_EQ(BigInteger(a) + BigInteger(b), BigInteger(a + b));
    EXPECT_EQ(BigInteger(a) - BigInteger(b), BigInteger(a - b));
    EXPECT_EQ(BigInteger(a) * BigInteger(b), BigInteger(a * b));
    EXPECT_EQ(BigInteger(a) < BigInteger(b), a < b);
    EXPECT_EQ(BigInteger(a).sign(), a > 0 ? 1 : a < 0 ? -1 : 0);
    if (b > 0) {
      const std::int64_t floor = a / b - (a % b < 0 ? 1 : 0);
      EXPECT_EQ(floor_divided(BigInteger(a), BigInteger(b)), BigInteger(floor));
    }
  }
  EXPECT_EQ(BigInteger(std::numeric_limits<std::int64_t>::min()).bit_length(), 64U);
  EXPECT_EQ(BigInteger(0).bit_length(), 0U);
}

TEST(BigInteger, RootsAreTheLargestWhoseSquareFits) {
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    const BigInteger square = random_whole(random, i % 13).abs();
    const BigInteger root = root_down(square);
    EXPECT_LE(root * root, square);
    EXPECT_GT((root + BigInteger(1)) * (root + BigInteger(1)), square);
    EXPECT_EQ(root_down(root * root), root);
  }
  EXPECT_THROW(root_down(BigInteger(-1)), std::domain_error);
}

TEST(BigInteger, DivisionsLeaveWhatTheyShould) {
  Random random(72);
  for (int i = 0; i < 20000; ++i) {
    const BigInteger a = random_whole(random, 12), b = random_whole(random, 6).abs() + BigInteger(1);
    const BigInteger quotient = floor_divided(a, b), rest = a - quotient * b;
    EXPECT_GE(rest, BigInteger(0));
    EXPECT_LT(rest, b);
    const BigInteger c = random_whole(random, 4);
    EXPECT_EQ(floor_divided(a * b, b), a);
    EXPECT_EQ((a + c) * b, a * b + c * b);
    EXPECT_EQ(a - c, -(c - a));
    const BigInteger divisor = common_divisor(a * b, c * b);
    if (divisor.sign() > 0) {
      EXPECT_EQ(floor_divided(divisor, b) * b, divisor);
      EXPECT_EQ(floor_divided(a * b, divisor) * divisor, a * b);
      EXPECT_EQ(common_divisor(floor_divided(a * b, divisor), floor_divided(c * b, divisor)), BigInteger(1));
    }
  }
}

TEST(BigInteger, HoldsDoublesAndRoundsThemDown) {
  Random random(73);
  for (int i = 0; i < 5000; ++i) {
    const double value = std::ldexp(random.uniform(-1, 1), random.integer(-60, 40));
    const int bits = fraction_bits(value);
    EXPECT_EQ(std::ldexp(value, bits), std::floor(std::ldexp(value, bits)));
    if (bits > 0) {
      EXPECT_NE(std::ldexp(value, bits - 1), std::floor(std::ldexp(value, bits - 1)));
    }
    const BigInteger whole = BigInteger::scaled(value, bits + 7);
    EXPECT_EQ(whole.scaled_down(bits + 7), value);
    // A little less is the double below, a little more is the same one.
    const BigInteger fine = whole * BigInteger(std::int64_t{1} << 40);
    EXPECT_EQ((fine - BigInteger(1)).scaled_down(bits + 47), std::nextafter(value, -1e300));
    EXPECT_EQ((fine + BigInteger(1)).scaled_down(bits + 47), value);
  }
  EXPECT_EQ(fraction_bits(0), 0);
  EXPECT_EQ(fraction_bits(-0.75), 2);
  EXPECT_EQ(fraction_bits(std::numeric_limits<double>::denorm_min()), 1074);
  EXPECT_THROW(BigInteger::scaled(0.5, 0), std::length_error);
  BigInteger large(3);
  EXPECT_THROW(
      {
        for (int i = 0; i < 40; ++i) large = large * large;
      },
      std::length_error);
}

}  // namespace
}  // namespace vantage::internal::flight::judge
