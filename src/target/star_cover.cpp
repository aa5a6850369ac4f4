#include "target/star_cover.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/enclosing_circle.h"
#include "target/clean_outline.h"
#include "target/equal_cells.h"

namespace vantage::internal::target {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

constexpr std::size_t kMostParts = 64;
constexpr double kLeastClearance = 1e-2;  // of the centre, in parts of the farthest corner's distance from it

/// Keeps what has outward . x <= at. `outward` has length 1.
struct Side {
  Vector2d outward;
  double at;

  double outside(const Vector2d& point) const { return outward.dot(point) - at; }
};

struct Segment {
  Vector2d from, to;
};

Side side_along(const Vector2d& from, const Vector2d& to) {
  const Vector2d along = (to - from).normalized();
  const Vector2d outward(along.y(), -along.x());
  return {outward, outward.dot(from)};
}

std::vector<Side> sides_of(const Polygon& polygon) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sides.push_back(side_along(polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return sides;
}

/// Of the farthest side; negative inside.
double outside_of(const std::vector<Side>& sides, const Vector2d& point) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Side& side : sides) most = std::max(most, side.outside(point));
  return most;
}

class StarCoverer {
 public:
  explicit StarCoverer(const std::vector<Polygon>& parts) : parts_(parts) {
    for (const Polygon& part : parts) {
      for (const Vector2d& corner : part) extent_ = std::max(extent_, corner.cwiseAbs().maxCoeff());
    }
    near_ = kMostStarGrowth * extent_;
  }

  std::optional<StarCover> run() {
    for (std::size_t i = 0; i < parts_.size(); ++i) find_outline(i);
    const Polygon kernel = kernel_of_outline();
    if (kernel.size() < 3 || !(area_of(kernel) > 0)) return std::nullopt;
    StarCover cover{core::centroid(kernel), {}, {}};
    Polygon corners;
    for (const Polygon& part : parts_) {
      std::optional<Polygon> hull = hull_with_kernel(part, kernel);
      if (!hull || !lies_within_outline(*hull)) return std::nullopt;
      corners.insert(corners.end(), hull->begin(), hull->end());
      cover.polygons.push_back(*std::move(hull));
    }
    std::optional<Polygon> hull = hull_of(std::move(corners));
    if (!hull) return std::nullopt;
    cover.hull = *std::move(hull);
    join(cover.polygons);
    return is_clear(cover) ? std::optional(std::move(cover)) : std::nullopt;
  }

 private:
  void find_outline(std::size_t part);
  Polygon kernel_of_outline() const;
  std::optional<Polygon> hull_of(Polygon points) const;
  std::optional<Polygon> hull_with_kernel(const Polygon& part, const Polygon& kernel) const;
  bool lies_within_outline(const Polygon& hull) const;
  void join(std::vector<Polygon>& polygons) const;
  bool is_clear(const StarCover& cover) const;

  const std::vector<Polygon>& parts_;
  double extent_ = 0, near_ = 0;
  std::vector<Segment> outline_;
};

/// What of a part's edges no other part lies against.
void StarCoverer::find_outline(std::size_t part) {
  const Polygon& polygon = parts_[part];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double length = (to - from).norm();
    if (!(length > near_)) continue;
    const Side side = side_along(from, to);
    const Vector2d along = (to - from) / length;
    std::vector<std::pair<double, double>> covered;
    for (std::size_t other = 0; other < parts_.size(); ++other) {
      if (other == part) continue;
      const Polygon& beside = parts_[other];
      for (std::size_t k = 0; k < beside.size(); ++k) {
        const Vector2d &a = beside[k], &b = beside[(k + 1) % beside.size()];
        if (std::abs(side.outside(a)) > near_ || std::abs(side.outside(b)) > near_) continue;
        const double begin = along.dot(b - from), end = along.dot(a - from);  // it runs the other way
        if (begin < end) covered.emplace_back(begin, end);
      }
    }
    std::sort(covered.begin(), covered.end());
    double open = 0;
    covered.emplace_back(length, length);
    for (const auto& [begin, end] : covered) {
      if (std::min(begin, length) - open > near_) {
        outline_.push_back({from + open * along, from + std::min(begin, length) * along});
      }
      open = std::max(open, end);
    }
  }
}

/// The points that see all of the outline from inside.
Polygon StarCoverer::kernel_of_outline() const {
  const double far = 2 * extent_;
  Polygon kernel{{-far, -far}, {far, -far}, {far, far}, {-far, far}}, part;
  for (const Segment& segment : outline_) {
    const Side side = side_along(segment.from, segment.to);
    part.clear();
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      const Vector2d &here = kernel[i], &next = kernel[(i + 1) % kernel.size()];
      const double a = side.outside(here), b = side.outside(next);
      if (a <= 0) part.push_back(here);
      if ((a < 0 && b > 0) || (a > 0 && b < 0)) part.push_back(here + a / (a - b) * (next - here));
    }
    kernel.swap(part);
    if (kernel.empty()) break;
  }
  return kernel;
}

/// The convex hull of points, by Andrew's monotone chain (1979), without short edges.
std::optional<Polygon> StarCoverer::hull_of(Polygon points) const {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Polygon hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (; begin != end; ++begin) {
      while (hull.size() >= first + 2) {
        const Vector2d &a = hull[hull.size() - 2], &b = hull.back();
        if (cross(b - a, *begin - b) > 0) break;
        hull.pop_back();
      }
      hull.push_back(*begin);
    }
    hull.pop_back();  // where the other chain begins
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  if (hull.size() < 3) return std::nullopt;
  hull = cleaned_outline(std::move(hull), extent_);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (!((hull[(i + 1) % hull.size()] - hull[i]).norm() > near_)) return std::nullopt;
  }
  return hull;
}

/// The convex hull of a part and the kernel, of which corners on the part play no role.
std::optional<Polygon> StarCoverer::hull_with_kernel(const Polygon& part, const Polygon& kernel) const {
  const std::vector<Side> sides = sides_of(part);
  Polygon points = part;
  for (const Vector2d& point : kernel) {
    if (outside_of(sides, point) > near_) points.push_back(point);
  }
  return hull_of(std::move(points));
}

/// Whether the outline nowhere comes farther into a hull than kMostStarGrowth.
bool StarCoverer::lies_within_outline(const Polygon& hull) const {
  const std::vector<Side> sides = sides_of(hull);
  return std::none_of(outline_.begin(), outline_.end(), [&](const Segment& segment) {
    double begin = 0, end = 1;
    for (const Side& side : sides) {
      const double a = side.outside(segment.from) + near_, b = side.outside(segment.to) + near_;
      if (a >= 0 && b >= 0) return false;
      if (a > 0) begin = std::max(begin, a / (a - b));
      if (b > 0) end = std::min(end, a / (a - b));
    }
    return begin < end;
  });
}

/// The fewer they are the less each scene polygon costs.
void StarCoverer::join(std::vector<Polygon>& polygons) const {
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for (std::size_t k = i + 1; k < polygons.size();) {
      Polygon both = polygons[i];
      both.insert(both.end(), polygons[k].begin(), polygons[k].end());
      std::optional<Polygon> hull = hull_of(std::move(both));
      if (!hull || !lies_within_outline(*hull)) {
        ++k;
        continue;
      }
      polygons[i] = *std::move(hull);
      polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;
    }
  }
}

bool StarCoverer::is_clear(const StarCover& cover) const {
  double farthest = 0, clearance = std::numeric_limits<double>::infinity();
  for (const Polygon& polygon : cover.polygons) {
    for (const Vector2d& corner : polygon) farthest = std::max(farthest, (corner - cover.centre).norm());
    clearance = std::min(clearance, -outside_of(sides_of(polygon), cover.centre));
  }
  return clearance >= kLeastClearance * farthest;
}

}  // namespace

std::optional<StarCover> star_cover(const std::vector<Polygon>& parts) {
  if (parts.size() > kMostParts) return std::nullopt;
  return StarCoverer(parts).run();
}

}  // namespace vantage::internal::target
