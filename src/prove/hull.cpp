#include "prove/hull.h"

#include <Eigen/Geometry>
#include <limits>

namespace vantage::internal::prove {
namespace {

/// Up to four points of the difference of two sets, and what is nearest to the origin of their hull.
class Simplex {
 public:
  Simplex() { points_.fill(Vec3::Zero()); }
  void add(const Vec3& point) { points_[count_++] = point; }
  std::size_t count() const { return count_; }
  bool holds(const Vec3& point) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (points_[i] == point) return true;
    }
    return false;
  }
  /// Keeps the points whose hull has the nearest point, and returns that (Ericson 2005, chapter 5). Zero where the
  /// origin is inside.
  Vec3 reduce_to_nearest() {
    if (count_ == 1) return points_[0];
    if (count_ == 2) return nearest_of_segment();
    if (count_ == 3) return nearest_of_triangle(points_[0], points_[1], points_[2]);
    return nearest_of_tetrahedron();
  }

 private:
  void keep(const Vec3& a) {
    points_[0] = a;
    count_ = 1;
  }
  void keep(const Vec3& a, const Vec3& b) {
    keep(a);
    points_[1] = b;
    count_ = 2;
  }
  void keep(const Vec3& a, const Vec3& b, const Vec3& c) {
    keep(a, b);
    points_[2] = c;
    count_ = 3;
  }
  Vec3 only(const Vec3& a) {
    keep(a);
    return a;
  }
  /// The point at a part of the way from one to the other.
  Vec3 between(const Vec3& a, const Vec3& b, double part) {
    keep(a, b);
    return a + part * (b - a);
  }

  Vec3 nearest_of_segment() {
    const Vec3 a = points_[0], b = points_[1], ab = b - a;
    const double along = -a.dot(ab), length = ab.squaredNorm();
    if (!(along > 0)) return only(a);
    if (along >= length) return only(b);
    return a + along / length * ab;
  }

  Vec3 nearest_of_triangle(const Vec3& first, const Vec3& second, const Vec3& third) {
    const Vec3 a = first, b = second, c = third;  // copies: they may be the points that are replaced
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a), d3 = -ab.dot(b), d4 = -ac.dot(b), d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d1 <= 0 && d2 <= 0) return only(a);
    if (d3 >= 0 && d4 <= d3) return only(b);
    if (d6 >= 0 && d5 <= d6) return only(c);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return between(a, b, d1 / (d1 - d3));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return between(a, c, d2 / (d2 - d6));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return between(b, c, (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    keep(a, b, c);
    // Along the normal: sums of the corners would lose what is left of them.
    const Vec3 normal = ab.cross(ac);
    return normal.dot(a) / normal.squaredNorm() * normal;
  }

  Vec3 nearest_of_tetrahedron() {
    const std::array<Vec3, 4> p = points_;
    constexpr std::array<std::array<std::size_t, 4>, 4> kFaces = {
        {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}}};
    double best = std::numeric_limits<double>::infinity();
    Simplex nearest;
    Vec3 result = Vec3::Zero();
    for (const auto& [i, j, k, other] : kFaces) {
      const Vec3 normal = (p[j] - p[i]).cross(p[k] - p[i]);
      const double side = normal.dot(p[other] - p[i]), origin = -normal.dot(p[i]);
      if (side * origin > 0) continue;  // on the same side as the fourth corner
      Simplex face;
      const Vec3 point = face.nearest_of_triangle(p[i], p[j], p[k]);
      if (point.squaredNorm() < best) {
        best = point.squaredNorm();
        nearest = face;
        result = point;
      }
    }
    if (best < std::numeric_limits<double>::infinity()) *this = nearest;
    return result;
  }

  std::array<Vec3, 4> points_;
  std::size_t count_ = 0;
};

}  // namespace

Vec3 PointHull::lowest(const Vec3& direction) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double along = direction.x() * x_[i] + direction.y() * y_[i] + direction.z() * z_[i];
    if (along < least) {
      least = along;
      best = i;
    }
  }
  return {x_[best], y_[best], z_[best]};
}

std::optional<Vec3> separate(const PointHull& hull, const Obstacle& obstacle, double largest) {
  constexpr int kMostSteps = 40;
  Vec3 way = hull.lowest(Vec3::Zero()) - obstacle.middle();
  Simplex simplex;
  for (int step = 0; step < kMostSteps; ++step) {
    const double length = way.norm();
    if (!(length > 0)) return std::nullopt;
    way /= length;
    const Vec3 nearest = hull.lowest(way) - obstacle.highest(way);
    if (way.dot(nearest) > unsure_along(way, largest)) return way;
    if (simplex.count() == 4 || simplex.holds(nearest)) return std::nullopt;
    simplex.add(nearest);
    way = simplex.reduce_to_nearest();
  }
  return std::nullopt;
}

}  // namespace vantage::internal::prove
