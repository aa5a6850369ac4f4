#include "query/join_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace vantage::internal::query {
namespace {

using Corner = std::uint32_t;
using Edge = std::pair<Corner, Corner>;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

double area_of_ring(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) twice += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return 0.5 * twice;
}

double length_of_ring(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return sum;
}

/// Points, of which those nearer than `snap` are one.
class Corners {
 public:
  explicit Corners(double snap) : snap_(snap) {}

  Corner add(const Point2& point) {
    const std::int64_t x = cell(point.x()), y = cell(point.y());
    for (std::int64_t i = x - 1; i <= x + 1; ++i) {
      for (std::int64_t j = y - 1; j <= y + 1; ++j) {
        const auto found = cells_.find(key(i, j));
        if (found == cells_.end()) continue;
        for (const Corner corner : found->second) {
          if ((points_[corner] - point).norm() <= snap_) return corner;
        }
      }
    }
    points_.push_back(point);
    const auto corner = static_cast<Corner>(points_.size() - 1);
    cells_[key(x, y)].push_back(corner);
    return corner;
  }
  const std::vector<Point2>& points() const { return points_; }

 private:
  std::int64_t cell(double value) const { return static_cast<std::int64_t>(std::floor(value / (2 * snap_))); }
  static std::uint64_t key(std::int64_t i, std::int64_t j) {
    return static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(j);
  }

  double snap_;
  std::vector<Point2> points_;
  std::unordered_map<std::uint64_t, std::vector<Corner>> cells_;
};

/// Finds the corners on an edge, from its first to its last.
class EdgeCutter {
 public:
  EdgeCutter(const std::vector<Point2>& points, double snap) : points_(points), snap_(snap), by_x_(points.size()) {
    std::iota(by_x_.begin(), by_x_.end(), 0U);
    std::sort(by_x_.begin(), by_x_.end(), [&](Corner a, Corner b) { return points_[a].x() < points_[b].x(); });
  }

  const std::vector<Corner>& cut(Corner from, Corner to) {
    const Point2 &a = points_[from], &b = points_[to];
    const double length = (b - a).norm(), low = std::min(a.x(), b.x()) - snap_, high = std::max(a.x(), b.x()) + snap_;
    const Point2 along = (b - a) / length;
    found_.clear();
    auto at = std::lower_bound(by_x_.begin(), by_x_.end(), low,
                               [&](Corner corner, double x) { return points_[corner].x() < x; });
    for (; at != by_x_.end() && points_[*at].x() <= high; ++at) {
      const Point2 off = points_[*at] - a;
      const double place = along.dot(off);
      if (*at == from || *at == to || place <= 0 || place >= length || std::abs(cross(along, off)) > snap_) continue;
      found_.emplace_back(place, *at);
    }
    std::sort(found_.begin(), found_.end());
    corners_.assign(1, from);
    for (const auto& [place, corner] : found_) corners_.push_back(corner);
    corners_.push_back(to);
    return corners_;
  }

 private:
  const std::vector<Point2>& points_;
  double snap_;
  std::vector<Corner> by_x_;
  std::vector<std::pair<double, Corner>> found_;
  std::vector<Corner> corners_;
};

/// The edges that have pieces on their left only. As many begin in each corner as end there.
std::map<Edge, int> border_of(const Pieces& pieces, Corners& corners, double snap) {
  std::vector<std::vector<Corner>> outlines(pieces.count());
  for (std::size_t i = 0; i < pieces.count(); ++i) {
    for (const Point2& point : pieces[i]) outlines[i].push_back(corners.add(point));
  }
  EdgeCutter cutter(corners.points(), snap);
  std::map<Edge, int> border;
  const auto add = [&](Corner from, Corner to) {
    const auto opposite = border.find({to, from});
    if (opposite == border.end()) {
      ++border[{from, to}];
    } else if (--opposite->second == 0) {
      border.erase(opposite);
    }
  };
  for (const auto& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Corner from = outline[i], to = outline[i + 1 == outline.size() ? 0 : i + 1];
      if (from == to) continue;
      const std::vector<Corner>& cut = cutter.cut(from, to);
      for (std::size_t k = 0; k + 1 < cut.size(); ++k) add(cut[k], cut[k + 1]);
    }
  }
  return border;
}

/// Follows the border with what it bounds on the left.
class Tracer {
 public:
  Tracer(const std::map<Edge, int>& border, const std::vector<Point2>& points) : points_(points) {
    for (const auto& [edge, count] : border) {
      for (int i = 0; i < count; ++i) ends_[edge.first].push_back(edge.second);
    }
  }

  /// All rings; none of them passes a corner twice.
  std::vector<std::vector<Corner>> rings() {
    std::vector<std::vector<Corner>> result;
    for (auto& [start, ends] : ends_) {
      while (!ends.empty()) split(walk(start), result);
    }
    return result;
  }

 private:
  /// From an edge until it would be taken again.
  std::vector<Corner> walk(Corner start) {
    const Corner first = ends_[start].front();
    std::vector<Corner> path{start};
    for (Corner from = start, to = first;;) {
      const Corner next = take(to, from);
      if (to == start && next == first) return path;
      path.push_back(to);
      from = to;
      to = next;
    }
  }

  /// Coming from `from`, the edge that is met first when one turns from there clockwise: what lies between is inside.
  Corner take(Corner at, Corner from) {
    std::vector<Corner>& ends = ends_[at];
    const Point2 back = points_[from] - points_[at];
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Point2 off = points_[ends[i]] - points_[at];
      double turn = -std::atan2(cross(back, off), back.dot(off));  // clockwise
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (turn < least) {
        least = turn;
        best = i;
      }
    }
    const Corner end = ends[best];
    ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(best));
    return end;
  }

  /// A path that comes by a corner again ends a ring there.
  static void split(const std::vector<Corner>& path, std::vector<std::vector<Corner>>& rings) {
    std::vector<Corner> open;
    std::map<Corner, std::size_t> place;
    for (const Corner corner : path) {
      const auto seen = place.find(corner);
      if (seen != place.end()) {
        const auto begin = open.begin() + static_cast<std::ptrdiff_t>(seen->second);
        rings.emplace_back(begin, open.end());
        for (auto it = begin; it != open.end(); ++it) place.erase(*it);
        open.erase(begin, open.end());
      }
      place[corner] = open.size();
      open.push_back(corner);
    }
    rings.push_back(open);
  }

  const std::vector<Point2>& points_;
  std::map<Corner, std::vector<Corner>> ends_;
};

/// Without the corners that lie on the line between those beside them.
Ring straightened(const std::vector<Corner>& corners, const std::vector<Point2>& points, double snap) {
  Ring ring;
  for (const Corner corner : corners) ring.push_back(points[corner]);
  for (std::size_t i = 0; i < ring.size() && ring.size() > 3;) {
    const Point2 &before = ring[(i + ring.size() - 1) % ring.size()], &after = ring[(i + 1) % ring.size()];
    const Point2 along = after - before, off = ring[i] - before;
    const bool is_between = along.dot(off) > 0 && along.dot(off) < along.squaredNorm();
    if (is_between && std::abs(cross(along, off)) <= snap * along.norm()) {
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return ring;
}

bool holds(const Ring& ring, const Point2& point) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

}  // namespace

std::vector<JoinedPolygon> join_pieces(const Pieces& pieces, double snap) {
  Corners corners(snap);
  const std::map<Edge, int> border = border_of(pieces, corners, snap);
  std::vector<JoinedPolygon> polygons;
  std::vector<Ring> holes;
  for (const std::vector<Corner>& path : Tracer(border, corners.points()).rings()) {
    Ring ring = straightened(path, corners.points(), snap);
    const double area = area_of_ring(ring);
    if (std::abs(area) <= snap * length_of_ring(ring)) continue;
    if (area > 0) {
      polygons.push_back({std::move(ring), {}});
    } else {
      holes.push_back(std::move(ring));
    }
  }
  // Each in the smallest ring about it: a ring in a hole has holes of its own.
  for (Ring& hole : holes) {
    const Point2 inner = 0.5 * (hole[0] + hole[1]);
    JoinedPolygon* smallest = nullptr;
    for (JoinedPolygon& polygon : polygons) {
      if (!holds(polygon.outer, inner)) continue;
      if (!smallest || area_of_ring(polygon.outer) < area_of_ring(smallest->outer)) smallest = &polygon;
    }
    if (smallest) smallest->holes.push_back(std::move(hole));
  }
  return polygons;
}

}  // namespace vantage::internal::query
