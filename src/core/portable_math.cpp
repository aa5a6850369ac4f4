#include "core/portable_math.h"

#include <array>
#include <utility>

namespace vantage::internal::portable {
namespace {

struct TwoPart {
  double high, low;
};

// Half of pi in three parts: the first two have 33 bits, so that they can be multiplied by 2^20 without rounding.
constexpr double kRight1 = 0x1.921fb544p+0, kRight2 = 0x1.0b4611a6p-34, kRight3 = 0x1.3198a2e037073p-69;
constexpr TwoPart kRight{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr TwoPart kHalfTurn{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr double kLargest = 1e6;

// a - b without rounding, where a is the larger one or the result is exact anyhow (Dekker 1971).
TwoPart difference(double a, double b) {
  const double high = a - b;
  return {high, (a - high) - b};
}

TwoPart difference(const TwoPart& a, const TwoPart& b) {
  const TwoPart result = difference(a.high, b.high);
  return {result.high, result.low + (a.low - b.low)};
}

// Faster than std::floor, which may be a call.
int nearest(double x) { return static_cast<int>(x + (x < 0 ? -0.5 : 0.5)); }

// The sum of c[k] z^k, even and odd terms side by side: half as long to wait for.
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double z) {
  const double square = z * z;
  double even = 0, odd = 0;
  for (std::size_t k = N; k-- > 0;) {
    double& sum = k % 2 == 0 ? even : odd;
    sum = sum * square + c[k];
  }
  return even + z * odd;
}

// Taylor's series without their first terms. What is left out is less than 1e-19 up to an eighth of a turn.
constexpr std::array<double, 8> kSine{-1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
                                      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
constexpr std::array<double, 8> kCosine{
    1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
    1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
constexpr std::array<double, 5> kArc{-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11};

// atan(k / 16), rounded, and what that leaves. Calculated with 60 digits.
constexpr int kSteps = 16;
constexpr std::array<TwoPart, kSteps + 1> kArcs{{
    {0, 0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

// The arc of a tangent, 0 to 1.
TwoPart arc_of(double tangent) {
  if (std::isnan(tangent)) return {tangent, 0};
  const int step = nearest(tangent * kSteps);
  const TwoPart& near = kArcs[static_cast<std::size_t>(step)];
  const double at = step * (1.0 / kSteps), t = (tangent - at) / (1 + tangent * at);
  const double z = t * t;
  const double rest = t * z * polynomial(kArc, z) + near.low;
  return step == 0 ? TwoPart{t, rest} : TwoPart{near.high, t + rest};
}

}  // namespace

SineCosine sine_cosine(double angle) {
  if (!(std::abs(angle) < kLargest)) {
    angle = std::fmod(angle, kHalfTurn.high * 2);
    if (std::isnan(angle)) return {angle, angle};
  }
  const int quarter = nearest(angle * (1 / kRight.high));
  const double turns = quarter;
  const TwoPart first = difference(angle - turns * kRight1, turns * kRight2);
  const TwoPart r = difference(first.high, turns * kRight3 - first.low);
  const double z = r.high * r.high, half = 0.5 * z, near = 1 - half;
  double sine = r.high + (r.high * z * polynomial(kSine, z) + r.low * near);
  double cosine = near + (((1 - near) - half) + (z * z * polynomial(kCosine, z) - r.high * r.low));
  if (quarter & 1) {
    std::swap(sine, cosine);
    cosine = -cosine;
  }
  return quarter & 2 ? SineCosine{-sine, -cosine} : SineCosine{sine, cosine};
}

double atan2(double y, double x) {
  const double across = std::abs(y), along = std::abs(x);
  TwoPart arc{0, 0};
  if (across > along) {
    arc = arc_of(along / across);
    arc = difference(kRight, arc);
  } else if (along > 0) {
    arc = arc_of(across / along);
  } else if (!(across <= along)) {
    arc.high = x + y;  // NaN
  }
  if (std::signbit(x)) arc = difference(kHalfTurn, arc);
  return std::copysign(arc.high + arc.low, y);
}

}  // namespace vantage::internal::portable
