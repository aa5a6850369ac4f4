#include "verify/seen_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage::internal::verify {
namespace {

using Eigen::Vector2d;
using Bounds = Eigen::AlignedBox2d;

/// A part of the area of the whole polygon: smaller pieces are rounding.
constexpr double kNothing = 1e-16;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Bounds bounds_of(const FlatPolygon& polygon) {
  Bounds bounds;
  for (const Vector2d& p : polygon) bounds.extend(p);
  return bounds;
}

/// Cuts a convex polygon in two along a line; one of them may be empty.
struct Halves {
  FlatPolygon left, right;
};

Halves split(const FlatPolygon& polygon, const Vector2d& from, const Vector2d& to) {
  Halves halves;
  const Vector2d along = (to - from).normalized();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const double a = cross(along, here - from), b = cross(along, next - from);
    if (a >= 0) halves.left.push_back(here);
    if (a <= 0) halves.right.push_back(here);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      const Vector2d meeting = here + a / (a - b) * (next - here);
      halves.left.push_back(meeting);
      halves.right.push_back(meeting);
    }
  }
  return halves;
}

struct Piece {
  FlatPolygon polygon;
  Bounds bounds;
};

/// What a shadow, counter-clockwise, leaves of a piece is added to `left`: all of it where they do not meet.
void take_away(const Piece& piece, const FlatPolygon& shadow, double nothing, std::vector<Piece>& left) {
  const std::size_t before = left.size();
  FlatPolygon rest = piece.polygon;
  for (std::size_t i = 0; i < shadow.size(); ++i) {
    const Vector2d &from = shadow[i], &to = shadow[(i + 1) % shadow.size()];
    if (!((to - from).norm() > 0)) continue;
    Halves halves = split(rest, from, to);
    if (area_of(halves.left) <= nothing) {
      left.resize(before);
      left.push_back(piece);
      return;
    }
    if (area_of(halves.right) > nothing) {
      const Bounds bounds = bounds_of(halves.right);
      left.push_back({std::move(halves.right), bounds});
    }
    rest = std::move(halves.left);
  }
}

}  // namespace

double area_of(const FlatPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return 0.5 * twice;
}

PlaneAxes::PlaneAxes(const TargetView& view)
    : centre_(view.centre()),
      u_((view.vertices()[1] - view.vertices()[0]).normalized()),
      v_(view.normal().cross(u_).normalized()) {}

FlatPolygon PlaneAxes::flat(std::span<const Vec3> corners) const {
  FlatPolygon polygon;
  for (const Vec3& corner : corners) polygon.emplace_back(u_.dot(corner - centre_), v_.dot(corner - centre_));
  return polygon;
}

double area_left(const FlatPolygon& polygon, std::vector<FlatPolygon> shadows) {
  const double nothing = kNothing * area_of(polygon);
  for (FlatPolygon& shadow : shadows) {
    if (area_of(shadow) < 0) std::reverse(shadow.begin(), shadow.end());
  }
  std::stable_sort(shadows.begin(), shadows.end(),
                   [](const FlatPolygon& a, const FlatPolygon& b) { return area_of(a) > area_of(b); });
  std::vector<Piece> pieces = {{polygon, bounds_of(polygon)}}, left;
  for (const FlatPolygon& shadow : shadows) {
    if (!(area_of(shadow) > nothing)) break;
    const Bounds bounds = bounds_of(shadow);
    left.clear();
    for (const Piece& piece : pieces) {
      if (bounds.intersects(piece.bounds)) {
        take_away(piece, shadow, nothing, left);
      } else {
        left.push_back(piece);
      }
    }
    pieces.swap(left);
    if (pieces.empty()) break;
  }
  double area = 0;
  for (const Piece& piece : pieces) area += area_of(piece.polygon);
  return area;
}

}  // namespace vantage::internal::verify
