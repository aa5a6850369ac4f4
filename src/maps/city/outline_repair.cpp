#include "maps/city/outline_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "maps/city/clipping.h"
#include "maps/city/interruption.h"

namespace vantage::internal::city {
namespace {

constexpr std::size_t kMostCrossings = 1000;
/// How far a corner is off a side that it was drawn on, at most: positions in maps are good to 1 cm.
constexpr double kOnSide = 0.02 / kGrid;

double length(const GridPoint& a, const GridPoint& b) {
  return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
}

/// Not where it is an end of it: who draws a corner twice does not swap two.
bool is_on_side(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  if (p == a || p == b) return false;
  if (dot(a, p, b) <= 0) return length(a, p) <= kOnSide;
  if (dot(b, p, a) <= 0) return length(b, p) <= kOnSide;
  return static_cast<double>(std::abs(turn(a, b, p))) <= kOnSide * length(a, b);
}

/// Whether the ring runs from `a` to `b` and then back along the same line, but not to where it came from.
bool is_spike(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  constexpr double kLeastSide = 10 * kOnSide;
  if (dot(b, a, c) <= 0 || length(a, c) <= kOnSide || std::min(length(a, b), length(b, c)) < kLeastSide) return false;
  return is_on_side(a, b, c) || is_on_side(c, a, b);
}

/// What sides must do to count as crossing: pass through each other; or touch, other than in the corner between them.
enum class Crossing { through, touching };

/// The sides that cross, by where they begin, counted over all rings; one more than kMostCrossings at most.
std::vector<std::array<std::size_t, 2>> crossings_of(const std::vector<GridRing>& rings, bool closed,
                                                     Crossing crossing) {
  struct Side {
    GridPoint from, to;
    std::int64_t low = 0, high = 0;  // along the axis on which sides are the shorter
    std::size_t begin = 0, end = 0;
  };
  std::vector<Side> sides;
  std::size_t corners = 0;
  double x = 0, y = 0;
  for (const GridRing& ring : rings) {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < ring.size(); ++i) {
      const GridPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      sides.push_back({a, b, 0, 0, corners + i, corners + (i + 1) % ring.size()});
      x += static_cast<double>(std::abs(a.x - b.x));
      y += static_cast<double>(std::abs(a.y - b.y));
    }
    corners += ring.size();
  }
  for (Side& side : sides) {
    std::tie(side.low, side.high) =
        x <= y ? std::minmax({side.from.x, side.to.x}) : std::minmax({side.from.y, side.to.y});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.low < b.low; });
  const auto parts = [](const Side& side, const GridPoint& a, const GridPoint& b) {
    const std::int64_t p = turn(side.from, side.to, a), q = turn(side.from, side.to, b);
    return (p < 0 && q > 0) || (p > 0 && q < 0);
  };
  const auto touch = [](const Side& a, const Side& b) {
    if (a.end == b.begin) return is_spike(a.from, a.to, b.to);
    if (b.end == a.begin) return is_spike(b.from, b.to, a.to);
    return is_on_side(a.from, b.from, b.to) || is_on_side(a.to, b.from, b.to) || is_on_side(b.from, a.from, a.to) ||
           is_on_side(b.to, a.from, a.to);
  };
  const auto near = static_cast<std::int64_t>(crossing == Crossing::touching ? kOnSide : 0);
  std::vector<std::array<std::size_t, 2>> found;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Interruption::tick();
    const Side& a = sides[i];
    for (std::size_t j = i + 1; j < sides.size() && sides[j].low <= a.high + near; ++j) {
      const Side& b = sides[j];
      const bool through = parts(a, b.from, b.to) && parts(b, a.from, a.to);
      if (!through && (crossing == Crossing::through || !touch(a, b))) continue;
      found.push_back({a.begin, b.begin});
      if (found.size() > kMostCrossings) return found;
    }
  }
  return found;
}

/// The area of the space that a ring goes round, by summing up slabs between the heights at which something happens.
/// Cost: O(n^2 + n k) for k crossings. Nothing where that takes seconds.
std::optional<double> wound_area(const GridRing& ring) {
  std::vector<Vec2> points;
  for (const GridPoint& p : ring) points.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
  const std::size_t count = points.size();
  constexpr std::size_t kMostSteps = 100'000'000;
  if (count * count > kMostSteps) return std::nullopt;
  const auto x_at = [&](std::size_t i, double y) {
    const Vec2 &a = points[i], &b = points[(i + 1) % count];
    return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  };
  std::vector<double> heights;
  for (std::size_t i = 0; i < count; ++i) {
    Interruption::tick();
    heights.push_back(points[i].y());
    const Vec2 a = points[i], along = points[(i + 1) % count] - a;
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2 b = points[j], other = points[(j + 1) % count] - b;
      const double area = along.x() * other.y() - along.y() * other.x();
      const double t = ((b - a).x() * other.y() - (b - a).y() * other.x()) / area;
      const double u = ((b - a).x() * along.y() - (b - a).y() * along.x()) / area;
      if (t > 0 && t < 1 && u > 0 && u < 1) heights.push_back(a.y() + t * along.y());
    }
  }
  if (heights.size() * count > kMostSteps) return std::nullopt;
  std::sort(heights.begin(), heights.end());
  double sum = 0;
  std::vector<std::pair<double, int>> crossed;  // x, and whether the ring goes up or down there
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    Interruption::tick();
    if (heights[k + 1] <= heights[k]) continue;
    const double middle = (heights[k] + heights[k + 1]) / 2;
    crossed.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const bool from_above = points[i].y() > middle, to_above = points[(i + 1) % count].y() > middle;
      if (from_above != to_above) crossed.emplace_back(x_at(i, middle), to_above ? 1 : -1);
    }
    std::sort(crossed.begin(), crossed.end());
    int winding = 0;
    for (std::size_t i = 0; i + 1 < crossed.size(); ++i) {
      winding += crossed[i].second;
      if (winding != 0) sum += (crossed[i + 1].first - crossed[i].first) * (heights[k + 1] - heights[k]);
    }
  }
  return sum;
}

/// The axes swapped or mirrored: one of eight ways, each its own inverse but for the last two, which are each other's.
GridRing shown(const GridRing& ring, int way) {
  GridRing result;
  for (const GridPoint& p : ring) {
    const GridPoint q{(way & 1) != 0 ? -p.x : p.x, (way & 2) != 0 ? -p.y : p.y};
    result.push_back((way & 4) != 0 ? GridPoint{q.y, q.x} : q);
  }
  return result;
}
int way_back(int way) { return way == 5 ? 6 : way == 6 ? 5 : way; }

/// What Clipper makes of a ring by the non-zero rule. Where many sides meet in a point it loses space now and then, and
/// rarely the same when it sweeps another way: the way with the right area is taken, or else the best.
std::vector<GridPolygon> wound(const GridRing& ring) {
  const std::optional<double> area = wound_area(ring);
  const double allowed = 2 * perimeter(ring);
  std::vector<GridPolygon> best;
  double least = std::numeric_limits<double>::infinity();
  for (int way = 0; way < 8 && least > allowed; ++way) {
    const GridRing turned_ring = shown(ring, way);
    Clipping clipping;
    clipping.add(turned_ring);
    std::vector<GridPolygon> result = settled(clipping.run(ClipOperation::unite, FillRule::non_zero));
    const double off = area ? std::abs(area_of(result) - *area) : 0;
    if (off >= least) continue;
    least = off;
    best.clear();
    for (const GridPolygon& polygon : result) {
      best.push_back({turned(shown(polygon.outer, way_back(way)), true), {}});
      for (const GridRing& hole : polygon.holes) {
        best.back().holes.push_back(turned(shown(hole, way_back(way)), false));
      }
    }
  }
  return best;
}

/// One ring as the space that it goes round, with that near its crossings which it may have been meant to go round.
std::vector<GridPolygon> untangled(const GridRing& ring, Repairs& repairs) {
  const Meeting meeting = meeting_of({ring});
  if (!meeting.crossing && !meeting.touching) return {GridPolygon{ring, {}}};
  std::vector<GridPolygon> result = wound(ring);
  // A ring that touches itself is not a figure of eight: it goes round all of its space once, in one sense.
  const double off = std::abs(area_of(result) - std::abs(signed_area(ring)));
  if (!meeting.crossing && off <= perimeter(ring)) return result;
  repairs.self_crossing = true;
  const std::vector<GridPolygon> hulls = crossing_hulls(ring);
  Clipping clipping;
  clipping.add(result);
  clipping.add(hulls);
  return settled(clipping.run(ClipOperation::unite, FillRule::non_zero));
}

bool is_empty(ClipOperation operation, const GridRing& a, const GridRing& b) {
  const std::vector<GridPolygon> subject = {{turned(a, true), {}}}, clip = {{turned(b, true), {}}};
  Clipping clipping;
  clipping.add(subject);
  clipping.add_clip(clip);
  return clipping.run(operation, FillRule::non_zero).empty();
}

/// The holes that are what they claim to be: simple, inside of the outer ring, apart from all others, and sharing no
/// more of their borders with these than points. The others may be slips of the pen, and what they would open may hide.
std::vector<GridPolygon> sound_holes(const GridPolygon& rough) {
  const std::vector<GridRing> rings = rings_of({rough});  // the outer one first
  std::vector<GridBox> boxes;
  for (const GridRing& ring : rings) boxes.push_back(box_of(ring));
  std::vector<bool> sound(rings.size(), true);
  bool outer_crosses = false;
  std::set<std::pair<std::size_t, std::size_t>> touching;
  for_each_meeting(rings, [&](std::size_t a, std::size_t b, bool crossing) {
    if (a == 0 && b == 0) {
      outer_crosses |= crossing;
    } else if (crossing || a == b) {  // a hole that touches itself may go round an island
      if (a != 0) sound[a] = false;
      if (b != 0) sound[b] = false;
    } else {
      touching.emplace(std::min(a, b), std::max(a, b));
    }
  });
  if (outer_crosses) return {};
  const auto is_within = [&](std::size_t i) {
    if (!touching.contains({0, i})) return locate(rings[i][0], rings[0]) == PointLocation::inside;
    return is_empty(ClipOperation::subtract, rings[i], near_box(rings[0], boxes[i]));
  };
  const auto are_apart = [&](std::size_t i, std::size_t j) {
    if (!boxes[i].intersects(boxes[j])) return true;
    if (touching.contains({std::min(i, j), std::max(i, j)})) {
      return is_empty(ClipOperation::intersect, rings[i], rings[j]);
    }
    return locate(rings[i][0], rings[j]) == PointLocation::outside &&
           locate(rings[j][0], rings[i]) == PointLocation::outside;
  };
  std::vector<GridPolygon> holes;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    Interruption::tick();
    if (!sound[i] || !is_within(i)) continue;
    bool apart = true;
    for (std::size_t j = 1; j < rings.size() && apart; ++j) apart = j == i || are_apart(i, j);
    if (apart) holes.push_back({turned(rings[i], true), {}});
  }
  return holes;
}

}  // namespace

bool is_tangled(const std::vector<GridRing>& rings, bool closed) {
  return crossings_of(rings, closed, Crossing::through).size() > kMostCrossings;
}

bool has_spike(const GridRing& ring) {
  const std::size_t count = ring.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (is_spike(ring[i], ring[(i + 1) % count], ring[(i + 2) % count])) return true;
  }
  return false;
}

std::vector<GridPolygon> crossing_hulls(const GridRing& ring) {
  std::vector<GridPolygon> hulls;
  const std::size_t count = ring.size();
  for (const auto& crossing : crossings_of({ring}, true, Crossing::touching)) {
    GridRing corners;
    for (const std::size_t begin : crossing) {
      for (std::size_t k = 0; k < 4; ++k) corners.push_back(ring[(begin + count - 1 + k) % count]);
    }
    GridRing hull = hull_of(std::move(corners));
    if (hull.size() > 2) hulls.push_back({std::move(hull), {}});
  }
  return hulls;
}

std::vector<GridPolygon> repaired(const GridPolygon& rough, Repairs& repairs) {
  const Meeting meeting = meeting_of(rings_of({rough}));
  if (!meeting.crossing && !meeting.touching && is_nested(rough)) return {rough};
  if (is_tangled({rough.outer})) {
    repairs.tangled = true;
    return {};
  }
  std::vector<GridPolygon> result = untangled(rough.outer, repairs);
  const std::vector<GridPolygon> holes = sound_holes(rough);
  repairs.nesting |= holes.size() < rough.holes.size();
  if (holes.empty()) return result;
  Clipping clipping;
  clipping.add(result);
  clipping.add_clip(holes);
  return settled(clipping.run(ClipOperation::subtract, FillRule::non_zero));
}

}  // namespace vantage::internal::city
