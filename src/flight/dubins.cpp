// Dubins paths in the plane, by the centres of their circles: Dubins 1957; Shkel and Lumelsky 2001.
#include "vantage/dubins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/portable_math.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace portable = internal::portable;
using Point = Eigen::Vector2d;

constexpr double kFullTurn = 2 * std::numbers::pi;
/// Arcs that lack so little of a full turn are none: rounding made them.
constexpr double kNoTurn = 1e-10;
/// Relative: circles that miss each other by so little touch, and centres so near to each other are one.
constexpr double kTouch = 1e-12;

constexpr std::array<std::array<int, 3>, 6> kTurns = {
    {{1, 0, 1}, {-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {-1, 1, -1}, {1, -1, 1}}};

/// The angle from 0 to a full turn.
double turned(double angle) {
  double rest = std::fmod(angle, kFullTurn);
  if (rest < 0) rest += kFullTurn;
  return rest > kFullTurn - kNoTurn ? 0 : rest;
}

/// All lengths in radii, about the first pose.
struct Ends {
  Point from, to;
  double heading_from, heading_to;
  double scale;  ///< of what is rounded
};

Point centre(const Point& at, double heading, int turn) {
  const auto [sine, cosine] = portable::sine_cosine(heading);
  return at + turn * Point(-sine, cosine);
}

using Pieces = std::array<double, 3>;

/// Arcs that turn the same way, and a line.
Pieces same_sides(const Ends& ends, int turn) {
  const Point between = centre(ends.to, ends.heading_to, turn) - centre(ends.from, ends.heading_from, turn);
  const double length = between.norm();
  // One circle: the direction between its centres says nothing.
  const bool is_one = length <= kTouch * ends.scale;
  const double along = is_one ? ends.heading_from : portable::atan2(between.y(), between.x());
  return {turned(turn * (along - ends.heading_from)), is_one ? 0 : length, turned(turn * (ends.heading_to - along))};
}

/// Arcs that turn different ways, and a line that crosses between the circles.
std::optional<Pieces> crossed_sides(const Ends& ends, int turn) {
  const Point between = centre(ends.to, ends.heading_to, -turn) - centre(ends.from, ends.heading_from, turn);
  const double length = between.norm();
  if (length < 2 * (1 - kTouch)) return std::nullopt;
  const double straight = std::sqrt(std::max(0.0, (length - 2) * (length + 2)));
  const double along = portable::atan2(between.y(), between.x()) + turn * portable::atan2(2, straight);
  return Pieces{turned(turn * (along - ends.heading_from)), straight, turned(-turn * (ends.heading_to - along))};
}

/// Three arcs: the outer ones turn by `turn`. The middle circle may be on either side of the line between the centres.
std::optional<Pieces> three_arcs(const Ends& ends, int turn) {
  const Point between = centre(ends.to, ends.heading_to, turn) - centre(ends.from, ends.heading_from, turn);
  const double length = between.norm();
  if (length > 4 * (1 + kTouch)) return std::nullopt;
  const double direction = portable::atan2(between.y(), between.x());
  const double half = std::min(1.0, length / 4), corner = portable::acos(half);
  std::optional<Pieces> best;
  for (const int side : {1, -1}) {
    // Directions from the outer centres to the middle one, then where the circles touch, as headings of the vehicle.
    const double to_middle = direction + side * corner, from_end = direction + std::numbers::pi - side * corner;
    const double first = to_middle + turn * std::numbers::pi / 2, last = from_end + turn * std::numbers::pi / 2;
    const Pieces pieces = {turned(turn * (first - ends.heading_from)), turned(-turn * (last - first)),
                           turned(turn * (ends.heading_to - last))};
    const auto sum = [](const Pieces& p) { return p[0] + p[1] + p[2]; };
    if (!best || sum(pieces) < sum(*best)) best = pieces;
  }
  return best;
}

std::optional<Pieces> pieces_of(DubinsWord word, const Ends& ends) {
  switch (word) {
    case DubinsWord::lsl:
      return same_sides(ends, 1);
    case DubinsWord::rsr:
      return same_sides(ends, -1);
    case DubinsWord::lsr:
      return crossed_sides(ends, 1);
    case DubinsWord::rsl:
      return crossed_sides(ends, -1);
    case DubinsWord::rlr:
      return three_arcs(ends, -1);
    case DubinsWord::lrl:
      return three_arcs(ends, 1);
  }
  return std::nullopt;
}

Ends ends_of(const PlanePose& from, const PlanePose& to, double radius) {
  const auto is_finite = [](const PlanePose& pose) {
    return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad);
  };
  if (!is_finite(from) || !is_finite(to)) {
    throw Error(ErrorCode::coordinate_not_finite, "a pose of a Dubins path is not finite", "dubins",
                "give finite coordinates and a finite heading");
  }
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw Error(ErrorCode::value_out_of_range, "the turn radius is not a positive number", "dubins",
                "give metres above 0");
  }
  const Point offset((to.x_m - from.x_m) / radius, (to.y_m - from.y_m) / radius);
  // Differences of large coordinates are exact, but what they were rounded to before is not.
  const double size = std::max({std::abs(from.x_m), std::abs(from.y_m), std::abs(to.x_m), std::abs(to.y_m)}) / radius;
  return {Point::Zero(), offset, from.heading_rad, to.heading_rad, 1 + offset.norm() + 1e-3 * size};
}

DubinsPath path_of(DubinsWord word, const Pieces& pieces, const PlanePose& from, double radius) {
  return {from, radius, word, {pieces[0] * radius, pieces[1] * radius, pieces[2] * radius}};
}

}  // namespace

const char* name_of(DubinsWord word) {
  constexpr std::array<const char*, 6> kNames = {"LSL", "RSR", "LSR", "RSL", "RLR", "LRL"};
  return kNames[static_cast<std::size_t>(word)];
}

int DubinsPath::turn_of(std::size_t piece) const { return kTurns[static_cast<std::size_t>(word)][piece]; }

PlanePose DubinsPath::at(double distance_m) const {
  PlanePose pose = from;
  double rest = std::max(0.0, distance_m);
  for (std::size_t i = 0; i < 3 && rest > 0; ++i) {
    const double length = std::min(rest, pieces_m[i]);
    const int turn = turn_of(i);
    const double angle = turn * length / radius_m;
    // The chord of the arc: exact for short arcs, where differences of sines are not.
    const double chord = turn == 0 ? length : 2 * radius_m * portable::sin(length / radius_m / 2);
    const auto [sine, cosine] = portable::sine_cosine(pose.heading_rad + angle / 2);
    pose.x_m += chord * cosine;
    pose.y_m += chord * sine;
    pose.heading_rad += angle;
    rest -= length;
  }
  return pose;
}

std::optional<DubinsPath> dubins_of_word(DubinsWord word, const PlanePose& from, const PlanePose& to, double radius_m) {
  const std::optional<Pieces> pieces = pieces_of(word, ends_of(from, to, radius_m));
  if (!pieces) return std::nullopt;
  return path_of(word, *pieces, from, radius_m);
}

DubinsPath shortest_dubins(const PlanePose& from, const PlanePose& to, double radius_m) {
  const Ends ends = ends_of(from, to, radius_m);
  DubinsPath best;
  double shortest = std::numeric_limits<double>::infinity();
  for (int w = 0; w < 6; ++w) {
    const auto word = static_cast<DubinsWord>(w);
    const std::optional<Pieces> pieces = pieces_of(word, ends);
    if (!pieces) continue;
    const DubinsPath path = path_of(word, *pieces, from, radius_m);
    if (path.length_m() >= shortest) continue;
    best = path;
    shortest = path.length_m();
  }
  return best;
}

}  // namespace vantage
