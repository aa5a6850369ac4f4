#include "separation.h"

#include <algorithm>

namespace attack {
namespace {

/// Signs of points on the two sides of a plane, as they come in.
class Sides {
 public:
  Sides(const Vec3& a, const Vec3& b, const Vec3& c) : a_(a), b_(b), c_(c) {}

  int sign(const Vec3& point) const { return orientation(a_, b_, c_, point); }

  /// The side that the points are on: 1 or -1; 0 where they are all in the plane; nothing (2) where they are on both.
  int side(std::span<const Vec3> points) const {
    int side = 0;
    for (const Vec3& p : points) {
      const int s = sign(p);
      if (s == 0) continue;
      if (side == -s) return 2;
      side = s;
    }
    return side;
  }

 private:
  const Vec3 &a_, &b_, &c_;
};

// The plane through a, b and c has the hull on one side and the triangle on the other. A triple on one line has all
// points at 0, and separates nothing.
bool separates(const Vec3& a, const Vec3& b, const Vec3& c, std::span<const Vec3> hull, const Corners& triangle) {
  const Sides plane(a, b, c);
  const int of_triangle = plane.side(triangle);
  if (of_triangle == 2) return false;
  const int of_hull = plane.side(hull);
  return of_hull != 2 && of_hull != 0 && of_hull != of_triangle;
}

bool boxes_apart(std::span<const Vec3> hull, const Corners& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    double low = hull[0][axis], high = low;
    for (const Vec3& p : hull) {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    const auto [least, most] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (least >= high || most <= low) return true;
  }
  return false;
}

bool flat(std::span<const Vec3> points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k)
        if (orientation(points[0], points[i], points[j], points[k]) != 0) return false;
    }
  }
  return true;
}

}  // namespace

bool interior_misses(std::span<const Vec3> points, const Corners& triangle) {
  if (boxes_apart(points, triangle)) return true;
  const auto& [u, v, w] = triangle;
  if (Sides(u, v, w).side(points) != 2) return true;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (const Vec3& corner : triangle)
        if (separates(points[i], points[j], corner, points, triangle)) return true;
    }
  }
  for (const Vec3& p : points) {
    for (int k = 0; k < 3; ++k)
      if (separates(triangle[k], triangle[(k + 1) % 3], p, points, triangle)) return true;
  }
  return flat(points);
}

bool hull_of_two_misses(std::span<const Vec3> points, const Corners& triangle, SeparatingPlane& last) {
  const auto works = [&](const SeparatingPlane& p) {
    if (p.by_side) return separates(triangle[p.first], triangle[p.second], points[p.third], points, triangle);
    return separates(points[p.first], points[p.second], triangle[p.third], points, triangle);
  };
  const int n = static_cast<int>(points.size());
  if (last.first >= 0 && std::max({last.first, last.second, last.third}) < n && works(last)) return true;
  const auto try_plane = [&](int first, int second, int third, bool by_side) {
    const SeparatingPlane plane{first, second, third, by_side};
    if (!works(plane)) return false;
    last = plane;
    return true;
  };
  const auto try_edge = [&](int i, int j) {
    return try_plane(i, j, 0, false) || try_plane(i, j, 1, false) || try_plane(i, j, 2, false);
  };
  for (int i = 0; i < 3; ++i)
    if (try_edge(i, (i + 1) % 3)) return true;
  for (int k = 3; k < n; ++k)
    if (try_edge(k, k + 1 < n ? k + 1 : 3)) return true;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k)
      if (try_plane(k, (k + 1) % 3, i, true)) return true;
  }
  for (int i = 0; i < 3; ++i) {
    for (int k = 3; k < n; ++k)
      if (try_edge(i, k)) return true;
  }
  return false;
}

bool segment_crosses(const Vec3& from, const Vec3& to, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const int start = orientation(a, b, c, from), end = orientation(a, b, c, to);
  if (start * end >= 0) return false;
  const int ab = orientation(from, to, a, b), bc = orientation(from, to, b, c), ca = orientation(from, to, c, a);
  return ab != 0 && ab == bc && bc == ca;
}

}  // namespace attack
