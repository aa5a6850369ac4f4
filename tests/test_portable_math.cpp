// Angle functions that have the same bits everywhere: how good they are, and that these are the bits.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "core/portable_math.h"
#include "support/random.h"

namespace vantage::testing {
namespace {

using namespace internal;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In units in the last place of the true value.
double error_of(double found, long double truth) {
  const double size = std::abs(static_cast<double>(truth));
  return static_cast<double>(std::abs(found - truth) / (std::nextafter(size, kInfinity) - size));
}

/// Angles of all sizes, many of them next to multiples of a quarter turn, where sine or cosine vanish.
double draw_angle(Random& random) {
  if (random.chance(0.2)) return std::round(random.uniform(-6e5, 6e5)) * (std::numbers::pi / 2);
  return random.uniform(-1, 1) * std::pow(10, random.uniform(-9, 6));
}

TEST(PortableMath, IsAsGoodAsItSays) {
  if constexpr (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "nothing better to compare with";
  Random random(1);
  double sine = 0, cosine = 0, tangent = 0, arc = 0, arc_cosine = 0, length = 0;
  for (int i = 0; i < 200000; ++i) {
    const double angle = draw_angle(random);
    const long double exact = angle;
    sine = std::max(sine, error_of(portable::sin(angle), std::sin(exact)));
    cosine = std::max(cosine, error_of(portable::cos(angle), std::cos(exact)));
    tangent = std::max(tangent, error_of(portable::tan(angle), std::tan(exact)));
    const double x = draw_angle(random), y = draw_angle(random);
    arc = std::max(arc, error_of(portable::atan2(y, x), std::atan2(static_cast<long double>(y), x)));
    length = std::max(length, error_of(portable::hypot(y, x), std::hypot(static_cast<long double>(y), x)));
    const double near_one = 1 - std::pow(10, random.uniform(-16, 0.3));
    arc_cosine =
        std::max(arc_cosine, error_of(portable::acos(near_one), std::acos(static_cast<long double>(near_one))));
  }
  EXPECT_LT(sine, 1.2);
  EXPECT_LT(cosine, 1.2);
  EXPECT_LT(tangent, 3);
  EXPECT_LT(arc, 3);
  EXPECT_LT(arc_cosine, 3);
  EXPECT_LT(length, 1.3);
}

TEST(PortableMath, SpecialValues) {
  for (const double y : {0.0, -0.0, 1.0, -1.0, 1e-300, -2.5, kInfinity, -kInfinity}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, 1e-300, -2.5}) {
      EXPECT_DOUBLE_EQ(portable::atan2(y, x), std::atan2(y, x)) << y << ", " << x;
      EXPECT_EQ(std::signbit(portable::atan2(y, x)), std::signbit(y)) << y << ", " << x;
    }
  }
  EXPECT_EQ(portable::sin(0), 0);
  EXPECT_EQ(portable::cos(0), 1);
  EXPECT_EQ(portable::acos(1), 0);
  EXPECT_EQ(portable::acos(-1), std::numbers::pi);
  EXPECT_EQ(portable::acos(0), std::numbers::pi / 2);
  EXPECT_EQ(portable::atan(1), std::numbers::pi / 4);
  EXPECT_LE(std::abs(portable::sin(1e300)), 1);
  for (const double nan : {portable::sin(kInfinity), portable::cos(std::nan("")), portable::atan2(1, std::nan("")),
                           portable::atan2(std::nan(""), 1), portable::acos(1.5), portable::atan2(std::nan(""), 0)}) {
    EXPECT_TRUE(std::isnan(nan));
  }
}

// The sums of the bits of 100,000 values, as GCC and clang made them for x86-64 and clang for WebAssembly.
TEST(PortableMath, HasTheSameBitsEverywhere) {
  std::uint64_t state = 12, sum = 0;
  const auto add = [&](double value) { sum = (sum ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15U; };
  for (int i = 0; i < 100000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const double angle = static_cast<double>(static_cast<std::int64_t>(state)) * 0x1p-59;  // -16 to 16
    add(portable::sin(angle));
    add(portable::cos(angle));
    add(portable::tan(angle));
    add(portable::atan2(angle, 1.5));
    add(portable::atan2(1.5, angle));
    add(portable::acos(angle / 16));
    add(portable::hypot(angle, 1.5));
  }
  EXPECT_EQ(sum, 0x7c442f668d9e7af3U);
}

}  // namespace
}  // namespace vantage::testing
