// Sutherland and Hodgman, Reentrant polygon clipping (1974): a ring is cut to one side of the rectangle after the
// other. What leaves the rectangle runs along its border then, to where it comes back: inside, each point is wound
// round as often as before.
#include "solid/zone_rings.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "core/twofold.h"
#include "core/zone_check.h"

namespace vantage::internal::solid {
namespace {

using Point = Eigen::Vector2d;

// Corners may be a million times as far away as the volume is large: with doubles alone a side between them would move
// by what they are rounded by.
using core::Twofold;
using TwofoldPoint = std::array<Twofold, 2>;

bool operator<=(const Twofold& a, double b) { return (a - Twofold{b}).high <= 0; }
bool operator>=(const Twofold& a, double b) { return (a - Twofold{b}).high >= 0; }

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
TwofoldPoint crossing(const TwofoldPoint& a, const TwofoldPoint& b, std::size_t axis, double at) {
  const bool is_forward = a[axis] <= at;
  const TwofoldPoint &low = is_forward ? a : b, &high = is_forward ? b : a;
  const std::size_t other = 1 - axis;
  const Twofold share = (Twofold{at} - low[axis]) / (high[axis] - low[axis]);
  TwofoldPoint p;
  p[axis] = {at};
  p[other] = low[other] + (high[other] - low[other]) * share;
  return p;
}

/// Keeps what has the coordinate `axis` up to `at`, or, with `sign` -1, from there on.
std::vector<TwofoldPoint> cut_off(const std::vector<TwofoldPoint>& ring, std::size_t axis, double at, int sign) {
  const auto is_kept = [&](const TwofoldPoint& p) { return sign > 0 ? p[axis] <= at : p[axis] >= at; };
  std::vector<TwofoldPoint> result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const TwofoldPoint &from = ring[i], &to = ring[(i + 1) % ring.size()];
    if (is_kept(from)) result.push_back(from);
    if (is_kept(from) != is_kept(to)) result.push_back(crossing(from, to, axis, at));
  }
  return result;
}

/// Within the rectangle, about `origin`.
Zone::Ring cut_to(const Zone::Ring& ring, const Box& bounds, const Vec3& origin) {
  std::vector<TwofoldPoint> points;
  for (const Point& p : ring) points.push_back({Twofold{p.x()}, Twofold{p.y()}});
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto along = static_cast<Eigen::Index>(axis);
    points = cut_off(points, axis, bounds.max[along], 1);
    points = cut_off(points, axis, bounds.min[along], -1);
  }
  Zone::Ring result;
  for (const TwofoldPoint& p : points) {
    const Point local((p[0] - Twofold{origin.x()}).high, (p[1] - Twofold{origin.y()}).high);
    if (result.empty() || result.back() != local) result.push_back(local);
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  return result;
}

}  // namespace

ZoneRings rings_within(const Zone& zone, const Box& bounds, const Vec3& origin) {
  ZoneRings rings;
  const auto add = [&](Zone::Ring ring, bool counter_clockwise) {
    if (core::is_counter_clockwise(ring) != counter_clockwise) std::reverse(ring.begin(), ring.end());
    ring = cut_to(ring, bounds, origin);
    const bool has_area = ring.size() >= 3 && turning(ring) != 0;
    if (has_area) rings.push_back(std::move(ring));
    return has_area;
  };
  if (!add(zone.outer, true)) return {};
  for (const Zone::Ring& hole : zone.holes) add(hole, false);
  return rings;
}

}  // namespace vantage::internal::solid
