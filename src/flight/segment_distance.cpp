#include "flight/segment_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/triangle_distance.h"
#include "core/walk_bvh.h"

namespace vantage::internal::flight {
namespace {

/// Between the segments pq and ab (Ericson, "Real-time collision detection", 2005, 5.1.9).
double squared_between(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const Vec3 d = q - p, e = b - a, r = p - a;
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), er = e.dot(r), dr = d.dot(r), de = d.dot(e);
  double s = 0, t = 0;
  const double determinant = dd * ee - de * de;
  if (dd > 0 && ee > 0) {
    // If the segments are parallel to rounding, any s will do: the ends are compared with the triangle besides.
    if (determinant > 0) s = std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0);
    t = std::clamp((de * s + er) / ee, 0.0, 1.0);
    s = std::clamp((de * t - dr) / dd, 0.0, 1.0);
  } else if (ee > 0) {
    t = std::clamp(er / ee, 0.0, 1.0);
  } else if (dd > 0) {
    s = std::clamp(-dr / dd, 0.0, 1.0);
  }
  return (r + s * d - t * e).squaredNorm();
}

/// Whether the segment crosses the triangle's inside. What goes through an edge comes near that edge besides.
bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double from = normal.dot(p - a), to = normal.dot(q - a);
  if (!((from < 0 && to > 0) || (from > 0 && to < 0))) return false;
  const Vec3 d = q - p;
  const auto side = [&](const Vec3& u, const Vec3& v) { return d.dot((u - p).cross(v - p)); };
  const double s0 = side(a, b), s1 = side(b, c), s2 = side(c, a);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

core::Bounds rounded_out(const Box& box) {
  constexpr float kUnbounded = std::numeric_limits<float>::infinity();
  core::Bounds bounds{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -kUnbounded);
    bounds.max[axis] = std::nextafter(static_cast<float>(box.max[axis]), kUnbounded);
  }
  return bounds;
}

double squared_gap(const core::Bounds& bounds, const Box& box) {
  double sum = 0;
  for (unsigned a = 0; a < 3; ++a) {
    const double gap = std::max({0.0, bounds.min[a] - box.max[a], box.min[a] - bounds.max[a]});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

double squared_segment_distance(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (crosses(p, q, a, b, c)) return 0;
  return std::min({core::squared_distance_to_triangle(p, a, b, c), core::squared_distance_to_triangle(q, a, b, c),
                   squared_between(p, q, a, b), squared_between(p, q, b, c), squared_between(p, q, c, a)});
}

SegmentDistance::SegmentDistance(const Mesh& mesh) : mesh_(mesh) {
  std::vector<core::Bounds> bounds;
  bounds.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Box box;
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
    bounds.push_back(rounded_out(box));
  }
  bvh_ = core::build_bvh(bounds, order_);
}

SegmentDistance::Nearest SegmentDistance::nearest(const Vec3& p, const Vec3& q, double below, double slack) const {
  Box box;
  box.extend(p);
  box.extend(q);
  const bool is_point = p == q;
  Nearest best{below, std::nullopt};
  const auto enters = [&](double squared) {
    const double needed = best.distance_m - slack;
    return needed > 0 && squared < needed * needed;
  };
  core::walk_nearer_first(
      bvh_, [&](const core::Bounds& bounds) { return squared_gap(bounds, box); },
      [&](const core::BvhNode&, double squared) { return enters(squared); },
      [&](std::uint32_t item) {
        const Triangle& t = mesh_.triangles[order_[item]];
        const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
        const double distance = std::sqrt(is_point ? core::squared_distance_to_triangle(p, a, b, c)
                                                   : squared_segment_distance(p, q, a, b, c));
        if (distance < best.distance_m) best = {distance, order_[item]};
      });
  return best;
}

}  // namespace vantage::internal::flight
