#include "core/triangle_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vantage::internal::core {
namespace {

using Corners = std::array<Vec3, 3>;

/// The unit normal, or zero for a triangle narrower than `distance`.
Vec3 unit_normal(const Corners& t, double distance) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double twice_area = normal.norm();
  const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  if (!(twice_area > longest * distance)) return Vec3::Zero();
  return normal / twice_area;
}

/// Signed distances of a triangle's corners from a plane, those within `distance` of it set to zero.
struct Heights {
  std::array<double, 3> of;
  bool above = false, below = false;

  Heights(const Corners& t, const Vec3& normal, const Vec3& on_plane, double distance) {
    for (int i = 0; i < 3; ++i) {
      const double height = normal.dot(t[i] - on_plane);
      of[i] = std::abs(height) <= distance ? 0 : height;
      above = above || of[i] > 0;
      below = below || of[i] < 0;
    }
  }

  bool one_sided() const {
    return (above || below) && std::all_of(of.begin(), of.end(), [](double h) { return h != 0; }) && !(above && below);
  }
  bool flat() const { return !above && !below; }
  bool both_sides() const { return above && below; }
};

/// Where a triangle meets a plane, as an interval along `direction`.
struct Interval {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();

  Interval(const Corners& t, const Heights& heights, const Vec3& direction, const Vec3& origin) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double hi = heights.of[i], hj = heights.of[j];
      if (hi == 0) add(direction.dot(t[i] - origin));
      if (hi * hj < 0) add(direction.dot(t[i] + (t[j] - t[i]) * (hi / (hi - hj)) - origin));
    }
  }

  void add(double at) {
    from = std::min(from, at);
    to = std::max(to, at);
  }
};

/// Whether an edge of `a` separates two triangles in one plane, give or take `distance`.
bool separated_by_an_edge(const Corners& a, const Corners& b, const Vec3& normal_of_a, double distance) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 outward = (a[(i + 1) % 3] - a[i]).cross(normal_of_a).normalized();
    const auto beyond = [&](const Vec3& corner) { return outward.dot(corner - a[i]) >= -distance; };
    if (std::all_of(b.begin(), b.end(), beyond)) return true;
  }
  return false;
}

}  // namespace

Contact contact_of(const Corners& a, const Corners& b, int shared, double distance) {
  const Vec3 normal_a = unit_normal(a, distance), normal_b = unit_normal(b, distance);
  if (normal_a.isZero(0) || normal_b.isZero(0)) return Contact::none;
  const Heights heights_b(b, normal_a, a[0], distance), heights_a(a, normal_b, b[0], distance);
  if (heights_b.one_sided() || heights_a.one_sided()) return Contact::none;
  if (heights_b.flat() || heights_a.flat()) {
    const bool apart = separated_by_an_edge(a, b, normal_a, distance) || separated_by_an_edge(b, a, normal_b, distance);
    return apart ? Contact::none : Contact::touching;
  }
  const Vec3 direction = normal_a.cross(normal_b).normalized();
  const Interval along_a(a, heights_a, direction, a[0]), along_b(b, heights_b, direction, a[0]);
  const double length = std::min(along_a.to, along_b.to) - std::max(along_a.from, along_b.from);
  if (length <= distance) return Contact::none;
  if (heights_a.both_sides() && heights_b.both_sides()) return Contact::crossing;
  return shared >= 2 ? Contact::none : Contact::touching;
}

bool may_touch(const Corners& triangle, const Box& box) {
  const Vec3 centre = (box.min + box.max) / 2, half = (box.max - box.min) / 2;
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = triangle[k] - centre;
  const auto separates = [&](const Vec3& axis) {
    const double a = axis.dot(corners[0]), b = axis.dot(corners[1]), c = axis.dot(corners[2]);
    const double reach = half.dot(axis.cwiseAbs());
    constexpr double kRounding = 1e-12;
    const double slack = kRounding * (std::abs(a) + std::abs(b) + std::abs(c) + reach);
    return std::min({a, b, c}) > reach + slack || std::max({a, b, c}) < -reach - slack;
  };
  const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[1], w = corners[0] - corners[2];
  if (separates(u.cross(v))) return false;
  for (const Vec3& side : {u, v, w}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (separates(side.cross(Vec3::Unit(axis)))) return false;
    }
  }
  return true;
}

}  // namespace vantage::internal::core
