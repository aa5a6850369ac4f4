#include "maps/city/outline_repair.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "maps/city/clipping.h"
#include "maps/city/interruption.h"

namespace vantage::internal::city {
namespace {

/// The area of the space that a ring goes round an odd number of times, by summing up slabs between the heights at
/// which something happens. Cost: O(n^2 + n k) for k crossings. Nothing where that takes seconds.
std::optional<double> even_odd_area(const GridRing& ring) {
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
  std::vector<double> crossed;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    Interruption::tick();
    if (heights[k + 1] <= heights[k]) continue;
    const double middle = (heights[k] + heights[k + 1]) / 2;
    crossed.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if ((points[i].y() > middle) != (points[(i + 1) % count].y() > middle)) crossed.push_back(x_at(i, middle));
    }
    std::sort(crossed.begin(), crossed.end());
    for (std::size_t i = 0; i + 1 < crossed.size(); i += 2) {
      sum += (crossed[i + 1] - crossed[i]) * (heights[k + 1] - heights[k]);
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

/// What Clipper makes of a ring by the even-odd rule. Where many sides meet in a point it loses space now and then, and
/// rarely the same when it sweeps another way: the way with the right area is taken, or else the best.
std::vector<GridPolygon> even_odd(const GridRing& ring) {
  const std::optional<double> area = even_odd_area(ring);
  const double allowed = 2 * perimeter(ring);
  std::vector<GridPolygon> best;
  double least = std::numeric_limits<double>::infinity();
  for (int way = 0; way < 8 && least > allowed; ++way) {
    const GridRing turned_ring = shown(ring, way);
    Clipping clipping;
    clipping.add(turned_ring);
    std::vector<GridPolygon> result = settled(clipping.run(ClipOperation::unite, FillRule::even_odd));
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

/// One ring as the space that it goes round an odd number of times.
std::vector<GridPolygon> untangled(const GridRing& ring, Repairs& repairs) {
  const Meeting meeting = meeting_of({ring});
  if (!meeting.crossing && !meeting.touching) return {GridPolygon{ring, {}}};
  std::vector<GridPolygon> result = even_odd(ring);
  // A ring that touches itself is not a figure of eight: it goes round all of its space in one sense.
  const double whole = std::abs(signed_area(ring));
  repairs.self_crossing |= meeting.crossing || std::abs(area_of(result) - whole) > perimeter(ring);
  return result;
}

}  // namespace

bool is_tangled(const std::vector<GridRing>& rings, bool closed) {
  constexpr std::size_t kMostCrossings = 1000;
  struct Side {
    Vec2 from, to;
    double left = 0, right = 0;
  };
  std::vector<Side> sides;
  for (const GridRing& ring : rings) {
    const auto at = [&](std::size_t i) {
      return Vec2(static_cast<double>(ring[i % ring.size()].x), static_cast<double>(ring[i % ring.size()].y));
    };
    for (std::size_t i = 0; i + (closed ? 0 : 1) < ring.size(); ++i) {
      const Vec2 a = at(i), b = at(i + 1);
      sides.push_back({a, b, std::min(a.x(), b.x()), std::max(a.x(), b.x())});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.left < b.left; });
  const auto parts = [](const Side& side, const Vec2& a, const Vec2& b) {
    const Vec2 along = side.to - side.from, p = a - side.from, q = b - side.from;
    return (along.x() * p.y() - along.y() * p.x()) * (along.x() * q.y() - along.y() * q.x()) < 0;
  };
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Interruption::tick();
    const Side& a = sides[i];
    for (std::size_t j = i + 1; j < sides.size() && sides[j].left <= a.right; ++j) {
      const Side& b = sides[j];
      crossings += parts(a, b.from, b.to) && parts(b, a.from, a.to);
      if (crossings > kMostCrossings) return true;
    }
  }
  return false;
}

std::vector<GridPolygon> repaired(const GridPolygon& rough, Repairs& repairs) {
  const Meeting meeting = meeting_of(rings_of({rough}));
  if (!meeting.crossing && !meeting.touching && is_nested(rough)) return {rough};
  if (is_tangled(rings_of({rough}))) {
    repairs.tangled = true;
    return {};
  }
  std::vector<GridPolygon> result = untangled(rough.outer, repairs);
  if (rough.holes.empty()) return result;
  Clipping clipping;
  clipping.add(result);
  double length = perimeter(rough.outer), area = area_of(result);
  std::vector<GridPolygon> holes;
  for (const GridRing& ring : rough.holes) {
    for (GridPolygon& polygon : untangled(turned(ring, true), repairs)) holes.push_back(std::move(polygon));
    length += perimeter(ring);
  }
  clipping.add_clip(holes);
  area -= area_of(holes);
  result = settled(clipping.run(ClipOperation::subtract, FillRule::non_zero));
  // Where holes lie inside and apart, each takes its own area off the outer ring's.
  repairs.nesting |= std::abs(area - area_of(result)) > length;
  return result;
}

}  // namespace vantage::internal::city
