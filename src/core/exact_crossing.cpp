// Where the ray meets an edge, or a triangle that stands upright, it is taken to start beside the point: farther east
// by an infinitely small step, and farther north by a much smaller one (simulation of simplicity, Edelsbrunner and
// Muecke 1990). The point is on no triangle then, so that this changes nothing.
#include "core/exact_crossing.h"

#include <cstddef>

#include "core/orientation.h"

namespace vantage::internal::core {
namespace {

using PlanPoint = Eigen::Vector2d;

bool is_in_box(const Vec3& point, const Vec3& a, const Vec3& b) {
  return (point.array() >= a.cwiseMin(b).array()).all() && (point.array() <= a.cwiseMax(b).array()).all();
}

/// As seen along an axis.
PlanPoint flat(const Vec3& point, int axis) { return {point[(axis + 1) % 3], point[(axis + 2) % 3]}; }

int turn_along(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  return turn(flat(a, axis), flat(b, axis), flat(c, axis));
}

bool is_on_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  if (!is_in_box(point, a, b)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (turn_along(a, b, point, axis) != 0) return false;
  }
  return true;
}

/// In plan, of a point that is moved a little to the east and even less to the north; never 0 where a and b differ.
int turn_beside(const Vec3& a, const Vec3& b, const Vec3& point) {
  const int way = turn(a.head<2>(), b.head<2>(), point.head<2>());
  if (way != 0) return way;
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  return b.x() > a.x() ? 1 : b.x() < a.x() ? -1 : 0;
}

}  // namespace

bool is_on_triangle(const Vec3& point, const TriangleCorners& t) {
  if (orientation(t[0], t[1], t[2], point) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int way = turn_along(t[0], t[1], t[2], axis);
    if (way == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (turn_along(t[i], t[(i + 1) % 3], point, axis) == -way) return false;
    }
    return true;
  }
  return is_on_segment(point, t[0], t[1]) || is_on_segment(point, t[1], t[2]) || is_on_segment(point, t[2], t[0]);
}

int crossing_above(const Vec3& point, const TriangleCorners& t) {
  const int way = turn_beside(t[0], t[1], point);
  if (way == 0 || turn_beside(t[1], t[2], point) != way || turn_beside(t[2], t[0], point) != way) return 0;
  // Seen from below the corners of a triangle that faces up run clockwise.
  return orientation(t[0], t[1], t[2], point) == way ? way : 0;
}

}  // namespace vantage::internal::core
