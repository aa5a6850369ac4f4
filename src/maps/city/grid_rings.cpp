#include "maps/city/grid_rings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "maps/city/interruption.h"

namespace vantage::internal::city {
namespace {

/// The sides of some rings, in the order of the corners that they begin at.
class Sides {
 public:
  struct Side {
    GridPoint from, to;
    std::size_t next = 0, previous = 0;
    std::int64_t low_x = 0, high_x = 0, low_y = 0, high_y = 0;
    std::size_t ring = 0;
  };

  explicit Sides(const std::vector<GridRing>& rings) {
    for (std::size_t number = 0; number < rings.size(); ++number) {
      const GridRing& ring = rings[number];
      const std::size_t first = all_.size(), count = ring.size();
      for (std::size_t i = 0; i < count; ++i) {
        const GridPoint &a = ring[i], &b = ring[(i + 1) % count];
        all_.push_back({a, b, first + (i + 1) % count, first + (i + count - 1) % count, std::min(a.x, b.x),
                        std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y), number});
      }
    }
  }

  /// Calls `visit(i, j)` once for each pair whose boxes meet. Sweeps along the axis on which the sides are the shorter.
  template <typename Visit>
  void for_each_near_pair(const Visit& visit) const {
    double x = 0, y = 0;
    for (const Side& side : all_) {
      x += static_cast<double>(side.high_x - side.low_x);
      y += static_cast<double>(side.high_y - side.low_y);
    }
    if (x <= y) {
      sweep(&Side::low_x, &Side::high_x, &Side::low_y, &Side::high_y, visit);
    } else {
      sweep(&Side::low_y, &Side::high_y, &Side::low_x, &Side::high_x, visit);
    }
  }

  const Side& operator[](std::size_t i) const { return all_[i]; }

 private:
  using Bound = std::int64_t Side::*;

  /// From the least `low` on.
  template <typename Visit>
  void sweep(Bound low, Bound high, Bound across_low, Bound across_high, const Visit& visit) const {
    std::vector<std::size_t> order(all_.size()), open;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return all_[i].*low < all_[j].*low; });
    for (const std::size_t i : order) {
      Interruption::tick();
      const Side& side = all_[i];
      std::size_t kept = 0;
      for (const std::size_t j : open) {
        if (all_[j].*high < side.*low) continue;
        open[kept++] = j;
        if (all_[j].*across_low <= side.*across_high && side.*across_low <= all_[j].*across_high) visit(i, j);
      }
      open.resize(kept);
      open.push_back(i);
    }
  }

  std::vector<Side> all_;
};

int sign(std::int64_t value) { return static_cast<int>(value > 0) - static_cast<int>(value < 0); }

/// Whether two sides in one line have more than a point in common.
bool overlap(const Sides::Side& a, const Sides::Side& b) {
  const std::int64_t x = std::min(a.high_x, b.high_x) - std::max(a.low_x, b.low_x);
  const std::int64_t y = std::min(a.high_y, b.high_y) - std::max(a.low_y, b.low_y);
  return std::max(x, y) > 0;
}

}  // namespace

Grid::Grid(const std::vector<const Ring*>& rings) { centre_on(rings); }

Grid::Grid(const Footprint& footprint) { centre_on({&footprint.outer}); }

void Grid::centre_on(const std::vector<const Ring*>& rings) {
  Eigen::AlignedBox2d box;
  for (const Ring* ring : rings) {
    for (const Vec2& point : *ring) {
      if (point.allFinite()) box.extend(point);
    }
  }
  if (!box.isEmpty()) origin_ = (box.center() / kGrid).array().round() * kGrid;
}

bool Grid::holds(const Ring& ring) const {
  return std::all_of(ring.begin(), ring.end(), [&](const Vec2& point) {
    return point.allFinite() && (point - origin_).lpNorm<Eigen::Infinity>() < static_cast<double>(kLargest) * kGrid;
  });
}

GridPoint Grid::to_grid(const Vec2& point) const {
  const Vec2 local = (point - origin_) / kGrid;
  return {std::llround(local.x()), std::llround(local.y())};
}

GridRing Grid::to_grid(const Ring& ring) const {
  GridRing result;
  result.reserve(ring.size());
  for (const Vec2& point : ring) result.push_back(to_grid(point));
  return result;
}

Ring Grid::to_metres(const GridRing& ring) const {
  Ring result;
  result.reserve(ring.size());
  for (const GridPoint& point : ring) result.push_back(to_metres(point));
  return result;
}

PointLocation locate(const GridPoint& point, const GridRing& ring) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if (on_segment(point, a, b)) return PointLocation::boundary;
    // The side passes the point's height, and does so to its east.
    if ((a.y > point.y) != (b.y > point.y) && (turn(point, a, b) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside ? PointLocation::inside : PointLocation::outside;
}

double signed_area(const GridRing& ring) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < ring.size(); ++i)
    twice += static_cast<double>(turn(ring[0], ring[i + 1], ring[i + 2]));
  return twice / 2;
}

GridBox box_of(const GridRing& ring) {
  GridBox box;
  for (const GridPoint& p : ring) box.extend(GridBox::VectorType(p.x, p.y));
  return box;
}

GridRing near_box(const GridRing& ring, const GridBox& box) {
  const auto beyond = [&](const GridPoint& p) {
    return (p.x < box.min().x() ? 1U : 0U) | (p.x > box.max().x() ? 2U : 0U) | (p.y < box.min().y() ? 4U : 0U) |
           (p.y > box.max().y() ? 8U : 0U);
  };
  GridRing kept;
  unsigned common = 0;  // sides that the last one that is kept and all since lie beyond
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const unsigned here = beyond(ring[i]);
    if ((common & here & beyond(ring[(i + 1) % ring.size()])) != 0) {
      common &= here;
    } else {
      kept.push_back(ring[i]);
      common = here;
    }
  }
  return kept;
}

GridRing hull_of(GridRing points) {
  std::sort(points.begin(), points.end());
  GridRing hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const GridPoint& p : points) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void for_each_meeting(const std::vector<GridRing>& rings, const MeetingVisit& visit) {
  const Sides sides(rings);
  sides.for_each_near_pair([&](std::size_t i, std::size_t j) {
    const Sides::Side &a = sides[i], &b = sides[j];
    const int b_from = sign(turn(a.from, a.to, b.from)), b_to = sign(turn(a.from, a.to, b.to));
    if (b_from * b_to > 0) return;
    const int a_from = sign(turn(b.from, b.to, a.from)), a_to = sign(turn(b.from, b.to, a.to));
    if (a_from * a_to > 0) return;
    const bool in_line = b_from == 0 && b_to == 0;
    if (in_line ? overlap(a, b) : b_from * b_to < 0 && a_from * a_to < 0) {
      visit(a.ring, b.ring, true);
    } else if (a.next != j && b.next != i) {
      visit(a.ring, b.ring, false);
    }
  });
}

Meeting meeting_of(const std::vector<GridRing>& rings) {
  Meeting result;
  for_each_meeting(
      rings, [&](std::size_t, std::size_t, bool crossing) { (crossing ? result.crossing : result.touching) = true; });
  return result;
}

std::vector<Touch> touches_of(const std::vector<GridRing>& rings) {
  std::vector<Touch> result;
  const Sides sides(rings);
  const auto look = [&](std::size_t corner, std::size_t side) {
    if (corner == side || corner == sides[side].next) return;
    if (on_segment(sides[corner].from, sides[side].from, sides[side].to)) result.push_back({corner, side});
  };
  sides.for_each_near_pair([&](std::size_t i, std::size_t j) {
    look(i, j);
    look(j, i);
    // The far ends begin sides of their own, whose boxes meet these as well: seen then.
  });
  return result;
}

}  // namespace vantage::internal::city
