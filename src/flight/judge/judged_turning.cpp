// What turning adds: a track over ground that curves no tighter than a circle of radius r, and heads at an angle a from
// a vector u, is longer than its progress along u by |u| (1 - cos a) a metre. To turn by a costs r (a - sin a), where
// there is room to: half of the way to the next stop at which vectors change. At a stop the track turns by half of the
// angle between the vectors on one side at least.
#include <algorithm>
#include <utility>

#include "flight/judge/judged_proofs.h"

namespace vantage::internal::flight::judge {
namespace {

const Whole& unit() {
  static const Whole kOne(kUnit);
  return kOne;
}

const Whole& square_unit() {
  static const Whole kSquare = Whole(kUnit) * Whole(kUnit);
  return kSquare;
}

std::int64_t level_square(const Direction& u) { return u[0] * u[0] + u[1] * u[1]; }

/// Half of the angle between two level vectors, or less, in units of 1 / kUnit: from the sine of a quarter of it.
/// `norms`: the product of their lengths, rounded down.
Whole half_angle(const Direction& a, const Direction& b, const Whole& norms) {
  const std::int64_t along = a[0] * b[0] + a[1] * b[1];
  const Whole over = along < 0 ? norms + Whole(1) : norms;
  const Whole cosine = std::min(square_unit(), -floor_divided(-(square_unit() * Whole(along)), over));
  const Whole half_cosine = root_down(floor_divided(square_unit() + cosine, Whole(2)));
  const Whole left = std::max(Whole(), unit() - Whole(1) - half_cosine);
  const Whole sine = root_down(floor_divided(unit() * left, Whole(2)));
  const Whole cube = sine * sine * sine;
  return sine + sine + floor_divided(cube, Whole(3) * square_unit()) +
         floor_divided(Whole(3) * cube * sine * sine, Whole(20) * square_unit() * square_unit());
}

/// a - sin a, or less.
Whole swung(const Whole& angle) {
  const Whole square = angle * angle;
  return floor_divided(square * angle * (Whole(20) * square_unit() - square),
                       Whole(120) * square_unit() * square_unit());
}

}  // namespace

Whole room_between(Cell& from, Cell& to, const Direction& direction) {
  return from.least({-direction[0], -direction[1], 0}) + to.least({direction[0], direction[1], 0});
}

Whole turning_at(const Whole& radius, const Direction& before, const Direction& behind, const Whole& room_before,
                 const Whole& room_behind) {
  const Whole norms = root_down(Whole(level_square(before)) * Whole(level_square(behind)));
  if (radius.sign() == 0 || norms.sign() == 0) return {};
  const Whole half = half_angle(before, behind, norms);
  Whole cost = swung(half) + swung(half);
  for (const Whole& room : {room_before, room_behind}) {
    cost = std::min(cost, swung(std::min(half + half, floor_divided(std::max(Whole(), room), radius + radius))));
  }
  const Whole weight = root_down(Whole(std::min(level_square(before), level_square(behind))));
  return floor_divided(weight * cost * radius, unit());
}

}  // namespace vantage::internal::flight::judge
