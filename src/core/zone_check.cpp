#include "core/zone_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <set>
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
  return p.x() >= std::min(side.from.x(), side.to.x()) && p.x() <= std::max(side.from.x(), side.to.x()) &&
         p.y() >= std::min(side.from.y(), side.to.y()) && p.y() <= std::max(side.from.y(), side.to.y());
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

bool is_before(const Point& a, const Point& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); }

/// A sweep along x over sides that do not meet: those at the sweep line are in order, from below. Where some meet, two
/// that are next to each other in that order do so first (Shamos, Hoey, 1976).
class Sweep {
 public:
  explicit Sweep(const Zone& zone) : sides_(sides_of(zone)), around_(1 + zone.holes.size(), kNone) {
    is_counter_clockwise_.push_back(is_counter_clockwise(zone.outer));
    for (const Zone::Ring& hole : zone.holes) is_counter_clockwise_.push_back(is_counter_clockwise(hole));
  }

  /// Two sides that meet, other than neighbours at their common corner.
  std::optional<std::pair<Side, Side>> first_meeting();
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// Where no sides meet: which ring a ring lies in; kNone for none.
  std::size_t around(std::size_t ring) const { return around_[ring]; }

 private:
  struct Below {
    const std::vector<Side>* sides;
    bool operator()(std::size_t a, std::size_t b) const;
  };
  using Order = std::set<std::size_t, Below>;
  struct Event {
    Point at;
    bool begins;
    std::size_t side;
  };

  static bool runs_left(const Side& side) { return is_before(side.to, side.from); }
  static const Point& begin(const Side& side) { return runs_left(side) ? side.to : side.from; }
  static const Point& end(const Side& side) { return runs_left(side) ? side.from : side.to; }
  bool are_bad(std::size_t one, std::size_t other) const;
  std::vector<Event> events() const;
  std::optional<std::size_t> other_corner_at(const std::vector<Event>& events, std::size_t first) const;
  void place_ring(Order::const_iterator first, const Order& order);

  std::vector<Side> sides_;
  std::vector<bool> is_counter_clockwise_;
  std::vector<std::size_t> around_;
};

/// Where both are, the one that begins later begins on one side of the other; or at its begin, and goes there.
bool Sweep::Below::operator()(std::size_t a, std::size_t b) const {
  if (a == b) return false;
  const Side &one = (*sides)[a], &other = (*sides)[b];
  const bool is_later = is_before(begin(other), begin(one));
  const Side &early = is_later ? other : one, &late = is_later ? one : other;
  int left = turn(begin(early), end(early), begin(late));
  if (left == 0) left = turn(begin(early), end(early), end(late));
  if (left == 0) return a < b;
  return (left < 0) == is_later;
}

bool Sweep::are_bad(std::size_t one, std::size_t other) const {
  const Side &a = sides_[one], &b = sides_[other];
  const bool b_after_a = b.follows(a), a_after_b = a.follows(b);
  return b_after_a ? folds_back(a, b) : a_after_b ? folds_back(b, a) : meet(a, b);
}

std::vector<Sweep::Event> Sweep::events() const {
  std::vector<Event> events;
  events.reserve(2 * sides_.size());
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    events.push_back({begin(sides_[i]), true, i});
    events.push_back({end(sides_[i]), false, i});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    if (a.at != b.at) return is_before(a.at, b.at);
    return std::pair(a.begins, a.side) < std::pair(b.begins, b.side);
  });
  return events;
}

/// A corner of another place in the rings where that of `first` is: only two sides may be there.
std::optional<std::size_t> Sweep::other_corner_at(const std::vector<Event>& events, std::size_t first) const {
  const Event& event = events[first];
  for (std::size_t i = first + 1; i < events.size() && events[i].at == event.at; ++i) {
    const Side &a = sides_[event.side], &b = sides_[events[i].side];
    if (!a.follows(b) && !b.follows(a)) return events[i].side;
  }
  return std::nullopt;
}

/// At its first corner a ring lies in what is above the side below.
void Sweep::place_ring(Order::const_iterator first, const Order& order) {
  const std::size_t ring = sides_[*first].ring;
  while (first != order.begin()) {
    const Side& below = sides_[*--first];
    if (below.ring == ring) continue;
    const bool is_inside = runs_left(below) != is_counter_clockwise_[below.ring];
    around_[ring] = is_inside ? below.ring : around_[below.ring];
    return;
  }
}

std::optional<std::pair<Side, Side>> Sweep::first_meeting() {
  const std::vector<Event> all = events();
  Order order(Below{&sides_});
  std::vector<Order::iterator> places(sides_.size(), order.end());
  std::vector<bool> is_placed(around_.size(), false);
  const auto pair = [&](std::size_t a, std::size_t b) { return std::pair(sides_[a], sides_[b]); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t side = all[i].side;
    if (const auto other = other_corner_at(all, i)) return pair(side, *other);
    if (all[i].begins) {
      const auto place = places[side] = order.insert(side).first;
      const auto next = std::next(place);
      if (next != order.end() && are_bad(side, *next)) return pair(side, *next);
      if (place != order.begin() && are_bad(side, *std::prev(place))) return pair(side, *std::prev(place));
      if (!is_placed[sides_[side].ring]) place_ring(place, order);
      is_placed[sides_[side].ring] = true;
    } else {
      const auto next = order.erase(places[side]);
      if (next != order.begin() && next != order.end() && are_bad(*next, *std::prev(next))) {
        return pair(*next, *std::prev(next));
      }
    }
  }
  return std::nullopt;
}

std::optional<LimitFault> fault_of_nesting(const Zone& zone, const Sweep& sweep) {
  for (std::size_t i = 0; i < zone.holes.size(); ++i) {
    const std::size_t around = sweep.around(i + 1);
    if (around == 0) continue;
    return LimitFault{
        ErrorCode::zone_not_simple,
        "hole " + std::to_string(i) + " lies " +
            (around == Sweep::kNone ? "outside the outline" : "inside hole " + std::to_string(around - 1)),
        "leave it out, or make a zone of its own of it"};
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
  Sweep sweep(zone);
  if (const auto meeting = sweep.first_meeting()) {
    const auto& [a, b] = *meeting;
    const bool a_first = std::pair(a.ring, a.index) < std::pair(b.ring, b.index);
    const Side &first = a_first ? a : b, &second = a_first ? b : a;
    return LimitFault{ErrorCode::zone_not_simple,
                      side_text(first) + ", from " + place_text(first.from) + " to " + place_text(first.to) +
                          ", crosses or touches " + side_text(second) + ", from " + place_text(second.from) + " to " +
                          place_text(second.to),
                      "give the corners in order round the zone; sides may not meet but at their common corners"};
  }
  return fault_of_nesting(zone, sweep);
}

}  // namespace vantage::internal::core
