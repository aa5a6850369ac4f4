// What turning adds: a track over ground that curves no tighter than a circle of radius r, and heads at an angle a from
// a vector u, is longer than its progress along u by |u| (1 - cos a) a metre. To turn by a costs r (a - sin a), where
// there is room to: half of the way to the next stop at which vectors change. At a stop the track turns by half of the
// angle between the vectors on one side at least.
#include <algorithm>
#include <utility>

#include "flight/judge/judged_proofs.h"

namespace vantage::internal::flight::judge {
namespace {

const BigInteger& unit() {
  static const BigInteger kOne(kUnit);
  return kOne;
}

const BigInteger& square_unit() {
  static const BigInteger kSquare = BigInteger(kUnit) * BigInteger(kUnit);
  return kSquare;
}

std::int64_t level_square(const Direction& u) { return u[0] * u[0] + u[1] * u[1]; }

/// Half of the angle between two level vectors, or less, in units of 1 / kUnit: from the sine of a quarter of it.
/// `norms`: the product of their lengths, rounded down.
BigInteger half_angle(const Direction& a, const Direction& b, const BigInteger& norms) {
  const std::int64_t along = a[0] * b[0] + a[1] * b[1];
  const BigInteger over = along < 0 ? norms + BigInteger(1) : norms;
  const BigInteger cosine = std::min(square_unit(), -floor_divided(-(square_unit() * BigInteger(along)), over));
  const BigInteger half_cosine = root_down(floor_divided(square_unit() + cosine, BigInteger(2)));
  const BigInteger left = std::max(BigInteger(), unit() - BigInteger(1) - half_cosine);
  const BigInteger sine = root_down(floor_divided(unit() * left, BigInteger(2)));
  const BigInteger cube = sine * sine * sine;
  return sine + sine + floor_divided(cube, BigInteger(3) * square_unit()) +
         floor_divided(BigInteger(3) * cube * sine * sine, BigInteger(20) * square_unit() * square_unit());
}

/// a - sin a, or less.
BigInteger swung(const BigInteger& angle) {
  const BigInteger square = angle * angle;
  return floor_divided(square * angle * (BigInteger(20) * square_unit() - square),
                       BigInteger(120) * square_unit() * square_unit());
}

}  // namespace

BigInteger room_between(Cell& from, Cell& to, const Direction& direction) {
  return from.least({-direction[0], -direction[1], 0}) + to.least({direction[0], direction[1], 0});
}

BigInteger turning_at(const BigInteger& radius, const Direction& before, const Direction& behind,
                      const BigInteger& room_before, const BigInteger& room_behind) {
  const BigInteger norms = root_down(BigInteger(level_square(before)) * BigInteger(level_square(behind)));
  if (radius.sign() == 0 || norms.sign() == 0) return {};
  const BigInteger half = half_angle(before, behind, norms);
  BigInteger cost = swung(half) + swung(half);
  for (const BigInteger& room : {room_before, room_behind}) {
    cost = std::min(cost, swung(std::min(half + half, floor_divided(std::max(BigInteger(), room), radius + radius))));
  }
  const BigInteger weight = root_down(BigInteger(std::min(level_square(before), level_square(behind))));
  return floor_divided(weight * cost * radius, unit());
}

}  // namespace vantage::internal::flight::judge
