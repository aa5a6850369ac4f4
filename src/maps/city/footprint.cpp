#include "maps/city/footprint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "maps/city/clipping.h"
#include "maps/city/grid_polygon.h"
#include "maps/city/outline_repair.h"

namespace vantage::internal::city {
namespace {

/// All that may matter of some footprints, about an origin in their midst.
struct Operands {
  Grid grid;
  std::vector<GridPolygon> subject, other;
};

Operands operands(const std::vector<Footprint>& subject, const std::vector<Footprint>& other) {
  std::vector<const Ring*> rings;
  for (const Footprint& footprint : subject) rings.push_back(&footprint.outer);
  Operands result{Grid(rings), {}, {}};
  Eigen::AlignedBox2d box;
  for (const Ring* ring : rings) {
    for (const Vec2& point : *ring) box.extend(point);
  }
  for (const Footprint& footprint : subject) result.subject.push_back(to_polygon(footprint, result.grid));
  for (const Footprint& footprint : other) {
    Eigen::AlignedBox2d own;
    for (const Vec2& point : footprint.outer) own.extend(point);
    if (box.intersects(own)) result.other.push_back(to_polygon(footprint, result.grid));
  }
  return result;
}

/// What of polygons may matter where others are. Not tidy elsewhere.
std::vector<GridPolygon> near_others(const std::vector<GridPolygon>& polygons, const std::vector<GridPolygon>& others) {
  GridBox box;
  for (const GridPolygon& other : others) box.extend(box_of(other.outer));
  std::vector<GridPolygon> result;
  for (const GridPolygon& polygon : polygons) {
    result.push_back({near_box(polygon.outer, box), {}});
    for (const GridRing& hole : polygon.holes) {
      if (box.intersects(box_of(hole))) result.back().holes.push_back(near_box(hole, box));
    }
  }
  return result;
}

std::vector<Footprint> clipped(Operands operands, ClipOperation operation, std::size_t* slivers = nullptr) {
  operands.other = near_others(operands.other, operands.subject);
  if (operation == ClipOperation::intersect) operands.subject = near_others(operands.subject, operands.other);
  Clipping clipping;
  clipping.add(operands.subject);
  clipping.add_clip(operands.other);
  std::vector<GridPolygon> result = settled(clipping.run(operation, FillRule::non_zero));
  const std::size_t before = result.size();
  drop_slivers(result);
  if (slivers != nullptr) *slivers += before - result.size();
  return to_footprints(result, operands.grid);
}

/// Without repeated points, and without lines that run there and back.
GridRing without_spurs(const GridRing& ring) {
  GridRing kept;
  for (const GridPoint& p : ring) {
    if (!kept.empty() && kept.back() == p) continue;
    if (kept.size() > 1 && kept[kept.size() - 2] == p) {
      kept.pop_back();
    } else {
      kept.push_back(p);
    }
  }
  while (kept.size() > 2) {  // where its end meets its beginning
    if (kept[1] == kept.back()) {
      kept.erase(kept.begin());
    } else if (kept.front() == kept.back() || kept.front() == kept[kept.size() - 2]) {
      kept.pop_back();
    } else {
      break;
    }
  }
  return kept;
}

double signed_area_m2(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Vec2 a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

}  // namespace

double area_m2(const Footprint& footprint) {
  double sum = std::abs(signed_area_m2(footprint.outer));
  for (const Ring& hole : footprint.holes) sum -= std::abs(signed_area_m2(hole));
  return sum;
}

double area_m2(const std::vector<Footprint>& footprints) {
  double sum = 0;
  for (const Footprint& footprint : footprints) sum += area_m2(footprint);
  return sum;
}

std::vector<Footprint> clean(const std::vector<Footprint>& rough, Repairs& repairs) {
  std::vector<const Ring*> outers;
  for (const Footprint& footprint : rough) outers.push_back(&footprint.outer);
  const Grid grid(outers);
  std::vector<GridPolygon> pieces;
  std::size_t parts = 0;
  for (const Footprint& footprint : rough) {
    const auto held = [&](const Ring& ring) { return grid.holds(ring); };
    if (!held(footprint.outer) || !std::all_of(footprint.holes.begin(), footprint.holes.end(), held)) {
      repairs.beyond = true;
      continue;
    }
    const GridRing drawn = tidied(without_spurs(grid.to_grid(footprint.outer)), Straight::within_a_unit, Spikes::kept);
    GridPolygon polygon{turned(tidied(drawn), true), {}};
    for (const Ring& hole : footprint.holes) {
      GridRing ring = turned(tidied(grid.to_grid(hole)), false);
      if (!ring.empty()) polygon.holes.push_back(std::move(ring));
    }
    if (polygon.outer.empty()) {
      ++repairs.slivers;
      continue;
    }
    ++parts;
    std::vector<GridPolygon> simple = repaired(polygon, repairs);
    pieces.insert(pieces.end(), simple.begin(), simple.end());
    if (!has_spike(drawn)) continue;
    const std::vector<GridPolygon> hulls = crossing_hulls(drawn);
    pieces.insert(pieces.end(), hulls.begin(), hulls.end());
    repairs.self_crossing = true;
    ++parts;
  }
  if (parts > 1) {  // they may touch or overlap
    Clipping clipping;
    clipping.add(pieces);
    pieces = settled(clipping.run(ClipOperation::unite, FillRule::non_zero));
  }
  repairs.slivers += drop_slivers(pieces);
  return to_footprints(pieces, grid);
}

std::vector<Footprint> subtract(const std::vector<Footprint>& from, const std::vector<Footprint>& what) {
  Operands both = operands(from, what);
  if (both.other.empty()) return from;
  return clipped(std::move(both), ClipOperation::subtract);
}

std::vector<Footprint> intersect(const std::vector<Footprint>& a, const std::vector<Footprint>& b,
                                 std::size_t* slivers) {
  Operands both = operands(a, b);
  if (both.other.empty()) return {};
  return clipped(std::move(both), ClipOperation::intersect, slivers);
}

/// A footprint for each side of a line.
static std::vector<Footprint> widen_sides(const std::vector<Vec2>& line, double width_m) {
  std::vector<Footprint> footprints;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    for (Footprint& side : widen({line[i], line[i + 1]}, false, width_m)) footprints.push_back(std::move(side));
  }
  return footprints;
}

std::vector<Footprint> widen(const std::vector<Vec2>& line, bool closed, double width_m) {
  const Grid grid(std::vector<const Ring*>{&line});
  if (!grid.holds(line)) return {};
  GridRing points = grid.to_grid(line);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  while (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
  if (points.size() < 2) return {};
  if (points.size() > 2 && is_tangled({points}, false)) return widen_sides(line, width_m);
  Clipping clipping;
  const std::vector<GridRing> rings = widened(points, closed, width_m / kGrid);
  for (const GridRing& ring : rings) clipping.add(ring);
  std::vector<GridPolygon> result = settled(clipping.run(ClipOperation::unite, FillRule::even_odd));
  drop_slivers(result);
  return to_footprints(result, grid);
}

}  // namespace vantage::internal::city
