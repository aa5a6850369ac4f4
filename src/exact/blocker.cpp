#include "exact/blocker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/numerics.h"

namespace vantage::exact {
namespace {

using Eigen::Vector2d;
using numerics::kGrazing;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Area vector of a planar polygon, not normalized.
Vec3 area_vector(const std::vector<Vec3>& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return sum;
}

}  // namespace

LocalTarget make_local_target(const std::vector<Vector2d>& polygon, double slack, double rounding) {
  LocalTarget target;
  target.vertices = polygon;
  target.slack = slack;
  target.rounding = rounding;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d along = (polygon[(i + 1) % polygon.size()] - a).normalized();
    const Vector2d outward(along.y(), -along.x());
    target.edges.push_back({outward, outward.dot(a)});
    target.radius = std::max(target.radius, a.norm());
    target.clearance = std::min(target.clearance, target.edges.back().distance);
  }
  return target;
}

bool BlockerBuilder::build(std::span<const Vec3> polygon, std::vector<Plane>& planes, std::vector<Vec3>& corners) {
  clip(polygon);
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

// Keeps what is above the target's plane; heights within rounding of it are set to zero.
void BlockerBuilder::clip(std::span<const Vec3> polygon) {
  polygon_.clear();
  bool above = false;
  const auto height = [this](const Vec3& p) { return std::abs(p.z()) <= target_.slack ? 0.0 : p.z(); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double za = height(a), zb = height(b);
    above = above || za > 0;
    if (za >= 0) polygon_.emplace_back(a.x(), a.y(), za);
    if ((za < 0 && zb > 0) || (za > 0 && zb < 0)) {
      const double s = za / (za - zb);
      polygon_.emplace_back(a.x() + s * (b.x() - a.x()), a.y() + s * (b.y() - a.y()), 0.0);
    }
  }
  if (!above) polygon_.clear();
}

void BlockerBuilder::add(const Vec3& normal, double height) {
  if (!(height > (normal.z() > 0 ? target_.slack : 0))) return;  // the target's own plane
  Plane plane = normal / height;
  const double steepest = plane.head<2>().norm() / kGrazing;
  if (plane.z() > 0 && height <= kGrazing * target_.clearance) {
    grown_ = true;
    return;
  }
  if (plane.z() < -steepest) {
    grown_ = true;
    plane.z() = -steepest;
  }
  for (std::size_t i = first_; i < planes_->size(); ++i)
    if (((*planes_)[i] - plane).cwiseAbs().maxCoeff() <= 1e-13 * plane.cwiseAbs().maxCoeff()) return;
  planes_->push_back(plane);
}

// The plane of the polygon itself, if the target is wholly on one side of it.
void BlockerBuilder::add_own_plane(const Vec3& normal) {
  double low = kInfinity, high = -kInfinity, own_low = kInfinity, own_high = -kInfinity;
  for (const Vector2d& t : target_.vertices) {
    const double h = normal.x() * t.x() + normal.y() * t.y();
    low = std::min(low, h), high = std::max(high, h);
  }
  for (const Vec3& o : polygon_) {
    const double h = normal.dot(o);
    own_low = std::min(own_low, h), own_high = std::max(own_high, h);
  }
  if (high <= own_low + target_.slack)
    add(normal, own_low);
  else if (low >= own_high - target_.slack)
    add(-normal, -own_high);
}

// Through each edge of the target the one plane that touches the polygon and has it on the far side.
void BlockerBuilder::add_target_edge_planes() {
  for (const LocalTarget::Edge& edge : target_.edges) {
    double slope = -kInfinity;
    bool separates = true;
    for (const Vec3& o : polygon_) {
      const double outside = edge.outward.dot(o.head<2>()) - edge.distance;
      if (o.z() > 0)
        slope = std::max(slope, -outside / o.z());
      else if (outside < -target_.slack)
        separates = false;  // the polygon stands on the target's plane inside this edge: only z = 0 separates them
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
    double low = -kInfinity, high = kInfinity;
    bool separates = true;
    for (const Vector2d& t : target_.vertices) {
      const double along = inward.x() * t.x() + inward.y() * t.y() - along_0;
      const double across = normal.x() * t.x() + normal.y() * t.y() - across_0;
      if (across > target_.slack)
        high = std::min(high, -along / across);
      else if (across < -target_.slack)
        low = std::max(low, -along / across);
      else if (along > target_.slack)
        separates = false;
    }
    if (!separates || low > high) continue;
    for (double slope : {low, high}) {
      if (!std::isfinite(slope)) continue;
      const Vec3 m = inward + slope * normal;
      const double scale = 1 / m.norm();
      add(m * scale, m.dot(a) * scale);
    }
  }
}

}  // namespace vantage::exact
