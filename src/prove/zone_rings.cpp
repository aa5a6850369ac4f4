#include "prove/zone_rings.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "prove/orientation.h"
#include "vantage/error.h"

namespace vantage::internal::prove {
namespace {

using Point = Eigen::Vector2d;

struct Side {
  Point from, to;
  std::size_t ring = 0, index = 0, count = 0;

  double low() const { return std::min(from.x(), to.x()); }
  double high() const { return std::max(from.x(), to.x()); }
  bool is_next_of(const Side& other) const { return ring == other.ring && index == (other.index + 1) % other.count; }
};

bool is_in_box_of(const Side& side, const Point& p) {
  return p.x() >= side.low() && p.x() <= side.high() && p.y() >= std::min(side.from.y(), side.to.y()) &&
         p.y() <= std::max(side.from.y(), side.to.y());
}

bool is_on(const Side& side, const Point& p) { return is_in_box_of(side, p) && turn(side.from, side.to, p) == 0; }

bool meet(const Side& a, const Side& b) {
  if (is_on(a, b.from) || is_on(a, b.to) || is_on(b, a.from) || is_on(b, a.to)) return true;
  return turn(a.from, a.to, b.from) * turn(a.from, a.to, b.to) < 0 &&
         turn(b.from, b.to, a.from) * turn(b.from, b.to, a.to) < 0;
}

/// Neighbours share a corner: they must not lie on each other.
bool fold(const Side& first, const Side& second) { return is_on(first, second.to) || is_on(second, first.from); }

/// For a point on no side: a ray towards x crosses the ring an odd number of times.
bool is_inside(const Zone::Ring& ring, const Point& p) {
  bool is_odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if ((turn(a, b, p) > 0) == (b.y() > a.y())) is_odd = !is_odd;
  }
  return is_odd;
}

[[noreturn]] void fail(const char* problem, const std::string& where) {
  throw Error(ErrorCode::zone_not_simple, problem, where, "give each ring's corners in order, without crossings");
}

void add_sides(const Zone::Ring& ring, std::size_t number, const std::string& where, std::vector<Side>& sides) {
  if (ring.size() < 3) fail("a ring of the zone has fewer than 3 corners", where);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!ring[i].allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a corner of the zone is not finite", where, "give finite corners");
    }
    sides.push_back({ring[i], ring[(i + 1) % ring.size()], number, i, ring.size()});
  }
}

}  // namespace

void check_rings(const Zone& zone, const std::string& where) {
  std::vector<Side> sides;
  add_sides(zone.outer, 0, where, sides);
  for (std::size_t i = 0; i < zone.holes.size(); ++i) add_sides(zone.holes[i], i + 1, where, sides);
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.low() < b.low(); });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i].from == sides[i].to) fail("a corner of the zone is repeated", where);
    for (std::size_t j = i + 1; j < sides.size() && sides[j].low() <= sides[i].high(); ++j) {
      const Side &a = sides[i], &b = sides[j];
      const bool is_bad = a.is_next_of(b) ? fold(b, a) : b.is_next_of(a) ? fold(a, b) : meet(a, b);
      if (is_bad) fail("sides of the zone cross or touch each other", where);
    }
  }
  for (std::size_t i = 0; i < zone.holes.size(); ++i) {
    const Point& corner = zone.holes[i].front();
    bool is_good = is_inside(zone.outer, corner);
    for (std::size_t j = 0; j < zone.holes.size(); ++j) {
      is_good = is_good && (i == j || !is_inside(zone.holes[j], corner));
    }
    if (!is_good) fail("a hole of the zone is not inside of it, or in another hole", where);
  }
}

}  // namespace vantage::internal::prove
