#include "flight/tour/turning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

/// A part of the radius, at each stop: more than rounding loses here, and more than whole numbers of 2^-30 lose where a
/// certificate is judged (tools/check_tour.py has the formula in them).
constexpr double kTurnRounding = 3e-8;
constexpr double kSumRounding = 0x1p-48;  // of coordinates: more than sums of three products lose
constexpr double kHardlyTurns = 0.35;     // an angle: 20 degrees

/// t - sin(t), or less: for angles up to pi.
double swung(double angle) { return angle * angle * angle * (20 - angle * angle) / 120; }

Vec3 level(const Direction& direction) {
  Vec3 vector = vector_of(direction);
  vector.z() = 0;
  return vector;
}

/// Half of the angle between two level vectors, or a little less: by the sine of a quarter of it.
double half_angle(const Vec3& one, const Vec3& other, double norms) {
  const double cosine = std::clamp(one.dot(other) / norms, -1.0, 1.0);
  const double half_cosine = std::sqrt((1 + cosine) / 2);
  const double sine = std::sqrt((1 - half_cosine) / 2);
  return 2 * sine + sine * sine * sine / 3 + 3 * sine * sine * sine * sine * sine / 20;
}

/// A sequence of which stops were left out.
struct Reduced {
  TouringProgram program;
  std::vector<Direction> directions;
  std::vector<std::size_t> leg_of;  // of each leg of the whole sequence

  std::vector<Direction> of_all() const {
    std::vector<Direction> all;
    for (const std::size_t leg : leg_of) all.push_back(directions[leg]);
    return all;
  }

  Reduced without(std::size_t stop) const {
    Reduced less = *this;
    const std::size_t count = program.hulls.size();
    less.program.hulls.erase(less.program.hulls.begin() + static_cast<std::ptrdiff_t>(stop));
    for (std::size_t& leg : less.leg_of) {
      if (leg == stop) leg = (stop + count - 1) % count;
      if (leg > stop) --leg;
    }
    return less;
  }
};

/// Stops at which a tour hardly turns, the straightest first.
std::vector<std::size_t> nearly_straight(const Reduced& of) {
  std::vector<std::pair<double, std::size_t>> found;
  const std::size_t count = of.program.hulls.size();
  for (std::size_t k = of.program.closed ? 0 : 1; k < of.directions.size(); ++k) {
    const Vec3 before = level(of.directions[(k + count - 1) % count]), behind = level(of.directions[k]);
    const double norms = before.norm() * behind.norm();
    if (norms == 0 || of.program.hulls[k]->is_point()) continue;
    const double angle = 2 * half_angle(before, behind, norms);
    if (angle < kHardlyTurns) found.emplace_back(angle, k);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> stops;
  for (const auto& [angle, stop] : found) stops.push_back(stop);
  return stops;
}

}  // namespace

double turning_part(const Direction& before, const Direction& behind, double before_m, double behind_m,
                    double radius_m) {
  const Vec3 one = level(before), other = level(behind);
  const double norms = one.norm() * other.norm();
  if (norms == 0 || radius_m <= 0) return 0;
  const double half = half_angle(one, other, norms);
  double least = 2 * swung(half);
  for (const double room_m : {before_m, behind_m}) {
    least = std::min(least, swung(std::min(2 * half, std::max(0.0, room_m) / (2 * radius_m))));
  }
  return std::max(0.0, radius_m * (std::min(one.norm(), other.norm()) * least - kTurnRounding));
}

double level_distance_m(const Hull& from, const Hull& to, const Direction& direction) {
  const Vec3 vector = level(direction);
  const double apart = vector.dot(to.lowest(vector)) - vector.dot(from.lowest(-vector));
  const double error = kSumRounding * (from.reach_m() + to.reach_m()) + 2 * (from.moved_m() + to.moved_m());
  return std::max(0.0, apart - error);
}

double turning_bound(const TouringProgram& program, std::span<const Direction> directions, double radius_m) {
  const std::size_t count = program.hulls.size();
  if (radius_m <= 0 || directions.empty()) return 0;
  const auto before = [&](std::size_t k) {
    return k > 0 || program.closed ? directions[(k + count - 1) % count] : Direction{};
  };
  const auto behind = [&](std::size_t k) { return k < directions.size() ? directions[k] : Direction{}; };
  // Where the vector stays the same, it does not matter where along the track the stop is.
  std::vector<std::size_t> turns;
  for (std::size_t k = 0; k < count; ++k) {
    if (before(k) != behind(k) || program.hulls[k]->is_point()) turns.push_back(k);
  }
  std::vector<double> rooms;  // behind each
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const std::size_t next = turns[(i + 1) % turns.size()];
    rooms.push_back(level_distance_m(*program.hulls[turns[i]], *program.hulls[next], behind(turns[i])));
  }
  double sum = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const std::size_t k = turns[i];
    if (program.hulls[k]->is_point()) continue;
    sum += turning_part(before(k), behind(k), rooms[(i + rooms.size() - 1) % rooms.size()], rooms[i], radius_m);
  }
  return sum;
}

std::vector<Direction> straightened(const TouringProgram& program, std::vector<Direction> directions, double radius_m,
                                    const TouringOptions& options, const std::function<bool()>& is_late) {
  if (radius_m <= 0 || directions.empty() || !program.at_least_m.empty()) return directions;
  const auto value = [&](const std::vector<Direction>& of) {
    return touring_bound(program, of) + turning_bound(program, of, radius_m);
  };
  double best = value(directions);
  Reduced reduced = {program, directions, std::vector<std::size_t>(directions.size())};
  std::iota(reduced.leg_of.begin(), reduced.leg_of.end(), std::size_t{0});
  for (bool is_better = true; is_better && best < options.enough_m;) {
    is_better = false;
    if (reduced.program.hulls.size() <= 3) break;
    for (const std::size_t stop : nearly_straight(reduced)) {
      if (is_late && is_late()) return directions;
      Reduced less = reduced.without(stop);
      less.directions = solve_touring(less.program, options).directions;
      std::vector<Direction> all = less.of_all();
      const double bound = value(all);
      if (bound <= best) continue;
      best = bound;
      directions = std::move(all);
      reduced = std::move(less);
      is_better = true;
      break;
    }
  }
  return directions;
}

}  // namespace vantage::internal::flight::tour
