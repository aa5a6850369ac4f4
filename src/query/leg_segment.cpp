#include "query/leg_segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace vantage::internal::query {
namespace {

double share_next_to(const Vec3& from, const Vec3& along, const Vec3& point) {
  const double length = along.squaredNorm();
  return length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
}

void take_pair(NearestPair& nearest, double share, const Vec3& on_segment, const Vec3& point) {
  const double squared = (on_segment - point).squaredNorm();
  if (squared < nearest.squared_distance) nearest = {squared, share, point};
}

/// The nearest pair of two segments has an end of one of them, or lies inside both: then it is square to both.
void take_edge(NearestPair& nearest, const Vec3& from, const Vec3& along, const Vec3& a, const Vec3& edge) {
  for (const double share : {0.0, 1.0}) {
    const Vec3 end = from + share * along;
    take_pair(nearest, share, end, a + share_next_to(a, edge, end) * edge);
  }
  for (const double at : {0.0, 1.0}) {
    const Vec3 corner = a + at * edge;
    const double share = share_next_to(from, along, corner);
    take_pair(nearest, share, from + share * along, corner);
  }
  const Vec3 across = along.cross(edge), gap = a - from;
  const double square = across.squaredNorm();
  if (!(square > 0)) return;
  const double share = gap.cross(edge).dot(across) / square, at = gap.cross(along).dot(across) / square;
  if (!(share > 0 && share < 1 && at > 0 && at < 1)) return;
  // Once more to the foot on each: of segments that are nearly parallel the shares are uncertain.
  const Vec3 on_edge = a + at * edge;
  const double own = share_next_to(from, along, on_edge);
  const Vec3 on_segment = from + own * along;
  take_pair(nearest, own, on_segment, a + share_next_to(a, edge, on_segment) * edge);
}

}  // namespace

NearestPair nearest_to_polygon(const Vec3& from, const Vec3& to, std::span<const Vec3> corners) {
  const Vec3 along = to - from;
  NearestPair nearest{INFINITY, 0, corners[0]};
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    take_edge(nearest, from, along, a, b - a);
    if (i > 0) normal += (a - corners[0]).cross(b - corners[0]);
  }
  if (!(normal.squaredNorm() > 0)) return nearest;
  normal.normalize();
  const auto is_over = [&](const Vec3& point) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3& a = corners[i];
      const Vec3 edge = corners[(i + 1) % corners.size()] - a;
      if (normal.cross(edge).dot(point - a) < 0) return false;
    }
    return true;
  };
  const double at_from = normal.dot(from - corners[0]), at_to = normal.dot(to - corners[0]);
  const auto take_foot = [&](double share, double height) {
    const Vec3 point = from + share * along;
    if (is_over(point)) take_pair(nearest, share, point, point - height * normal);
  };
  take_foot(0, at_from);
  take_foot(1, at_to);
  if ((at_from < 0) != (at_to < 0)) take_foot(at_from / (at_from - at_to), 0);
  return nearest;
}

// The square of the distance of a point of the segment is a sum over the axes of squares of what it is outside of the
// box by: convex, and its derivative is linear between the places where the segment passes a plane of the box.
double distance_to_box(const Vec3& from, const Vec3& to, const core::Bounds& bounds) {
  const Vec3 along = to - from;
  const auto outside = [&](double share, int axis) {
    const double at = from[axis] + share * along[axis];
    const auto k = static_cast<std::size_t>(axis);
    if (at < bounds.min[k]) return at - bounds.min[k];
    return at > bounds.max[k] ? at - bounds.max[k] : 0.0;
  };
  const auto slope = [&](double share) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += outside(share, axis) * along[axis];
    return sum;
  };
  double low = 0, high = 1, at_low = slope(0), at_high = slope(1);
  double best = at_low >= 0 ? 0.0 : 1.0;
  if (at_low < 0 && at_high > 0) {
    std::array<double, 6> places{};
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (along[axis] == 0) continue;
      const auto k = static_cast<std::size_t>(axis);
      places[count++] = (bounds.min[k] - from[axis]) / along[axis];
      places[count++] = (bounds.max[k] - from[axis]) / along[axis];
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!(places[i] > low && places[i] < high)) continue;
      const double value = slope(places[i]);
      (value < 0 ? low : high) = places[i];
      (value < 0 ? at_low : at_high) = value;
    }
    best = at_high > at_low ? low + (high - low) * std::clamp(-at_low / (at_high - at_low), 0.0, 1.0) : low;
  }
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) squared += outside(best, axis) * outside(best, axis);
  return std::sqrt(squared);
}

}  // namespace vantage::internal::query
