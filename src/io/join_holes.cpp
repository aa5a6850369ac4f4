#include "io/join_holes.h"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>

#include "io/triangulate_polygon.h"

namespace vantage::internal::io {
namespace {

using Point = Eigen::Vector2d;
using Ring = std::vector<std::uint32_t>;

/// Twice the signed area of a triangle.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class HoleJoiner {
 public:
  HoleJoiner(std::vector<Point> points, Ring border) : points_(std::move(points)), border_(std::move(border)) {}

  /// `hole` begins with its corner of largest x and runs clockwise.
  bool join(Ring hole) {
    std::optional<std::size_t> bridge = find_touch(hole);
    if (!bridge) bridge = find_bridge(hole);
    if (!bridge) return false;
    hole.push_back(hole[0]);
    hole.push_back(border_[*bridge]);
    border_.insert(border_.begin() + static_cast<std::ptrdiff_t>(*bridge) + 1, hole.begin(), hole.end());
    return true;
  }

  double x(std::uint32_t corner) const { return points_[corner].x(); }
  /// Twice the signed area.
  double area(const Ring& ring) const {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      sum += turn(points_[ring[0]], points_[ring[i]], points_[ring[(i + 1) % ring.size()]]);
    }
    return sum;
  }
  const Ring& border() const { return border_; }

 private:
  const Point& at(std::size_t position) const { return points_[border_[position % border_.size()]]; }
  const Point& before(std::size_t position) const { return at(position + border_.size() - 1); }

  /// The position in the border of a corner at the place of one of the hole, which becomes the hole's first. A bridge
  /// elsewhere would leave a polygon that meets itself in a point, and ears cannot be told there.
  std::optional<std::size_t> find_touch(Ring& hole) const {
    for (auto corner = hole.begin(); corner != hole.end(); ++corner) {
      for (const std::uint32_t other : border_) {
        if (points_[*corner] != points_[other]) continue;
        std::rotate(hole.begin(), corner, hole.end());
        return position_towards(points_[other], points_[hole[1]]);
      }
    }
    return std::nullopt;
  }

  /// The position in the border of a corner that the hole's first corner sees.
  std::optional<std::size_t> find_bridge(const Ring& hole) const {
    const Point& from = points_[hole[0]];
    // The border runs counter-clockwise: what is inside has, to its right, an edge that runs upward.
    double nearest = std::numeric_limits<double>::infinity(), outside = nearest;
    std::size_t edge = 0;
    for (std::size_t i = 0; i < border_.size(); ++i) {
      const Point &a = at(i), &b = at(i + 1);
      if (std::min(a.y(), b.y()) > from.y() || std::max(a.y(), b.y()) < from.y() || a.y() == b.y()) continue;
      // A bridge is run both ways: the lower end first, so that both give the same number.
      const double x = a.y() < b.y() ? crossing(a, b, from.y()) : crossing(b, a, from.y());
      if (x < from.x()) continue;
      double& found = a.y() < b.y() ? nearest : outside;
      if (x >= found) continue;
      found = x;
      if (a.y() < b.y()) edge = i;
    }
    if (nearest == std::numeric_limits<double>::infinity() || outside < nearest) return std::nullopt;
    const Point crossed(nearest, from.y());
    const Point end = at(edge) == crossed || at(edge).x() > at(edge + 1).x() ? at(edge) : at(edge + 1);
    const bool direct = at(edge) == crossed || at(edge + 1) == crossed;
    return position_towards(direct ? crossed : least_angle(from, crossed, end), from);
  }

  /// Where the edge has this y; exactly at an end where that has it.
  static double crossing(const Point& a, const Point& b, double y) {
    if (y == a.y()) return a.x();
    if (y == b.y()) return b.x();
    return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }

  /// The corner that is nearest to the ray in angle, of those in the triangle that could hide `end`; else `end`.
  Point least_angle(const Point& from, const Point& crossed, const Point& end) const {
    Point best = end;
    double best_slope = std::abs(end.y() - from.y()) / (end.x() - from.x());
    const double sign = end.y() > from.y() ? 1 : -1;
    for (std::size_t i = 0; i < border_.size(); ++i) {
      const Point& p = at(i);
      if (p.x() < from.x() || p == end || p == from) continue;
      if (sign * turn(from, crossed, p) < 0 || sign * turn(crossed, end, p) < 0 || sign * turn(end, from, p) < 0) {
        continue;
      }
      const double slope = std::abs(p.y() - from.y()) / (p.x() - from.x());
      if (!(slope < best_slope || (slope == best_slope && p.x() < best.x()))) continue;
      best = p;
      best_slope = slope;
    }
    return best;
  }

  /// The border may pass a place several times; of these positions, the one whose interior angle `target` lies in.
  std::size_t position_towards(const Point& place, const Point& target) const {
    std::size_t first = border_.size();
    for (std::size_t i = 0; i < border_.size(); ++i) {
      if (at(i) != place) continue;
      if (first == border_.size()) first = i;
      if (in_angle(before(i), place, at(i + 1), target)) return i;
    }
    return first;
  }

  /// O'Rourke, Computational Geometry in C, section 1.5.
  static bool in_angle(const Point& previous, const Point& tip, const Point& next, const Point& target) {
    if (turn(previous, tip, next) > 0) return turn(tip, target, previous) > 0 && turn(target, tip, next) > 0;
    return !(turn(tip, target, next) >= 0 && turn(target, tip, previous) >= 0);
  }

  std::vector<Point> points_;
  Ring border_;
};

}  // namespace

std::vector<std::uint32_t> join_holes(const std::vector<Vec3>& points, const std::vector<std::size_t>& ends,
                                      std::size_t& left_out) {
  const auto ring = [&](std::size_t first, std::size_t end) {
    Ring corners;
    for (std::size_t i = first; i < end; ++i) corners.push_back(static_cast<std::uint32_t>(i));
    return corners;
  };
  HoleJoiner joiner(project_polygon(points, ends[0]), ring(0, ends[0]));
  std::vector<Ring> holes;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    Ring hole = ring(ends[i - 1], ends[i]);
    if (joiner.area(hole) > 0) std::reverse(hole.begin(), hole.end());
    std::rotate(hole.begin(),
                std::max_element(hole.begin(), hole.end(),
                                 [&](std::uint32_t a, std::uint32_t b) { return joiner.x(a) < joiner.x(b); }),
                hole.end());
    holes.push_back(std::move(hole));
  }
  // From the right to the left: what a hole sees to its right is then all joined already.
  std::stable_sort(holes.begin(), holes.end(),
                   [&](const Ring& a, const Ring& b) { return joiner.x(a[0]) > joiner.x(b[0]); });
  for (const Ring& hole : holes) {
    if (!joiner.join(hole)) ++left_out;
  }
  return joiner.border();
}

}  // namespace vantage::internal::io
