// Sutherland and Hodgman, Reentrant polygon clipping (1974): a ring is cut to one side of the rectangle after the
// other. What leaves the rectangle runs along its border then, to where it comes back: inside, each point is wound
// round as often as before.
#include "solid/zone_rings.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vantage::internal::solid {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area, about the first corner: far from the origin it would drown in rounding.
double turning(const Zone::Ring& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Point a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// The point of a side with this coordinate; the same for both directions of the side.
Point crossing(const Point& a, const Point& b, int axis, double at) {
  const bool forward = a[axis] < b[axis];
  const Point &low = forward ? a : b, &high = forward ? b : a;
  Point p = low + (high - low) * ((at - low[axis]) / (high[axis] - low[axis]));
  p[axis] = at;
  return p;
}

/// Keeps what has the coordinate `axis` up to `at`, or, with `sign` -1, from there on.
Zone::Ring cut_off(const Zone::Ring& ring, int axis, double at, double sign) {
  const auto is_kept = [&](const Point& p) { return sign * (p[axis] - at) <= 0; };
  Zone::Ring result;
  const auto add = [&](const Point& p) {
    if (result.empty() || result.back() != p) result.push_back(p);
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &from = ring[i], &to = ring[(i + 1) % ring.size()];
    if (is_kept(from)) add(from);
    if (is_kept(from) != is_kept(to)) add(crossing(from, to, axis, at));
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  return result;
}

}  // namespace

ZoneRings rings_within(const Zone& zone, const Box& bounds, const Vec3& origin) {
  ZoneRings rings;
  const Box local{bounds.min - origin, bounds.max - origin};
  const auto add = [&](Zone::Ring ring, bool counter_clockwise) {
    if ((turning(ring) > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
    for (Point& p : ring) p -= origin.head<2>();
    for (int axis = 0; axis < 2; ++axis) {
      ring = cut_off(ring, axis, local.max[axis], 1);
      ring = cut_off(ring, axis, local.min[axis], -1);
    }
    const bool has_area = ring.size() >= 3 && turning(ring) != 0;
    if (has_area) rings.push_back(std::move(ring));
    return has_area;
  };
  if (!add(zone.outer, true)) return {};
  for (const Zone::Ring& hole : zone.holes) add(hole, false);
  return rings;
}

}  // namespace vantage::internal::solid
