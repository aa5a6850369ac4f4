// Ear clipping as in O'Rourke, Computational Geometry in C (2nd ed., 1998), section 1.6: an ear's tip is cut off and
// only its two neighbours are looked at again. Only reflex corners can lie in an ear, so only they are tested.
#include "io/triangulate_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace vantage::internal::io {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area of a triangle.
double doubled_area(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// How much a triangle must have of an ear before it is cut off. Each is tried when the one before finds nothing.
enum class Rule {
  proper,  ///< positive area, no corner in it or on its border
  flat,    ///< area may be zero, corners may lie on the border
};

class EarClipper {
 public:
  EarClipper(std::vector<Point> points, std::vector<std::array<std::uint32_t, 3>>& triangles)
      : points_(std::move(points)), triangles_(triangles), left_(points_.size()) {
    const auto n = static_cast<std::uint32_t>(points_.size());
    previous_.resize(n);
    next_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      previous_[i] = (i + n - 1) % n;
      next_[i] = (i + 1) % n;
    }
    gone_.assign(n, false);
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!convex(i)) reflex_.push_back(i);
    }
    std::sort(reflex_.begin(), reflex_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return points_[a].x() < points_[b].x(); });
  }

  void run() {
    // A simple polygon is done in one sweep. Several may be needed where corners coincide or lie on a line; one that
    // needs more crosses itself, and its remainder is cut into a fan.
    constexpr int kSweeps = 8;
    for (int sweep = 0; sweep < kSweeps && left_ > 3; ++sweep) {
      if (!clip_all(Rule::proper)) clip_one(Rule::flat);
    }
    while (left_ > 2) cut(next_[head()]);
  }

 private:
  bool convex(std::uint32_t i) const { return doubled_area(points_[previous_[i]], points_[i], points_[next_[i]]) > 0; }

  std::uint32_t head() const {
    std::uint32_t i = last_;
    while (gone_[i]) i = next_[i];
    return i;
  }

  bool is_ear(std::uint32_t i, Rule rule) const {
    const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
    const double area = doubled_area(a, b, c);
    if (rule == Rule::proper ? !(area > 0) : !(area >= 0)) return false;
    const double low = std::min({a.x(), b.x(), c.x()}), high = std::max({a.x(), b.x(), c.x()});
    auto blocker = std::lower_bound(reflex_.begin(), reflex_.end(), low,
                                    [&](std::uint32_t k, double x) { return points_[k].x() < x; });
    for (; blocker != reflex_.end() && points_[*blocker].x() <= high; ++blocker) {
      if (!gone_[*blocker] && blocks(*blocker, a, b, c, rule)) return false;
    }
    return true;
  }

  /// Whether corner `k` keeps the triangle from being an ear. One at the place of a corner of it does not: there the
  /// polygon touches itself, as it does where an edge joins a hole to the border.
  bool blocks(std::uint32_t k, const Point& a, const Point& b, const Point& c, Rule rule) const {
    const Point& p = points_[k];
    if (p == a || p == b || p == c || convex(k)) return false;
    const double ab = doubled_area(a, b, p), bc = doubled_area(b, c, p), ca = doubled_area(c, a, p);
    return rule == Rule::proper ? ab >= 0 && bc >= 0 && ca >= 0 : ab > 0 && bc > 0 && ca > 0;
  }

  void cut(std::uint32_t i) {
    triangles_.push_back({previous_[i], i, next_[i]});
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    gone_[i] = true;
    last_ = next_[i];
    --left_;
  }

  /// Cuts ears off until none is left. Returns whether there was one.
  bool clip_all(Rule rule) {
    std::vector<std::uint32_t> candidates;
    for (std::uint32_t i = 0, at = head(); i < left_; ++i, at = next_[at]) candidates.push_back(at);
    std::reverse(candidates.begin(), candidates.end());
    bool any = false;
    while (!candidates.empty() && left_ > 3) {
      const std::uint32_t i = candidates.back();
      candidates.pop_back();
      if (gone_[i] || !is_ear(i, rule)) continue;
      any = true;
      cut(i);
      candidates.push_back(previous_[i]);
      candidates.push_back(next_[i]);
    }
    return any;
  }

  bool clip_one(Rule rule) {
    for (std::uint32_t i = 0, at = head(); i < left_; ++i, at = next_[at]) {
      if (!is_ear(at, rule)) continue;
      cut(at);
      return true;
    }
    return false;
  }

  std::vector<Point> points_;
  std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::size_t left_;
  std::vector<std::uint32_t> previous_, next_;
  std::vector<std::uint32_t> reflex_;  // by x: corners that were not convex at the start
  std::vector<bool> gone_;
  std::uint32_t last_ = 0;
};

}  // namespace

std::vector<Point> project_polygon(const std::vector<Vec3>& points, std::size_t border) {
  const Vec3& origin = points[0];
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < border; ++i) {
    normal += (points[i] - origin).cross(points[(i + 1) % border] - origin);
  }
  int dropped = 0;
  normal.cwiseAbs().maxCoeff(&dropped);
  int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  if (normal[dropped] < 0) std::swap(u, v);

  std::vector<Point> flat;
  flat.reserve(points.size());
  for (const Vec3& point : points) flat.emplace_back(point[u] - origin[u], point[v] - origin[v]);
  return flat;
}

void triangulate_polygon(const std::vector<Vec3>& points, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (points.size() == 3) {
    triangles.push_back({0, 1, 2});
    return;
  }
  EarClipper(project_polygon(points, points.size()), triangles).run();
}

}  // namespace vantage::internal::io
