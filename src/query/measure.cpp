#include "query/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage::internal::query {
namespace {

/// Corners that rounding puts beside the camera, or behind it, count as this far in front, in parts of their distance.
constexpr double kLeastDepth = 1e-9;

/// From so many radii of the target on, the axis through its centre is as good: it changes fractions by 1e-12.
constexpr double kFar = 1e6;

/// Keeps what is divided by in the solid angle of a target that is seen from its own plane, but for nothing.
constexpr double kLeastHeight = 1e-150;

/// A chord: directions this near to the border of a cone about `axis` are in it.
constexpr double kOnCone = 1e-14;

bool is_in_cone(const Vec3& axis, double chord, const Vec3& direction) {
  return (direction - axis).norm() <= chord + kOnCone;
}

}  // namespace

Vec3 narrowest_cone_axis(std::span<const Vec3> directions) {
  Vec3 axis = directions[0];
  double chord = 0;
  const auto take = [&](const Vec3& sum, const Vec3& on_border) {
    if (!(sum.squaredNorm() > 0)) return;
    axis = sum.normalized();
    chord = (on_border - axis).norm();
  };
  for (std::size_t i = 1; i < directions.size(); ++i) {
    const Vec3& a = directions[i];
    if (is_in_cone(axis, chord, a)) continue;
    take(a, a);
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3& b = directions[j];
      if (is_in_cone(axis, chord, b)) continue;
      take(a + b, a);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3& c = directions[k];
        if (is_in_cone(axis, chord, c)) continue;
        const Vec3 normal = (b - a).cross(c - a);
        take(normal.dot(a) < 0 ? Vec3(-normal) : normal, a);
      }
    }
  }
  return axis;
}

Measure::Measure(FractionMeasure measure, std::span<const Point2> target, const Vec3& eye)
    : measure_(measure), eye_(eye.x(), eye.y(), std::max(eye.z(), kLeastHeight)), axis_(Vec3::Zero()) {
  if (measure != FractionMeasure::pixels) return;
  double radius = 0;
  for (const Point2& t : target) radius = std::max(radius, t.norm());
  if (eye.norm() > kFar * radius) {
    axis_ = -eye.normalized();
    return;
  }
  std::vector<Vec3> directions;
  for (const Point2& t : target) directions.push_back((Vec3(t.x(), t.y(), 0) - eye_).normalized());
  axis_ = narrowest_cone_axis(directions);
}

double Measure::of(std::span<const Point2> polygon) const {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) sum += of_triangle(polygon[0], polygon[i], polygon[i + 1]);
  return sum;
}

double Measure::of_triangle(const Point2& a, const Point2& b, const Point2& c) const {
  const Point2 ab = b - a, ac = c - a;
  const double twice_area = std::max(0.0, ab.x() * ac.y() - ab.y() * ac.x());
  if (measure_ == FractionMeasure::area) return 0.5 * twice_area;
  const Vec3 u = Vec3(a.x(), a.y(), 0) - eye_, v = Vec3(b.x(), b.y(), 0) - eye_, w = Vec3(c.x(), c.y(), 0) - eye_;
  const double nu = u.norm(), nv = v.norm(), nw = w.norm();
  if (measure_ == FractionMeasure::solid_angle) {
    // Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983. The numerator is the triple product.
    const double volume = twice_area * eye_.z();
    return 2 * std::atan2(volume, nu * nv * nw + u.dot(v) * nw + u.dot(w) * nv + v.dot(w) * nu);
  }
  // In the image a corner is divided by its depth, and the triple product of three by all their depths.
  const auto depth = [&](const Vec3& corner, double distance) {
    return std::max(axis_.dot(corner), kLeastDepth * distance);
  };
  return 0.5 * twice_area * eye_.z() / depth(u, nu) / depth(v, nv) / depth(w, nw);
}

}  // namespace vantage::internal::query
