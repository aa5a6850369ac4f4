#include "simplify/exact.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/orientation.h"

namespace vantage::internal::simplify {
namespace {

using core::orientation;

/// Points of one plane, projected to a coordinate plane that the plane is not upright on: how three of them turn there.
class PlaneView {
 public:
  explicit PlaneView(const Corners& triangle) {
    for (int dropped = 0; dropped < 3; ++dropped) {
      first_ = (dropped + 1) % 3;
      second_ = (dropped + 2) % 3;
      if (turn(triangle[0], triangle[1], triangle[2]) != 0) return;
    }
  }

  int turn(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return core::turn({a[first_], a[second_]}, {b[first_], b[second_]}, {c[first_], c[second_]});
  }

  /// Whether the box of one has a point with the box of the other.
  bool boxes_meet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    for (const int axis : {first_, second_}) {
      if (std::max(a[axis], b[axis]) < std::min(c[axis], d[axis])) return false;
      if (std::max(c[axis], d[axis]) < std::min(a[axis], b[axis])) return false;
    }
    return true;
  }

 private:
  int first_ = 0, second_ = 1;
};

bool meet_in_plane(const Vec3& start, const Vec3& end, const Corners& triangle) {
  const PlaneView view(triangle);
  const int way = view.turn(triangle[0], triangle[1], triangle[2]);
  if (way == 0) return true;  // a triangle without an area: to be on the safe side
  const auto holds = [&](const Vec3& point) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (view.turn(triangle[i], triangle[(i + 1) % 3], point) == -way) return false;
    }
    return true;
  };
  if (holds(start) || holds(end)) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (!view.boxes_meet(start, end, a, b)) continue;
    if (view.turn(start, end, a) * view.turn(start, end, b) > 0) continue;
    if (view.turn(a, b, start) * view.turn(a, b, end) <= 0) return true;
  }
  return false;
}

}  // namespace

int side_of(const Corners& facet, const Vec3& point) { return orientation(facet[0], facet[1], facet[2], point); }

bool meet(const Vec3& start, const Vec3& end, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const int of_start = orientation(a, b, c, start), of_end = orientation(a, b, c, end);
  if (of_start == 0 && of_end == 0) return meet_in_plane(start, end, triangle);
  if (of_start * of_end > 0) return false;
  const int ab = orientation(start, end, a, b), bc = orientation(start, end, b, c), ca = orientation(start, end, c, a);
  const bool has_positive = ab > 0 || bc > 0 || ca > 0, has_negative = ab < 0 || bc < 0 || ca < 0;
  return !(has_positive && has_negative);
}

bool is_folded(const Vec3& start, const Vec3& end, const Vec3& third, const Vec3& other_third) {
  if (orientation(start, end, third, other_third) != 0) return false;
  const PlaneView view({start, end, third});
  return view.turn(start, end, third) * view.turn(start, end, other_third) >= 0;
}

}  // namespace vantage::internal::simplify
