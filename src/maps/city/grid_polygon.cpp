#include "maps/city/grid_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "maps/city/interruption.h"

namespace vantage::internal::city {
namespace {

constexpr double kUnitsPerMetre = 1 / kGrid;
constexpr double kLeastWidth = 0.01 * kUnitsPerMetre;                  // of a piece: 1 cm
constexpr double kLeastArea = 0.01 * kUnitsPerMetre * kUnitsPerMetre;  // of a piece: 0.01 m2

/// Whether `b` says nothing between `a` and `c`: it repeats one of them, lies on the straight line between them, or is
/// the tip of a spike.
bool is_idle(const GridPoint& a, const GridPoint& b, const GridPoint& c, Straight straight, Spikes spikes) {
  if (a == b || b == c || a == c) return true;
  if (spikes == Spikes::kept && dot(b, a, c) > 0) return false;
  const std::int64_t twice = turn(b, a, c);
  if (straight == Straight::exact || twice == 0) return twice == 0;
  const auto area = static_cast<double>(std::abs(twice));
  const double ab = std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
  const double bc = std::hypot(static_cast<double>(c.x - b.x), static_cast<double>(c.y - b.y));
  const double ac = std::hypot(static_cast<double>(a.x - c.x), static_cast<double>(a.y - c.y));
  return dot(b, a, c) > 0 ? area < std::max(ab, bc) : area < ac;
}

bool is_sliver(double area, double perimeter) { return area < kLeastArea || 2 * area < kLeastWidth * perimeter; }

/// Whether `inner`, which does not cross `outer`, lies inside it.
bool is_inside(const GridRing& inner, const GridRing& outer) {
  GridRing doubled = outer;
  for (GridPoint& p : doubled) p = {2 * p.x, 2 * p.y};
  for (std::size_t i = 0; i < inner.size(); ++i) {  // the first corner or middle of a side that is not on `outer`
    const GridPoint &a = inner[i], &b = inner[(i + 1) % inner.size()];
    for (const GridPoint& p : {GridPoint{2 * a.x, 2 * a.y}, GridPoint{a.x + b.x, a.y + b.y}}) {
      const PointLocation location = locate(p, doubled);
      if (location != PointLocation::boundary) return location == PointLocation::inside;
    }
  }
  return false;
}

}  // namespace

double perimeter(const GridRing& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
    sum += std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
  }
  return sum;
}

GridRing turned(GridRing ring, bool counter_clockwise) {
  if ((signed_area(ring) > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

double area_of(const GridPolygon& polygon) {
  double sum = std::abs(signed_area(polygon.outer));
  for (const GridRing& hole : polygon.holes) sum -= std::abs(signed_area(hole));
  return sum;
}

double area_of(const std::vector<GridPolygon>& polygons) {
  double sum = 0;
  for (const GridPolygon& polygon : polygons) sum += area_of(polygon);
  return sum;
}

std::vector<GridRing> rings_of(const std::vector<GridPolygon>& polygons) {
  std::vector<GridRing> rings;
  for (const GridPolygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

GridRing tidied(const GridRing& ring, Straight straight, Spikes spikes) {
  GridRing result = ring;
  for (bool changed = true; changed && result.size() >= 3;) {
    changed = false;
    GridRing kept;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const GridPoint& before = kept.empty() ? result.back() : kept.back();
      const GridPoint& after = i + 1 < result.size() ? result[i + 1] : (kept.empty() ? result[0] : kept[0]);
      if (is_idle(before, result[i], after, straight, spikes)) {
        changed = true;
      } else {
        kept.push_back(result[i]);
      }
    }
    result = std::move(kept);
  }
  return result.size() >= 3 ? result : GridRing{};
}

std::vector<GridPolygon> tidied(const std::vector<GridPolygon>& polygons) {
  std::vector<GridPolygon> result;
  for (const GridPolygon& polygon : polygons) {
    GridPolygon smooth{tidied(polygon.outer), {}};
    if (smooth.outer.empty()) continue;
    for (const GridRing& hole : polygon.holes) {
      GridRing ring = tidied(hole);
      if (!ring.empty()) smooth.holes.push_back(std::move(ring));
    }
    result.push_back(std::move(smooth));
  }
  return meeting_of(rings_of(result)).crossing ? polygons : result;
}

// Clipper's own tree is wrong now and then where rings touch.
std::vector<GridPolygon> nested(const std::vector<GridRing>& rings) {
  std::vector<GridPolygon> result;
  if (rings.size() == 1) return {{turned(rings[0], true), {}}};
  std::vector<GridBox> boxes;
  for (const GridRing& ring : rings) boxes.push_back(box_of(ring));
  std::vector<std::vector<std::size_t>> around(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    Interruption::tick();
    for (std::size_t j = 0; j < rings.size(); ++j) {
      if (i != j && boxes[j].contains(boxes[i]) && is_inside(rings[i], rings[j])) around[i].push_back(j);
    }
  }
  std::vector<std::size_t> polygon_of(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (around[i].size() % 2 == 1) continue;
    polygon_of[i] = result.size();
    result.push_back({turned(rings[i], true), {}});
  }
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (around[i].size() % 2 == 0) continue;
    for (const std::size_t j : around[i]) {  // the innermost one round it
      if (around[j].size() + 1 == around[i].size()) result[polygon_of[j]].holes.push_back(turned(rings[i], false));
    }
  }
  return result;
}

bool is_nested(const GridPolygon& polygon) {
  for (const GridRing& hole : polygon.holes) {
    Interruption::tick();
    if (!is_inside(hole, polygon.outer)) return false;
    for (const GridRing& other : polygon.holes) {
      if (&other != &hole && is_inside(hole, other)) return false;
    }
  }
  return true;
}

std::size_t drop_slivers(std::vector<GridPolygon>& polygons) {
  const auto sliver = [](const GridRing& ring) { return is_sliver(std::abs(signed_area(ring)), perimeter(ring)); };
  std::size_t dropped = 0;
  for (GridPolygon& polygon : polygons) dropped += std::erase_if(polygon.holes, sliver);
  return dropped + std::erase_if(polygons, [](const GridPolygon& polygon) {
           double length = perimeter(polygon.outer);
           for (const GridRing& hole : polygon.holes) length += perimeter(hole);
           return is_sliver(area_of(polygon), length);
         });
}

std::vector<Footprint> to_footprints(const std::vector<GridPolygon>& polygons, const Grid& grid) {
  std::vector<Footprint> result;
  for (const GridPolygon& polygon : polygons) {
    Footprint footprint{grid.to_metres(turned(polygon.outer, true)), {}};
    for (const GridRing& hole : polygon.holes) footprint.holes.push_back(grid.to_metres(turned(hole, false)));
    result.push_back(std::move(footprint));
  }
  return result;
}

GridPolygon to_polygon(const Footprint& footprint, const Grid& grid) {
  GridPolygon polygon{grid.to_grid(footprint.outer), {}};
  for (const Ring& hole : footprint.holes) polygon.holes.push_back(grid.to_grid(hole));
  return polygon;
}

}  // namespace vantage::internal::city
