#include "core/zone_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "common/input.h"
#include "core/orientation.h"
#include "core/read_limits.h"

namespace vantage::internal::core {
namespace {

using Point = Eigen::Vector2d;

struct Side {
  Point from, to;
  std::size_t ring = 0;  ///< 0: outer; holes are counted from 1
  std::size_t index = 0, count = 0;

  double min_x() const { return std::min(from.x(), to.x()); }
  double max_x() const { return std::max(from.x(), to.x()); }
  bool follows(const Side& other) const { return ring == other.ring && index == (other.index + 1) % other.count; }
};

/// On which side of the line from a to b the point c lies: 1 left, -1 right, 0 on it as far as doubles can tell.
int side_of(const Point& a, const Point& b, const Point& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y()), right = (b.y() - a.y()) * (c.x() - a.x());
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
  const double area = left - right;
  return area > rounding ? 1 : area < -rounding ? -1 : 0;
}

bool in_box_of(const Side& side, const Point& p) {
  return p.x() >= side.min_x() && p.x() <= side.max_x() && p.y() >= std::min(side.from.y(), side.to.y()) &&
         p.y() <= std::max(side.from.y(), side.to.y());
}

bool meet(const Side& a, const Side& b) {
  const int b_from = side_of(a.from, a.to, b.from), b_to = side_of(a.from, a.to, b.to);
  const int a_from = side_of(b.from, b.to, a.from), a_to = side_of(b.from, b.to, a.to);
  if (b_from * b_to < 0 && a_from * a_to < 0) return true;
  return (b_from == 0 && in_box_of(a, b.from)) || (b_to == 0 && in_box_of(a, b.to)) ||
         (a_from == 0 && in_box_of(b, a.from)) || (a_to == 0 && in_box_of(b, a.to));
}

/// Whether the second of two neighbours, which share a corner, runs back along the first.
bool folds_back(const Side& first, const Side& second) {
  return side_of(first.from, first.to, second.to) == 0 && (first.to - first.from).dot(second.to - second.from) < 0;
}

std::string place_text(const Point& p) { return "[" + shortest(p.x()) + ", " + shortest(p.y()) + "]"; }

std::string ring_text(std::size_t ring) { return ring == 0 ? "the outline" : "hole " + std::to_string(ring - 1); }

std::string side_text(const Side& side) {
  return "side " + std::to_string(side.index) + (side.ring == 0 ? "" : " of " + ring_text(side.ring));
}

/// What is wrong with heights that may be infinite; `name` begins the message.
std::optional<LimitFault> fault_of_heights(const std::string& name, double low, double high) {
  if (std::isnan(low) || std::isnan(high)) {
    return LimitFault{ErrorCode::value_out_of_range, name + " is not a number", "give numbers, or infinite ones"};
  }
  if (low > high) {
    return LimitFault{ErrorCode::limits_reversed,
                      name + " is reversed: " + shortest(low) + " is above " + shortest(high),
                      "write " + name + ": [" + shortest(high) + ", " + shortest(low) + "], in metres"};
  }
  if (low == high) {
    return LimitFault{ErrorCode::limits_empty, name + " leaves no room: both ends are " + shortest(low),
                      "give an upper end above the lower one"};
  }
  return std::nullopt;
}

std::optional<LimitFault> fault_of_heights(const Zone& zone) {
  if (auto fault = fault_of_heights("z", zone.min_z_m, zone.max_z_m)) return fault;
  if (!zone.above_ground) return std::nullopt;
  return fault_of_heights("agl", zone.above_ground->min_m, zone.above_ground->max_m);
}

std::optional<LimitFault> fault_of_ring(const Zone::Ring& ring, std::size_t number) {
  if (ring.size() < 3) {
    return LimitFault{ErrorCode::zone_not_simple,
                      ring_text(number) + " needs at least 3 corners, it has " + std::to_string(ring.size()),
                      "give the corners in order"};
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!ring[i].allFinite()) {
      return LimitFault{ErrorCode::coordinate_not_finite,
                        "corner " + std::to_string(i) + " of " + ring_text(number) + " is not finite", "correct it"};
    }
    // Products of coordinates beyond that would not be numbers at some scale.
    if (ring[i].cwiseAbs().maxCoeff() > kMaxCoordinate) {
      return LimitFault{ErrorCode::coordinate_too_large,
                        "corner " + std::to_string(i) + " of " + ring_text(number) + " is farther than 1,000,000 km",
                        "give coordinates in metres"};
    }
    const std::size_t next = (i + 1) % ring.size();
    if (ring[i] == ring[next]) {
      return LimitFault{ErrorCode::zone_not_simple,
                        "corners " + std::to_string(i) + " and " + std::to_string(next) + " of " + ring_text(number) +
                            " are the same point, " + place_text(ring[i]),
                        "leave one out: the first corner is not repeated either"};
    }
  }
  return std::nullopt;
}

std::vector<Side> sides_of(const Zone& zone) {
  std::vector<Side> sides;
  const auto add = [&](const Zone::Ring& ring, std::size_t number) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      sides.push_back({ring[i], ring[(i + 1) % ring.size()], number, i, ring.size()});
    }
  };
  add(zone.outer, 0);
  for (std::size_t i = 0; i < zone.holes.size(); ++i) add(zone.holes[i], i + 1);
  return sides;
}

/// A sweep along x.
std::optional<std::pair<Side, Side>> first_meeting(std::vector<Side> sides) {
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.min_x() < b.min_x(); });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& a = sides[i];
    for (std::size_t k = i + 1; k < sides.size() && sides[k].min_x() <= a.max_x(); ++k) {
      const Side& b = sides[k];
      const bool b_after_a = b.follows(a), a_after_b = a.follows(b);
      const bool bad = b_after_a ? folds_back(a, b) : a_after_b ? folds_back(b, a) : meet(a, b);
      if (bad) return std::pair(a, b);
    }
  }
  return std::nullopt;
}

/// For points on no side.
bool encloses(const Zone::Ring& ring, const Point& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (side_of(a, b, p) * (b.y() > a.y() ? 1 : -1) > 0) inside = !inside;
  }
  return inside;
}

/// Where no sides meet, one corner tells where all of a hole lies.
std::optional<LimitFault> fault_of_nesting(const Zone& zone) {
  for (std::size_t i = 0; i < zone.holes.size(); ++i) {
    const Point& corner = zone.holes[i][0];
    if (!encloses(zone.outer, corner)) {
      return LimitFault{ErrorCode::zone_not_simple, "hole " + std::to_string(i) + " lies outside the outline",
                        "leave it out, or make a zone of its own of it"};
    }
    for (std::size_t k = 0; k < zone.holes.size(); ++k) {
      if (k == i || !encloses(zone.holes[k], corner)) continue;
      return LimitFault{ErrorCode::zone_not_simple,
                        "hole " + std::to_string(i) + " lies inside hole " + std::to_string(k),
                        "leave it out, or make a zone of its own of it"};
    }
  }
  return std::nullopt;
}

/// Of a zone that says that it is a box.
std::optional<LimitFault> fault_of_box(const Zone& zone) {
  const LimitFault other{ErrorCode::value_out_of_range, "it says that it is a box, and it is none",
                         "make it of a Box, or leave 'is_box' out"};
  if (zone.outer.size() != 4) return other;
  if (auto fault = fault_of(zone.box())) return fault;
  const bool is_one = zone.outer == Zone(zone.box()).outer && zone.holes.empty() && !zone.above_ground;
  return is_one ? std::nullopt : std::optional(other);
}

}  // namespace

bool is_counter_clockwise(const Zone::Ring& ring) {
  const auto is_before = [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  const std::size_t count = ring.size();
  const auto first = static_cast<std::size_t>(std::min_element(ring.begin(), ring.end(), is_before) - ring.begin());
  return turn(ring[(first + count - 1) % count], ring[first], ring[(first + 1) % count]) > 0;
}

std::optional<LimitFault> fault_of_count(std::size_t zones) {
  if (zones <= Navigation::kMostZones) return std::nullopt;
  return LimitFault{
      ErrorCode::value_out_of_range,
      "there are more than " + std::to_string(Navigation::kMostZones) + " zones, the most that are possible",
      "give the zones near the target alone, join those that touch, or ask for a shorter range"};
}

std::optional<LimitFault> fault_of(const Zone& zone) {
  if (zone.is_box) return fault_of_box(zone);
  if (auto fault = fault_of_heights(zone)) return fault;
  if (auto fault = fault_of_ring(zone.outer, 0)) return fault;
  std::size_t corners = zone.outer.size();
  for (std::size_t i = 0; i < zone.holes.size(); ++i) {
    if (auto fault = fault_of_ring(zone.holes[i], i + 1)) return fault;
    corners += zone.holes[i].size();
  }
  if (corners > Zone::kMostCorners) {
    return LimitFault{ErrorCode::value_out_of_range,
                      "it has " + std::to_string(corners) + " corners, at most " + std::to_string(Zone::kMostCorners) +
                          " are possible",
                      "simplify it, or cut it into several zones"};
  }
  if (const auto meeting = first_meeting(sides_of(zone))) {
    const auto& [a, b] = *meeting;
    const bool a_first = std::pair(a.ring, a.index) < std::pair(b.ring, b.index);
    const Side &first = a_first ? a : b, &second = a_first ? b : a;
    return LimitFault{ErrorCode::zone_not_simple,
                      side_text(first) + ", from " + place_text(first.from) + " to " + place_text(first.to) +
                          ", crosses or touches " + side_text(second) + ", from " + place_text(second.from) + " to " +
                          place_text(second.to),
                      "give the corners in order round the zone; sides may not meet but at their common corners"};
  }
  return fault_of_nesting(zone);
}

}  // namespace vantage::internal::core
