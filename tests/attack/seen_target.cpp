#include "seen_target.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace attack {
namespace {

using Eigen::Vector2d;

Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return sum;
}

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p - points[0];
  return points[0] + sum / static_cast<double>(points.size());
}

SeenTarget seen_point(const vantage::Target& target, double lift, const Vec3& origin) {
  SeenTarget seen;
  seen.normal = target.front ? target.front->normalized() : Vec3::UnitZ();
  seen.all_sides = !target.front;
  seen.corners = {target.parts[0][0] - origin + seen.normal * (target.offset_m + lift)};
  seen.centre = seen.corners[0];
  return seen;
}

/// Cuts away what lies farther than `distance` along the unit vector `outward`.
std::vector<Vector2d> cut(const std::vector<Vector2d>& polygon, const Vector2d& outward, double distance) {
  std::vector<Vector2d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double at_from = outward.dot(from) - distance, at_to = outward.dot(to) - distance;
    if (at_from <= 0) kept.push_back(from);
    if ((at_from < 0 && at_to > 0) || (at_from > 0 && at_to < 0))
      kept.emplace_back(from + at_from / (at_from - at_to) * (to - from));
  }
  return kept;
}

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - b.y()) - (b.y() - a.y()) * (c.x() - b.x());
}

/// The corners of the convex hull, counter-clockwise: without the dents that rounding makes of a round outline.
std::vector<Vector2d> hull_of(std::vector<Vector2d> points) {
  const auto before = [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

struct OuterLine {
  Vector2d outward;
  double distance;
};

/// The lines of the sides. All of a convex outline lies behind each of them, also behind that of a side that is too
/// short to tell its direction; and what is some way behind all of them is so far from the outline.
std::vector<OuterLine> outer_lines(const std::vector<Vector2d>& polygon) {
  std::vector<OuterLine> lines;
  const std::vector<Vector2d> hull = hull_of(polygon);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d along = hull[(i + 1) % hull.size()] - hull[i];
    if (!(along.norm() > 0)) continue;
    const Vector2d outward = Vector2d(along.y(), -along.x()).normalized();
    lines.push_back({outward, outward.dot(hull[i])});
  }
  return lines;
}

}  // namespace

SeenTarget make_seen_target(const vantage::Target& target, double lift, const Vec3& origin) {
  if (target.is_point()) return seen_point(target, lift, origin);
  SeenTarget seen;
  for (const Vec3& v : target.parts[0]) seen.corners.push_back(v - origin);
  const Vec3 own = area_vector(seen.corners).normalized();
  const bool turned = target.front ? own.dot(*target.front) < 0 : own.z() < -1e-6;
  seen.normal = turned ? Vec3(-own) : own;
  if (turned) std::reverse(seen.corners.begin(), seen.corners.end());
  const Vec3 centre = mean(seen.corners);
  for (Vec3& v : seen.corners) v += seen.normal * (target.offset_m + lift - seen.normal.dot(v - centre));
  seen.centre = mean(seen.corners);
  return seen;
}

SeenTarget moved_in(const SeenTarget& target, double margin, double rise) {
  SeenTarget moved = target;
  if (target.is_point()) {
    if (!target.all_sides) moved.corners[0] += rise * target.normal;
    moved.centre = moved.corners[0];
    return moved;
  }
  const Vec3 u = target.normal.unitOrthogonal(), v = target.normal.cross(u);
  std::vector<Vector2d> polygon;
  double reach = 0;
  for (const Vec3& p : target.corners) {
    polygon.emplace_back(u.dot(p - target.centre), v.dot(p - target.centre));
    reach = std::max(reach, polygon.back().norm());
  }
  std::vector<Vector2d> inner = polygon;
  if (margin < 0)
    inner = {{-3 * reach, -3 * reach}, {3 * reach, -3 * reach}, {3 * reach, 3 * reach}, {-3 * reach, 3 * reach}};
  for (const OuterLine& line : outer_lines(polygon)) inner = cut(inner, line.outward, line.distance - margin);
  moved.corners.clear();
  for (const Vector2d& p : inner) moved.corners.push_back(target.centre + u * p.x() + v * p.y() + target.normal * rise);
  if (!moved.corners.empty()) moved.centre = mean(moved.corners);
  return moved;
}

// The farthest corner is a convex function of the place: least along x of the least along y.
double enclosing_radius(const SeenTarget& target) {
  const Vec3 u = target.normal.unitOrthogonal(), v = target.normal.cross(u);
  const auto farthest = [&](double x, double y) {
    double most = 0;
    for (const Vec3& p : target.corners) most = std::max(most, (p - target.centre - x * u - y * v).norm());
    return most;
  };
  const double reach = farthest(0, 0);
  const auto least_over = [reach](auto&& value) {
    double low = -reach, high = reach;
    for (int step = 0; step < 90; ++step) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (value(a) < value(b) ? high : low) = value(a) < value(b) ? b : a;
    }
    return value(0.5 * (low + high));
  };
  return least_over([&](double x) { return least_over([&](double y) { return farthest(x, y); }); });
}

}  // namespace attack
