// Dubins paths in space: Vana, Alves Neto, Faigl and Macharet 2020, "Minimal 3D Dubins path with bounded curvature and
// pitch angle".
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vantage/dubins.h"
#include "vantage/error.h"

namespace vantage {
namespace {

constexpr double kClimbTolerance = 1e-12;  ///< radians, for climbs that rounding moved out of the limits
constexpr double kMostRadii = 1e6;
constexpr double kMostSpirals = 1e6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_wing(const WingLimits& limits) {
  const double upright = std::numbers::pi / 2;
  if (limits.lowest_climb_rad > -upright && limits.lowest_climb_rad <= 0 && limits.highest_climb_rad >= 0 &&
      limits.highest_climb_rad < upright) {
    return;
  }
  throw Error(ErrorCode::value_out_of_range, "the limits of the climb are not from -90 to 0 and from 0 to 90 degrees",
              "dubins", "give the lowest one at most 0 and the highest one at least 0");
}

bool is_within(double climb, const WingLimits& limits) {
  return climb >= limits.lowest_climb_rad - kClimbTolerance && climb <= limits.highest_climb_rad + kClimbTolerance;
}

/// The shortest profile of two arcs and a line whose climb stays within the limits.
std::optional<DubinsPath> profile_of(const PlanePose& from, const PlanePose& to, double radius,
                                     const WingLimits& limits) {
  std::optional<DubinsPath> best;
  for (const DubinsWord word : {DubinsWord::lsl, DubinsWord::rsr, DubinsWord::lsr, DubinsWord::rsl}) {
    const std::optional<DubinsPath> path = dubins_of_word(word, from, to, radius);
    if (!path || (best && path->length_m() >= best->length_m())) continue;
    const double middle = from.heading_rad + path->turn_of(0) * path->pieces_m[0] / radius;
    const bool is_loop = path->pieces_m[2] > std::numbers::pi * radius;
    if (is_within(middle, limits) && !is_loop) best = path;
  }
  return best;
}

/// With as few full turns at the start as the climb needs, but none unless `may_turn`.
std::optional<DubinsAirplanePath> of_radius(const SpacePose& from, const SpacePose& to, const WingLimits& limits,
                                            double factor, bool may_turn) {
  const double radius = limits.turn_radius_m;
  const DubinsPath shortest = shortest_dubins({from.position.x(), from.position.y(), from.heading_rad},
                                              {to.position.x(), to.position.y(), to.heading_rad}, radius * factor);
  // 1 / r_v^2 = 1 / r^2 - 1 / (factor r)^2
  const double profile_radius = radius * factor / std::sqrt((factor - 1) * (factor + 1));
  const double full_turn = 2 * std::numbers::pi * radius * factor, rise = to.position.z() - from.position.z();
  const double steepest = std::tan(rise > 0 ? limits.highest_climb_rad : -limits.lowest_climb_rad);
  const double needed = steepest > 0 ? std::abs(rise) / steepest : rise != 0 ? kInfinity : 0;
  const double turns = may_turn ? std::max(0.0, std::floor((needed - shortest.length_m()) / full_turn)) : 0;
  if (turns > kMostSpirals) return std::nullopt;
  constexpr int kMoreTurns = 4;  // what the arcs of the profile may need
  for (int more = 0; more <= (may_turn ? kMoreTurns : 0); ++more) {
    DubinsPath above = shortest;
    above.pieces_m[0] += (turns + more) * full_turn;
    const std::optional<DubinsPath> profile =
        profile_of({0, from.position.z(), from.climb_rad}, {above.length_m(), to.position.z(), to.climb_rad},
                   profile_radius, limits);
    if (profile) return DubinsAirplanePath{above, *profile};
  }
  return std::nullopt;
}

/// In the plane z = constant: no profile is needed.
DubinsAirplanePath level_path(const SpacePose& from, const SpacePose& to, double radius) {
  const DubinsPath above = shortest_dubins({from.position.x(), from.position.y(), from.heading_rad},
                                           {to.position.x(), to.position.y(), to.heading_rad}, radius);
  return {above, {{0, from.position.z(), 0}, radius, DubinsWord::lsl, {0, above.length_m(), 0}}};
}

/// The paper's local search for the radius: longer steps while they help, shorter ones the other way when they do not.
std::optional<DubinsAirplanePath> search(const SpacePose& from, const SpacePose& to, const WingLimits& limits,
                                         bool may_turn) {
  double factor = 2;
  std::optional<DubinsAirplanePath> best = of_radius(from, to, limits, factor, may_turn);
  while (!best && factor < kMostRadii) {
    factor *= 2;
    best = of_radius(from, to, limits, factor, may_turn);
  }
  if (!best) return std::nullopt;
  double step = 0.1;
  constexpr int kMostSteps = 100;
  for (int i = 0; i < kMostSteps && std::abs(step) > 1e-8 * factor; ++i) {
    const double tried = std::max(1 + 1e-9, factor + step);
    const std::optional<DubinsAirplanePath> path = of_radius(from, to, limits, tried, may_turn);
    if (path && path->length_m() < best->length_m()) {
      best = path;
      factor = tried;
      step *= 2;
    } else {
      step *= -0.1;
    }
  }
  return best;
}

}  // namespace

SpacePose DubinsAirplanePath::at(double distance_m) const {
  const PlanePose height = profile.at(distance_m), place = above.at(height.x_m);
  return {Vec3(place.x_m, place.y_m, height.y_m), place.heading_rad, height.heading_rad};
}

std::optional<DubinsAirplanePath> dubins_airplane(const SpacePose& from, const SpacePose& to,
                                                  const WingLimits& limits) {
  check_wing(limits);
  if (!std::isfinite(from.climb_rad) || !std::isfinite(to.climb_rad) || !from.position.allFinite() ||
      !to.position.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "a pose of a Dubins path is not finite", "dubins",
                "give finite coordinates and angles");
  }
  const bool is_level = from.position.z() == to.position.z() && from.climb_rad == 0 && to.climb_rad == 0;
  if (is_level) return level_path(from, to, limits.turn_radius_m);
  if (!is_within(from.climb_rad, limits) || !is_within(to.climb_rad, limits)) return std::nullopt;
  std::optional<DubinsAirplanePath> best = search(from, to, limits, false);
  // Where the climb bounds the path, full turns may be shorter than wide ones; on one line, only they help.
  const double rise = to.position.z() - from.position.z();
  const double steepest = std::sin(rise > 0 ? limits.highest_climb_rad : -limits.lowest_climb_rad);
  const double distance = (to.position - from.position).norm();
  constexpr double kClose = 1.05;
  if (best && best->length_m() <= kClose * std::max(distance, steepest > 0 ? std::abs(rise) / steepest : 0))
    return best;
  const std::optional<DubinsAirplanePath> turning = search(from, to, limits, true);
  return turning && (!best || turning->length_m() < best->length_m()) ? turning : best;
}

std::vector<double> DubinsAirplanePath::stations(double chord_error_m) const {
  if (!(chord_error_m > 0)) {
    throw Error(ErrorCode::value_out_of_range, "the chord error is not positive", "dubins", "give metres above 0");
  }
  // Where the pieces of either curve begin, as lengths in space. Along a piece of the profile the distance seen from
  // above grows, as the climb is less than upright: bisect.
  const double length = length_m();
  std::vector<double> breaks = {0, profile.pieces_m[0], profile.pieces_m[0] + profile.pieces_m[1], length};
  double from_above = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    from_above += above.pieces_m[i];
    double low = 0, high = length;
    constexpr int kHalvings = 60;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = (low + high) / 2;
      (profile.at(middle).x_m < from_above ? low : high) = middle;
    }
    breaks.push_back(high);
  }
  std::sort(breaks.begin(), breaks.end());
  // 1 / r^2 <= 1 / r_h^2 + 1 / r_v^2 bounds the curvature of the curve in space.
  const double curvature = std::hypot(1 / above.radius_m, 1 / profile.radius_m);
  const double longest = std::sqrt(8 * chord_error_m / curvature);
  std::vector<double> stations = {0};
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double begin = breaks[i], end = breaks[i + 1], middle = (begin + end) / 2;
    if (!(end > begin)) continue;
    const SpacePose a = at(begin), b = at(end), m = at(middle);
    const bool is_straight = (m.position - (a.position + b.position) / 2).norm() <= 1e-9 * (end - begin);
    const double count = is_straight ? 1 : std::ceil((end - begin) / longest);
    for (int k = 1; k <= static_cast<int>(count); ++k) stations.push_back(begin + (end - begin) * k / count);
  }
  if (stations.size() == 1) stations.push_back(length);
  return stations;
}

}  // namespace vantage
