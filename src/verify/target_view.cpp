#include "verify/target_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "vantage/error.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

constexpr double kVertical = 1e-6;      // normal this close to horizontal: a vertical target (vantage/target.h)
constexpr double kPlanar = 1e-6;        // of the extent, and
constexpr double kPlanarMetres = 1e-3;  // at least this (vantage/target.h)

[[noreturn]] void fail(ErrorCode code, const Target& target, const std::string& problem, const std::string& fix) {
  throw Error(code, problem, "target '" + target.name + "'", fix);
}

/// Newell: the sum of the cross products of neighbouring vertices; twice the area long.
Vec3 newell(const std::vector<Vec3>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) sum += vertices[i].cross(vertices[(i + 1) % vertices.size()]);
  return sum;
}

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

double extent(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return (box.max - box.min).norm();
}

/// Whether the side that the vertices run counter-clockwise on is the back.
bool runs_on_back(const Target& target, const Vec3& normal) {
  if (target.front) {
    const double along = normal.dot(unit(*target.front));
    if (!(std::abs(along) > kVertical)) {
      fail(ErrorCode::direction_invalid, target, "the front lies in the plane of the target",
           "give a vector that points to the side to look from");
    }
    return along < 0;
  }
  return !target.front_by_order && std::abs(normal.z()) > kVertical && normal.z() < 0;
}

}  // namespace

TargetView::TargetView(const Target& target) {
  if (target.parts[0].size() < 3 && !target.is_point()) {
    fail(ErrorCode::target_vertex_count, target, "the target has fewer than 3 vertices",
         "give at least 3, or one for a point");
  }
  for (const Vec3& vertex : target.parts[0]) {
    if (!vertex.allFinite())
      fail(ErrorCode::coordinate_not_finite, target, "a vertex of the target is not finite", "give numbers");
  }
  if (!std::isfinite(target.offset_m))
    fail(ErrorCode::value_out_of_range, target, "the offset of the target is not finite", "give a number");
  if (target.is_point()) {
    set_point(target);
    return;
  }
  origin_ = target.parts[0][0] + mean([&target] {
              std::vector<Vec3> offsets;
              for (const Vec3& vertex : target.parts[0]) offsets.push_back(vertex - target.parts[0][0]);
              return offsets;
            }());
  for (const Vec3& vertex : target.parts[0]) vertices_.push_back(vertex - origin_);
  set_plane(target);
  check_shape(target);

  double area = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vec3& start = vertices_[i];
    const Vec3 inwards = normal_.cross(vertices_[(i + 1) % vertices_.size()] - start).normalized();
    sides_.push_back({inwards, inwards.dot(start)});
    if (i == 0 || i + 1 == vertices_.size()) continue;
    area += (start - vertices_[0]).cross(vertices_[i + 1] - vertices_[0]).dot(normal_);
    fan_area_.push_back(area);
  }
  for (double& sum : fan_area_) sum /= area;
}

void TargetView::set_point(const Target& target) {
  if (target.front && !(target.front->allFinite() && *target.front != Vec3::Zero())) {
    fail(ErrorCode::direction_invalid, target, "the front is zero or not finite",
         "give a vector that points to the side to look from");
  }
  all_sides_ = !target.front;
  normal_ = target.front ? unit(*target.front) : Vec3(Vec3::UnitZ());
  origin_ = target.parts[0][0];
  centre_ = target.offset_m * normal_;
  vertices_ = {centre_};
}

void TargetView::set_plane(const Target& target) {
  const double size = extent(vertices_);
  const Vec3 area = newell(vertices_);
  if (!(area.norm() > 1e-12 * size * size))
    fail(ErrorCode::target_without_area, target, "the target has no area", "give vertices round a polygon");
  normal_ = area.normalized();
  if (runs_on_back(target, normal_)) {
    normal_ = -normal_;
    std::reverse(vertices_.begin(), vertices_.end());
  }
  centre_ = mean(vertices_);
  for (Vec3& vertex : vertices_) {
    const double off = height(vertex);
    if (std::abs(off) > std::max(kPlanar * size, kPlanarMetres)) {
      fail(ErrorCode::target_not_planar, target,
           "the target is not planar: a vertex lies " + std::to_string(std::abs(off)) + " m off its plane",
           "move the vertices into one plane");
    }
    vertex += (target.offset_m - off) * normal_;
  }
  centre_ += target.offset_m * normal_;
}

// Where rounding has bent a straight side inwards the target is grown to the straight line. Else a side may be so short
// that its direction says nothing about where the others should be.
void TargetView::drop_reflex_vertices(const Target& target, double slack) {
  for (std::size_t i = 0, straight = 0; vertices_.size() > 3 && straight < vertices_.size();) {
    const std::size_t count = vertices_.size();
    const Vec3& before = vertices_[(i + count - 1) % count];
    const Vec3 chord = vertices_[(i + 1) % count] - before;
    const double depth = normal_.cross(chord).dot(vertices_[i] - before);  // times the chord's length
    if (depth < 0) {
      ++straight;
      i = (i + 1) % count;
      continue;
    }
    if (depth > slack * chord.norm())
      fail(ErrorCode::target_not_convex, target, "the target is not convex", "split it into convex targets");
    vertices_.erase(vertices_.begin() + static_cast<std::ptrdiff_t>(i));
    i = (i + count - 2) % (count - 1);
    straight = 0;
  }
}

void TargetView::check_shape(const Target& target) {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vec3 edge = vertices_[(i + 1) % vertices_.size()] - vertices_[i];
    if (!(edge.norm() > 0))
      fail(ErrorCode::target_vertices_coincide, target, "a vertex of the target is repeated", "give each vertex once");
  }
  const double slack = kPlanar * extent(vertices_);
  drop_reflex_vertices(target, slack);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vec3 inwards = normal_.cross(vertices_[(i + 1) % vertices_.size()] - vertices_[i]).normalized();
    for (const Vec3& vertex : vertices_) {
      if (inwards.dot(vertex - vertices_[i]) < -slack) {
        fail(ErrorCode::target_not_convex, target, "the target is not convex", "split it into convex targets");
      }
    }
  }
}

double TargetView::farthest(const Vec3& point) const {
  double squared = 0;
  for (const Vec3& vertex : vertices_) squared = std::max(squared, (point - vertex).squaredNorm());
  return std::sqrt(squared);
}

bool TargetView::over(const Vec3& point, double margin) const {
  if (is_point()) return (point - centre_ - height(point) * normal_).norm() <= margin;
  return std::all_of(sides_.begin(), sides_.end(), [&point, margin](const HalfSpace& side) {
    return side.normal.dot(point) >= side.offset - margin;
  });
}

Vec3 TargetView::interior(double u, double v) const {
  if (is_point()) return centre_;
  const auto found = std::upper_bound(fan_area_.begin(), fan_area_.end() - 1, u);
  const auto i = static_cast<std::size_t>(found - fan_area_.begin());
  const double start = i > 0 ? fan_area_[i - 1] : 0.0;
  const double width = fan_area_[i] - start;
  const double reach = std::sqrt(width > 0 ? std::clamp((u - start) / width, 0.0, 1.0) : 0.0);
  const Vec3 across = (1 - v) * vertices_[i + 1] + v * vertices_[i + 2];
  return vertices_[0] + reach * (across - vertices_[0]);
}

}  // namespace vantage::internal::verify
