#include "maps/city/roof_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "maps/city/triangulate.h"

namespace vantage::internal::city {
namespace {

constexpr double kOnCrease = 1e-4;        // metres of height within which a corner lies on a crease
constexpr double kOnCreaseShare = 1e-3;   // of the roof's height, where that is less
constexpr std::int64_t kLeastReach = 64;  // units of the grid (8 mm): a centre is that far inside every side's line

constexpr std::size_t kMostCorners = 1000;  // of a roof that runs round a centre: no more are drawn round one
constexpr std::size_t kMostSides = 256;     // of a dome with courtyards, which takes time with the square of them

/// One ring of a roof that runs round a centre: how much the outline is scaled, at which height.
struct Level {
  double scale = 1, height = 0;
};

/// Cuts a surface along the creases that a further plane makes with it, and lowers it to the plane beyond them.
class Lowering {
 public:
  Lowering(RoofSurface& surface, const RoofFrame& frame, double tolerance)
      : surface_(surface), frame_(frame), tolerance_(tolerance) {
    for (const Vec2& point : surface.points) local_.push_back(frame.local(point));
  }

  void start(const RoofPlane& plane) {
    for (std::size_t v = 0; v < local_.size(); ++v) surface_.heights[v] = plane.at(local_[v]);
  }

  void lower(const RoofPlane& plane) {
    above_.clear();
    bool any = false;
    for (std::size_t v = 0; v < local_.size(); ++v) {
      above_.push_back(plane.at(local_[v]) - surface_.heights[v]);
      any = any || above_[v] < -tolerance_;
    }
    const std::size_t whole = local_.size();
    if (any) split();
    for (std::size_t v = 0; v < whole; ++v) surface_.heights[v] += std::min(0.0, above_[v]);
  }

 private:
  int side(std::uint32_t v) const { return above_[v] > tolerance_ ? 1 : above_[v] < -tolerance_ ? -1 : 0; }

  void split() {
    middles_.clear();
    std::vector<Triangle> pieces;
    for (const Triangle& t : surface_.roof) split(t, pieces);
    surface_.roof = std::move(pieces);
  }

  void split(const Triangle& t, std::vector<Triangle>& pieces) {
    const std::array<int, 3> sides = {side(t[0]), side(t[1]), side(t[2])};
    const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
    if (least != -1 || most != 1) {
      pieces.push_back(t);
      return;
    }
    // The corner that is alone on its side, or that lies on the crease, first.
    const int sum = sides[0] + sides[1] + sides[2];
    const auto lone = static_cast<std::size_t>(
        std::find_if(sides.begin(), sides.end(), [&](int s) { return sum == 0 ? s == 0 : s == -sum; }) - sides.begin());
    const std::uint32_t a = t[lone], b = t[(lone + 1) % 3], c = t[(lone + 2) % 3];
    if (sum == 0) {
      const std::uint32_t m = middle(b, c);
      pieces.push_back({a, b, m});
      pieces.push_back({a, m, c});
      return;
    }
    const std::uint32_t ab = middle(a, b), ac = middle(a, c);
    pieces.push_back({a, ab, ac});
    const bool from_b = (local_[b] - local_[ac]).squaredNorm() <= (local_[c] - local_[ab]).squaredNorm();
    pieces.push_back(from_b ? Triangle{ab, b, ac} : Triangle{ab, b, c});
    pieces.push_back(from_b ? Triangle{b, c, ac} : Triangle{ab, c, ac});
  }

  /// The corner where the crease crosses the edge between two others: the same for both triangles there.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [found, fresh] = middles_.try_emplace({a, b}, static_cast<std::uint32_t>(local_.size()));
    if (fresh) {
      const double t = above_[a] / (above_[a] - above_[b]);
      const auto between = [&](const auto& from, const auto& to) { return from + (to - from) * t; };
      const Vec2 point = between(surface_.points[a], surface_.points[b]);
      surface_.points.push_back(point);
      surface_.heights.push_back(between(surface_.heights[a], surface_.heights[b]));
      local_.push_back(frame_.local(point));
    }
    return found->second;
  }

  RoofSurface& surface_;
  const RoofFrame& frame_;
  double tolerance_;
  std::vector<Vec2> local_;
  std::vector<double> above_;  // per corner: how far the plane is above the surface
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

std::vector<Vec2> points_of(const std::vector<GridRing>& rings, const Grid& grid) {
  std::vector<Vec2> points;
  for (const GridRing& ring : rings) {
    for (const GridPoint& p : ring) points.push_back(grid.to_metres(p));
  }
  return points;
}

/// A flat roof, for a start.
RoofSurface flat_surface(const Grid& grid, const std::vector<GridRing>& rings) {
  RoofSurface surface;
  surface.points = points_of(rings, grid);
  surface.heights.assign(surface.points.size(), 0);
  surface.roof = triangulate(rings);
  return surface;
}

RoofSurface lowered(RoofSurface surface, const std::vector<RoofPlane>& planes, const RoofFrame& frame, double roof_m) {
  Lowering lowering(surface, frame, std::min(kOnCrease, kOnCreaseShare * roof_m));
  lowering.start(planes[0]);
  for (std::size_t k = 1; k < planes.size(); ++k) lowering.lower(planes[k]);
  // Rounding leaves eaves next to 0.
  for (double& height : surface.heights) height = std::max(height, 0.0);
  const double highest = *std::max_element(surface.heights.begin(), surface.heights.end());
  for (double& height : surface.heights) height = std::min(roof_m, height * (roof_m / highest));
  return surface;
}

/// A centre from which all of the ring is seen, if one of the usual ones is that.
std::optional<GridPoint> star_centre(const GridRing& ring, const Grid& grid, const RoofFrame& frame) {
  const auto sees_all = [&](const GridPoint& centre) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const GridPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double length = std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
      if (static_cast<double>(turn(centre, a, b)) < length * static_cast<double>(kLeastReach)) return false;
    }
    return true;
  };
  Vec2 sum = Vec2::Zero();
  double twice = 0;
  const Vec2 origin = grid.to_metres(ring[0]);
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const auto area = static_cast<double>(turn(ring[0], ring[i], ring[i + 1]));
    sum += area * (grid.to_metres(ring[i]) + grid.to_metres(ring[i + 1]) - 2 * origin);
    twice += area;
  }
  for (const Vec2& centre : {Vec2(origin + sum / (3 * twice)), frame.centre}) {
    const GridPoint point = grid.to_grid(centre);
    if (sees_all(point)) return point;
  }
  return std::nullopt;
}

/// From the outline (left out) up to the tip, which has the scale 0.
std::vector<Level> levels_of(RoofShape shape, double roof_m, double radius) {
  if (shape == RoofShape::dome) {
    std::vector<Level> levels;
    const int chords = arc_chords(std::max(radius, roof_m), std::numbers::pi / 2);
    for (int k = 1; k < chords; ++k) {
      const double angle = std::numbers::pi / 2 * k / chords;
      levels.push_back({std::cos(angle), roof_m * std::sin(angle)});
    }
    levels.push_back({0, roof_m});
    return levels;
  }
  if (shape == RoofShape::onion) {
    // Out by a fifth, in again, and up to a point: a drawing, of no particular church.
    static constexpr std::array<Level, 11> drawing = {{{1.12, 0.06},
                                                       {1.19, 0.14},
                                                       {1.20, 0.22},
                                                       {1.14, 0.32},
                                                       {1.00, 0.42},
                                                       {0.80, 0.51},
                                                       {0.55, 0.60},
                                                       {0.33, 0.69},
                                                       {0.17, 0.79},
                                                       {0.07, 0.90},
                                                       {0, 1}}};
    std::vector<Level> levels(drawing.begin(), drawing.end());
    for (Level& level : levels) level.height *= roof_m;
    return levels;
  }
  return {{0, roof_m}};
}

/// Scaled copies of the outline about a centre, one above the other.
RoofSurface ringed_surface(const GridRing& outline, const GridPoint& centre, const Grid& grid,
                           const std::vector<Level>& levels) {
  RoofSurface surface = flat_surface(grid, {outline});
  surface.floor = std::move(surface.roof);
  surface.roof.clear();
  surface.floor_is_roof = false;
  const auto count = static_cast<std::uint32_t>(outline.size());
  const Vec2 middle = grid.to_metres(centre);
  std::uint32_t below = 0;
  for (const Level& level : levels) {
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    for (std::uint32_t i = 0; i < (level.scale > 0 ? count : 1); ++i) {
      surface.points.push_back(middle + level.scale * (surface.points[i] - middle));
      surface.heights.push_back(level.height);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = below + i, b = below + (i + 1) % count;
      if (level.scale > 0) {
        surface.roof.push_back({a, b, first + (i + 1) % count});
        surface.roof.push_back({a, first + (i + 1) % count, first + i});
      } else {
        surface.roof.push_back({a, b, first});
      }
    }
    below = first;
  }
  return surface;
}

/// The same over a convex outline as planes: what courtyards are cut out of. One for each side and chord.
std::vector<RoofPlane> ring_planes(const GridRing& outline, const GridPoint& centre, const Grid& grid,
                                   const RoofFrame& frame, const std::vector<Level>& levels) {
  std::vector<RoofPlane> planes;
  const Vec2 middle = frame.local(grid.to_metres(centre));
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 from = frame.local(grid.to_metres(outline[i]));
    const Vec2 along = (frame.local(grid.to_metres(outline[(i + 1) % outline.size()])) - from).normalized();
    const Vec2 inward(-along.y(), along.x());
    const double reach = (middle - from).dot(inward);
    Level below;
    for (const Level& level : levels) {
      // The distance from the side, 0 to 1 at the centre, is 1 - scale.
      const double slope = (level.height - below.height) / (below.scale - level.scale);
      const double base = below.height - slope * (1 - below.scale);
      const Vec2 gradient = inward * (slope / reach);
      planes.push_back({gradient.x(), gradient.y(), base - gradient.dot(from)});
      below = level;
    }
  }
  return planes;
}

bool is_convex(const GridRing& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (turn(ring[i], ring[(i + 1) % ring.size()], ring[(i + 2) % ring.size()]) < 0) return false;
  }
  return true;
}

/// A box as high as the roof's top, which holds whatever shape it has.
RoofSurface box(const Grid& grid, const std::vector<GridRing>& rings, double roof_m) {
  RoofSurface surface = flat_surface(grid, rings);
  surface.heights.assign(surface.points.size(), roof_m);
  return surface;
}

RoofSurface box_instead(const Grid& grid, const std::vector<GridRing>& rings, const BuildingForm& form,
                        const char* over) {
  RoofSurface surface = box(grid, rings, form.roof_m);
  surface.repair = std::string(text(form.roof)) + " roof over an outline " + over;
  return surface;
}

/// A roof that runs round a centre; over the bounding rectangle where a pyramid has none.
RoofSurface central_surface(const Footprint& footprint, const Grid& grid, const std::vector<GridRing>& rings,
                            const BuildingForm& form, const RoofFrame& frame) {
  const GridRing outline = grid.to_grid(footprint.outer);
  if (outline.size() > kMostCorners) return box_instead(grid, rings, form, "of more than 1,000 corners");
  const bool open = rings.size() == 1 && footprint.holes.empty();
  const std::optional<GridPoint> centre = star_centre(open ? rings[0] : outline, grid, frame);
  const bool by_planes = is_convex(outline) && outline.size() <= kMostSides && form.roof != RoofShape::onion;
  if (centre && (open || by_planes)) {
    const std::vector<Level> levels = levels_of(form.roof, form.roof_m, std::max(frame.half_length, frame.half_width));
    if (open) return ringed_surface(rings[0], *centre, grid, levels);
    return lowered(flat_surface(grid, rings), ring_planes(outline, *centre, grid, frame, levels), frame, form.roof_m);
  }
  if (form.roof == RoofShape::pyramidal) {
    return lowered(flat_surface(grid, rings), roof_planes(RoofShape::pyramidal, frame, form.roof_m), frame,
                   form.roof_m);
  }
  return box_instead(grid, rings, form,
                     open ? "that is not star-shaped" : "with courtyards that is not simple and convex");
}

}  // namespace

RoofSurface roof_surface(const Footprint& footprint, const Grid& grid, const std::vector<GridRing>& rings,
                         const BuildingForm& form, const RoofFrame& frame) {
  if (form.roof == RoofShape::flat || form.roof_m <= 0) return flat_surface(grid, rings);
  if (form.is_box) return box(grid, rings, form.roof_m);
  const std::vector<RoofPlane> planes = roof_planes(form.roof, frame, form.roof_m);
  const bool central = planes.empty() || form.roof == RoofShape::pyramidal;
  if (central) return central_surface(footprint, grid, rings, form, frame);
  return lowered(flat_surface(grid, rings), planes, frame, form.roof_m);
}

}  // namespace vantage::internal::city
