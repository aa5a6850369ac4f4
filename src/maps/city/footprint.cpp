#include "maps/city/footprint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <clipper.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "maps/city/grid_rings.h"
#include "maps/city/triangulate.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

constexpr double kUnitsPerMetre = 1 / kGrid;
constexpr double kLeastWidth = 0.01 * kUnitsPerMetre;                  // of a piece: 1 cm
constexpr double kLeastArea = 0.01 * kUnitsPerMetre * kUnitsPerMetre;  // of a piece: 0.01 m2
// Crossings are rounded to the grid, which may make sides cross again; every round makes that rarer.
constexpr int kMostRounds = 20;
constexpr double kMiterLimit = 3;  // of a sharp bend in a widened line, in half widths; beyond it is cut off

/// A polygon with holes on the grid.
struct GridPolygon {
  GridRing outer;
  std::vector<GridRing> holes;
};

/// `scale`: how many of Clipper's units one of the grid's is.
Path to_path(const GridRing& ring, std::int64_t scale = 1) {
  Path path;
  path.reserve(ring.size());
  for (const GridPoint& p : ring) path.emplace_back(p.x * scale, p.y * scale);
  return path;
}

GridRing to_ring(const Path& path, std::int64_t scale = 1) {
  const auto rounded = [&](std::int64_t v) { return (v >= 0 ? v + scale / 2 : v - scale / 2) / scale; };
  GridRing ring;
  ring.reserve(path.size());
  for (const IntPoint& p : path) ring.push_back({rounded(p.X), rounded(p.Y)});
  return ring;
}

/// How close to a straight line a point is taken to lie on it.
enum class Straight { exact, within_a_unit };

/// Whether `b` says nothing between `a` and `c`: it repeats one of them, lies on the straight line between them, or is
/// the tip of a spike.
bool is_idle(const GridPoint& a, const GridPoint& b, const GridPoint& c, Straight straight) {
  if (a == b || b == c || a == c) return true;
  const std::int64_t twice = turn(b, a, c);
  if (straight == Straight::exact || twice == 0) return twice == 0;
  const auto area = static_cast<double>(std::abs(twice));
  const double ab = std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
  const double bc = std::hypot(static_cast<double>(c.x - b.x), static_cast<double>(c.y - b.y));
  const double ac = std::hypot(static_cast<double>(a.x - c.x), static_cast<double>(a.y - c.y));
  return dot(b, a, c) > 0 ? area < std::max(ab, bc) : area < ac;
}

/// Without idle points; empty when fewer than three are left.
GridRing tidied(const GridRing& ring, Straight straight = Straight::within_a_unit) {
  GridRing result = ring;
  for (bool changed = true; changed && result.size() >= 3;) {
    changed = false;
    GridRing kept;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const GridPoint& before = kept.empty() ? result.back() : kept.back();
      const GridPoint& after = i + 1 < result.size() ? result[i + 1] : (kept.empty() ? result[0] : kept[0]);
      if (is_idle(before, result[i], after, straight)) {
        changed = true;
      } else {
        kept.push_back(result[i]);
      }
    }
    result = std::move(kept);
  }
  return result.size() >= 3 ? result : GridRing{};
}

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

bool is_sliver(double area, double perimeter) { return area < kLeastArea || 2 * area < kLeastWidth * perimeter; }

/// Whether `inner`, which does not cross `outer`, lies inside it.
bool is_inside(const GridRing& inner, const GridRing& outer) {
  GridRing doubled = outer;
  for (GridPoint& p : doubled) p = {2 * p.x, 2 * p.y};
  for (std::size_t i = 0; i < inner.size(); ++i) {  // the first corner or middle of a side that is not on `outer`
    const GridPoint &a = inner[i], &b = inner[(i + 1) % inner.size()];
    for (const GridPoint& p : {GridPoint{2 * a.x, 2 * a.y}, GridPoint{a.x + b.x, a.y + b.y}}) {
      const Place place = place_of(p, doubled);
      if (place != Place::boundary) return place == Place::inside;
    }
  }
  return false;
}

/// Polygons from rings that do not cross: inside is what lies in an odd number of them. (Clipper's own tree is wrong
/// now and then where rings touch.)
std::vector<GridPolygon> nested(const std::vector<GridRing>& rings) {
  std::vector<GridPolygon> result;
  if (rings.size() == 1) return {{turned(rings[0], true), {}}};
  std::vector<std::vector<std::size_t>> around(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = 0; j < rings.size(); ++j) {
      if (i != j && is_inside(rings[i], rings[j])) around[i].push_back(j);
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

/// Runs Clipper, and makes polygons of what comes out. Clipper rounds wherever a side passes the height of a
/// corner, so it is given finer units than those of the grid: as fine as its fast arithmetic allows, or `kFinest`.
class Clipping {
 public:
  void add(const GridRing& ring, ClipperLib::PolyType type = ClipperLib::ptSubject) {
    for (const GridPoint& p : ring) largest_ = std::max({largest_, std::abs(p.x), std::abs(p.y)});
    (type == ClipperLib::ptSubject ? subject_ : clip_).push_back(&ring);
  }
  void add(const std::vector<GridPolygon>& polygons, ClipperLib::PolyType type = ClipperLib::ptSubject) {
    for (const GridPolygon& polygon : polygons) {
      add(polygon.outer, type);
      for (const GridRing& hole : polygon.holes) add(hole, type);
    }
  }
  /// Everything added must still be there. `fine`: at any cost.
  std::vector<GridPolygon> run(ClipperLib::ClipType what, ClipperLib::PolyFillType fill, bool fine = false) {
    scale_ = 1;
    while (scale_ < kFinest && (fine || 2 * scale_ * largest_ < ClipperLib::loRange)) scale_ *= 2;
    ClipperLib::Clipper clipper;
    clipper.StrictlySimple(true);
    for (const GridRing* ring : subject_) clipper.AddPath(to_path(*ring, scale_), ClipperLib::ptSubject, true);
    for (const GridRing* ring : clip_) clipper.AddPath(to_path(*ring, scale_), ClipperLib::ptClip, true);
    Paths paths;
    if (!clipper.Execute(what, paths, fill, fill)) {
      throw Error(ErrorCode::internal_defect, "outlines could not be clipped", "outline",
                  "please report this with the map");
    }
    std::vector<GridRing> rings;
    for (const Path& path : paths) {
      GridRing ring = tidied(to_ring(path, scale_), Straight::exact);
      if (!ring.empty()) rings.push_back(std::move(ring));
    }
    return nested(rings);
  }

 private:
  static constexpr std::int64_t kFinest = 4096;

  std::vector<const GridRing*> subject_, clip_;
  std::int64_t largest_ = 1, scale_ = 1;
};

std::vector<GridRing> rings_of(const std::vector<GridPolygon>& polygons) {
  std::vector<GridRing> rings;
  for (const GridPolygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

/// Without points that are next to nothing off a straight line; as they are where sides would cross then.
std::vector<GridPolygon> smoothed(const std::vector<GridPolygon>& polygons) {
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

/// Until no side crosses another. What comes out of Clipper is wound evenly: inside is inside an odd number of rings.
std::vector<GridPolygon> settled(std::vector<GridPolygon> polygons) {
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<GridRing> rings = rings_of(polygons);
    if (!meeting_of(rings).crossing) return smoothed(polygons);
    Clipping clipping;
    for (const GridRing& ring : rings) clipping.add(ring);
    polygons = clipping.run(ClipperLib::ctUnion, ClipperLib::pftEvenOdd, true);
  }
  throw Error(ErrorCode::internal_defect, "an outline goes on crossing itself", "outline",
              "please report this with the map");
}

/// Takes out what is too small to build, holes too. Returns how many.
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

/// Whether every hole lies in the outer ring and in no other hole, for rings that neither cross nor touch.
bool is_nested(const GridPolygon& polygon) {
  for (const GridRing& hole : polygon.holes) {
    if (!is_inside(hole, polygon.outer)) return false;
    for (const GridRing& other : polygon.holes) {
      if (&other != &hole && is_inside(hole, other)) return false;
    }
  }
  return true;
}

/// Of the space that a ring goes round an odd number of times, by summing up slabs between the heights at which
/// something happens. Cost: O(n^2 + n k) for k crossings. Nothing where that takes seconds.
std::optional<double> even_odd_area(const GridRing& ring) {
  std::vector<Vec2> points;
  for (const GridPoint& p : ring) points.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
  const std::size_t count = points.size();
  const auto x_at = [&](std::size_t i, double y) {
    const Vec2 &a = points[i], &b = points[(i + 1) % count];
    return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  };
  std::vector<double> heights;
  for (std::size_t i = 0; i < count; ++i) {
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
  constexpr std::size_t kMostSteps = 100'000'000;
  if (heights.size() * count > kMostSteps) return std::nullopt;
  std::sort(heights.begin(), heights.end());
  double sum = 0;
  std::vector<double> crossed;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
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

double area_of(const std::vector<GridPolygon>& polygons) {
  double sum = 0;
  for (const GridPolygon& polygon : polygons) sum += area_of(polygon);
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
    std::vector<GridPolygon> result = settled(clipping.run(ClipperLib::ctUnion, ClipperLib::pftEvenOdd));
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
  // A ring that touches itself is no figure of eight: it goes round all of its space in one sense.
  const double whole = std::abs(signed_area(ring));
  repairs.self_crossing |= meeting.crossing || std::abs(area_of(result) - whole) > perimeter(ring);
  return result;
}

/// Whether sides cross one another more often than drawing explains. What is made of them would take time with the
/// square of the crossings, and look like nothing.
bool is_tangled(const std::vector<GridRing>& rings, bool closed = true) {
  constexpr std::size_t kMostCrossings = 1000;
  struct Side {
    Vec2 from, to;
    double left = 0, right = 0;
  };
  std::vector<Side> sides;
  for (const GridRing& ring : rings) {
    const auto at = [&](std::size_t i) {
      return Vec2(double(ring[i % ring.size()].x), double(ring[i % ring.size()].y));
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
    const Side& a = sides[i];
    for (std::size_t j = i + 1; j < sides.size() && sides[j].left <= a.right; ++j) {
      const Side& b = sides[j];
      crossings += parts(a, b.from, b.to) && parts(b, a.from, a.to);
      if (crossings > kMostCrossings) return true;
    }
  }
  return false;
}

/// One polygon of the rough ones; its rings are tidy.
std::vector<GridPolygon> cleaned(const GridPolygon& rough, Repairs& repairs) {
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
  clipping.add(holes, ClipperLib::ptClip);
  area -= area_of(holes);
  result = settled(clipping.run(ClipperLib::ctDifference, ClipperLib::pftNonZero));
  // Where holes lie inside and apart, each takes its own area off the outer ring's.
  repairs.nesting |= std::abs(area - area_of(result)) > length;
  return result;
}

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

std::vector<Footprint> clipped(const Operands& operands, ClipperLib::ClipType what) {
  Clipping clipping;
  clipping.add(operands.subject);
  clipping.add(operands.other, ClipperLib::ptClip);
  std::vector<GridPolygon> result = settled(clipping.run(what, ClipperLib::pftNonZero));
  drop_slivers(result);
  return to_footprints(result, operands.grid);
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
    GridPolygon polygon{turned(tidied(grid.to_grid(footprint.outer)), true), {}};
    for (const Ring& hole : footprint.holes) {
      GridRing ring = turned(tidied(grid.to_grid(hole)), false);
      if (!ring.empty()) polygon.holes.push_back(std::move(ring));
    }
    if (polygon.outer.empty()) {
      ++repairs.slivers;
      continue;
    }
    ++parts;
    std::vector<GridPolygon> simple = cleaned(polygon, repairs);
    pieces.insert(pieces.end(), simple.begin(), simple.end());
  }
  if (parts > 1) {  // they may touch or overlap
    Clipping clipping;
    clipping.add(pieces);
    pieces = settled(clipping.run(ClipperLib::ctUnion, ClipperLib::pftNonZero));
  }
  repairs.slivers += drop_slivers(pieces);
  return to_footprints(pieces, grid);
}

std::vector<Footprint> subtract(const std::vector<Footprint>& from, const std::vector<Footprint>& what) {
  const Operands both = operands(from, what);
  if (both.other.empty()) return from;
  return clipped(both, ClipperLib::ctDifference);
}

std::vector<Footprint> intersect(const std::vector<Footprint>& a, const std::vector<Footprint>& b) {
  const Operands both = operands(a, b);
  if (both.other.empty()) return {};
  return clipped(both, ClipperLib::ctIntersection);
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
  ClipperLib::ClipperOffset offset(kMiterLimit);
  offset.AddPath(to_path(points), ClipperLib::jtMiter,
                 closed && points.size() > 2 ? ClipperLib::etClosedLine : ClipperLib::etOpenButt);
  Paths paths;
  offset.Execute(paths, width_m / 2 * kUnitsPerMetre);
  Clipping clipping;
  std::vector<GridRing> rings;
  for (const Path& path : paths) rings.push_back(to_ring(path));
  for (const GridRing& ring : rings) clipping.add(ring);
  std::vector<GridPolygon> result = settled(clipping.run(ClipperLib::ctUnion, ClipperLib::pftEvenOdd));
  drop_slivers(result);
  return to_footprints(result, grid);
}

}  // namespace vantage::internal::city
