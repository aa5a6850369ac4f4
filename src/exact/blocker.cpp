#include "exact/blocker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

using Eigen::Vector2d;
using numerics::kGrazing;

constexpr double kSimilar = 1e-6;  // planes that differ by more than this fraction are two
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Area vector of a planar polygon, not normalized.
Vec3 area_vector(const std::vector<Vec3>& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return sum;
}

}  // namespace

void clip_to_front(std::span<const Vec3> polygon, double slack, std::vector<Vec3>& clipped) {
  clipped.clear();
  bool above = false;
  const auto height = [slack](const Vec3& p) { return std::abs(p.z()) <= slack ? 0.0 : p.z(); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double za = height(a), zb = height(b);
    above = above || za > 0;
    if (za >= 0) clipped.emplace_back(a.x(), a.y(), za);
    if ((za < 0 && zb > 0) || (za > 0 && zb < 0)) {
      const double s = za / (za - zb);
      clipped.emplace_back(a.x() + s * (b.x() - a.x()), a.y() + s * (b.y() - a.y()), 0.0);
    }
  }
  if (!above) clipped.clear();
}

bool BlockerBuilder::build(std::span<const Vec3> polygon, std::vector<Plane>& planes, std::vector<Vec3>& corners) {
  clip_to_front(polygon, target_.slack, polygon_);
  if (polygon_.size() < 3) return false;
  const Vec3 area = area_vector(polygon_);
  const double size = area.norm();
  if (!(size > 0)) return false;
  const Vec3 normal = area / size;
  planes_ = &planes;
  first_ = planes.size();
  grown_ = false;
  add_own_plane(normal);
  add_target_edge_planes();
  add_polygon_edge_planes(normal);
  if (!grown_) corners.insert(corners.end(), polygon_.begin(), polygon_.end());
  return true;
}

void BlockerBuilder::add(const Vec3& normal, double height) {
  if (!(height > (normal.z() > 0 ? target_.slack : 0))) return;  // the target's own plane
  Plane plane = normal / height;
  const double steepest = plane.head<2>().norm() / kGrazing;
  if (plane.z() * kGrazing * target_.clearance >= 1) {
    grown_ = true;
    return;
  }
  if (plane.z() < -steepest) {
    grown_ = true;
    plane.z() = -steepest;
  }
  for (std::size_t i = first_; i < planes_->size(); ++i)
    if (same((*planes_)[i], plane)) return;
  planes_->push_back(plane);
}

// Whether two planes are one, computed twice: the one that is kept touches all that the other touches.
bool BlockerBuilder::same(const Plane& kept, const Plane& plane) const {
  const double difference = (kept - plane).cwiseAbs().maxCoeff(), size = plane.cwiseAbs().maxCoeff();
  if (difference <= 1e-13 * size) return true;
  if (difference > kSimilar * size) return false;
  const double near = target_.rounding * plane.norm();
  for (const Vec3& o : polygon_)
    if (plane.dot(o) - 1 <= near && std::abs(kept.dot(o) - 1) > 2 * near) return false;
  for (const Vector2d& t : target_.vertices)
    if (plane.head<2>().dot(t) - 1 >= -near && std::abs(kept.head<2>().dot(t) - 1) > 2 * near) return false;
  return true;
}

// The plane of the polygon itself, if the target is wholly on one side of it.
void BlockerBuilder::add_own_plane(const Vec3& normal) {
  double low = kInfinity, high = -kInfinity, own_low = kInfinity, own_high = -kInfinity;
  const auto height_of = [&](const Vector2d& t) { return normal.x() * t.x() + normal.y() * t.y(); };
  for (const Vector2d& t : target_.vertices) {
    low = std::min(low, height_of(t));
    high = std::max(high, height_of(t));
  }
  for (const Vec3& o : polygon_) {
    const double h = normal.dot(o);
    own_low = std::min(own_low, h);
    own_high = std::max(own_high, h);
  }
  on_polygon_.assign(target_.vertices.size(), 0);
  const bool is_over = high <= own_low + target_.slack, is_under = low >= own_high - target_.slack;
  if (!is_over && !is_under) return;
  for (std::size_t i = 0; i < target_.vertices.size(); ++i) {
    const double h = height_of(target_.vertices[i]);
    on_polygon_[i] = is_over ? h >= own_low - target_.slack : h <= own_high + target_.slack;
  }
  const std::size_t before = planes_->size();
  if (is_over) {
    add(normal, own_low);
  } else {
    add(-normal, -own_high);
  }
  if (planes_->size() == before) on_polygon_.assign(on_polygon_.size(), 0);
}

// Through each edge of the target the one plane that touches the polygon and has it on the far side. Not where that is
// the polygon's own plane: rounding would make them two that cross at an angle of nothing. Corners of a wall that
// stands on the edge are on it: a nanometre off, they would tilt the plane the more the nearer they are to the
// target's.
void BlockerBuilder::add_target_edge_planes() {
  for (std::size_t i = 0; i < target_.edges.size(); ++i) {
    if (on_polygon_[i] && on_polygon_[i + 1 == on_polygon_.size() ? 0 : i + 1]) continue;
    const target::LocalTarget::Edge& edge = target_.edges[i];
    double slope = -kInfinity;
    bool separates = true;
    for (const Vec3& o : polygon_) {
      double outside = edge.outward.dot(o.head<2>()) - edge.distance;
      if (std::abs(outside) <= target_.slack) outside = 0;
      if (o.z() > 0) {
        slope = std::max(slope, -outside / o.z());
      } else if (outside < 0) {
        separates = false;  // the polygon stands on the target's plane inside this edge: only z = 0 separates them
      }
    }
    if (separates) add({edge.outward.x(), edge.outward.y(), slope}, edge.distance);
  }
}

// Through each edge of the polygon the planes that touch the target and have it on the near side: at most two. About
// the edge as an axis the polygon is the ray (1, 0) of the coordinates (along, across); the plane's normal is inward +
// slope * normal, and every target vertex must have along + slope * across <= 0.
void BlockerBuilder::add_polygon_edge_planes(const Vec3& polygon_normal) {
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Vec3& a = polygon_[i];
    const Vec3 edge = polygon_[(i + 1) % polygon_.size()] - a;
    const double length = edge.norm();
    if (!(length > target_.slack)) continue;
    // Square to the edge, so that the planes hold it: merged polygons are planar to a nanometre only.
    const Vec3 along_edge = edge / length;
    const Vec3 normal = (polygon_normal - polygon_normal.dot(along_edge) * along_edge).normalized();
    const Vec3 inward = normal.cross(along_edge);
    const double along_0 = inward.dot(a), across_0 = normal.dot(a);
    double low = -kInfinity, high = kInfinity, in_plane = -kInfinity;
    for (const Vector2d& t : target_.vertices) {
      const double along = inward.x() * t.x() + inward.y() * t.y() - along_0;
      const double across = normal.x() * t.x() + normal.y() * t.y() - across_0;
      if (across > target_.slack) {
        high = std::min(high, -along / across);
      } else if (across < -target_.slack) {
        low = std::max(low, -along / across);
      } else {
        in_plane = std::max(in_plane, along);
      }
    }
    if (in_plane > target_.slack || low > high) continue;
    if (!std::isfinite(low) && !std::isfinite(high)) {
      // All of the target is in the polygon's plane, beside the edge. Wherever in the slack a vertex really is, these
      // slopes have it on the near side. Without them nothing would end from above what the polygon hides.
      high = std::max(0.0, -in_plane) / (2 * target_.slack);
      low = -high;
    }
    for (double slope : {low, high}) {
      if (!std::isfinite(slope)) continue;
      const Vec3 m = inward + slope * normal;
      const double scale = 1 / m.norm();
      add_edge_plane(m * scale, m.dot(a) * scale);
    }
  }
}

// An edge that is not much longer than its ends are rounded has a direction of its own. Over the length of a needle a
// plane about it leaves corners of the polygon on the near side: it goes back to those, and hides more.
void BlockerBuilder::add_edge_plane(const Vec3& normal, double height) {
  double nearest = kInfinity;
  for (const Vec3& o : polygon_) nearest = std::min(nearest, normal.dot(o));
  if (nearest >= height - target_.rounding) return add(normal, height);
  for (const Vector2d& t : target_.vertices)
    if (normal.head<2>().dot(t) > nearest + target_.slack) return;
  add(normal, nearest);
}

}  // namespace vantage::internal::exact
