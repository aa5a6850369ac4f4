#include "verify/view_pyramid.h"

#include <Eigen/Geometry>

namespace vantage::internal::verify {
namespace {

/// Sutherland and Hodgman, "Reentrant polygon clipping", CACM 1974: the part of a convex polygon in a half space.
void clip(std::vector<Vec3>& polygon, const HalfSpace& side, std::vector<Vec3>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& here = polygon[i];
    const Vec3& next = polygon[(i + 1) % polygon.size()];
    const double depth_here = side.normal.dot(here) - side.offset;
    const double depth_next = side.normal.dot(next) - side.offset;
    if (depth_here >= 0) scratch.push_back(here);
    if ((depth_here > 0 && depth_next < 0) || (depth_here < 0 && depth_next > 0)) {
      scratch.push_back(here + depth_here / (depth_here - depth_next) * (next - here));
    }
  }
  polygon.swap(scratch);
}

}  // namespace

ViewPyramid::ViewPyramid(const Vec3& apex, const TargetView& view)
    : view_(view), apex_(apex), apex_height_(view.height(apex)) {
  sides_.push_back({view.normal(), view.normal().dot(view.centre())});
  const std::vector<Vec3>& vertices = view.vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& start = vertices[i];
    const Vec3& end = vertices[(i + 1) % vertices.size()];
    const Vec3 inwards = (apex - start).cross(end - start).normalized();
    if (inwards.allFinite()) sides_.push_back({inwards, inwards.dot(start)});
  }
}

std::optional<Vec3> ViewPyramid::aim(const FlatTriangle& triangle, double lowest) const {
  thread_local std::vector<Vec3> polygon, scratch;
  polygon.assign({triangle.corner, triangle.second(), triangle.third()});
  HalfSpace floor = sides_.front();
  floor.offset += lowest;
  clip(polygon, floor, scratch);
  for (std::size_t i = 1; i < sides_.size() && polygon.size() >= 3; ++i) clip(polygon, sides_[i], scratch);
  if (polygon.size() < 3) return std::nullopt;

  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : polygon) middle += corner / static_cast<double>(polygon.size());
  const double drop = apex_height_ - view_.height(middle);
  if (!(drop > 0)) return std::nullopt;
  return apex_ + apex_height_ / drop * (middle - apex_);
}

/// Along the lines of sight to the target's plane. Nothing where the polygon has no area or reaches up to the apex.
std::optional<std::vector<Vec3>> ViewPyramid::thrown(const std::vector<Vec3>& polygon) const {
  if (polygon.size() < 3) return std::nullopt;
  std::vector<Vec3> shadow;
  for (const Vec3& corner : polygon) {
    const double drop = apex_height_ - view_.height(corner);
    if (!(drop > 0)) return std::nullopt;
    shadow.push_back(apex_ + apex_height_ / drop * (corner - apex_));
  }
  return shadow;
}

void ViewPyramid::add_shadows(const FlatTriangle& triangle, double lowest,
                              std::vector<std::vector<Vec3>>& shadows) const {
  thread_local std::vector<Vec3> polygon, low, outside, scratch;
  polygon.assign({triangle.corner, triangle.second(), triangle.third()});
  for (const HalfSpace& side : sides_) clip(polygon, side, scratch);
  const auto add = [&](const std::vector<Vec3>& part) {
    if (auto shadow = thrown(part)) shadows.push_back(std::move(*shadow));
  };
  HalfSpace floor = sides_.front();
  floor.offset += lowest;
  low = polygon;
  clip(polygon, floor, scratch);
  add(polygon);
  clip(low, {-floor.normal, -floor.offset}, scratch);
  const std::vector<Vec3>& vertices = view_.vertices();
  for (std::size_t i = 0; i < vertices.size() && low.size() >= 3; ++i) {
    const Vec3 inwards = view_.normal().cross(vertices[(i + 1) % vertices.size()] - vertices[i]).normalized();
    const double offset = inwards.dot(vertices[i]) - lowest;
    outside = low;
    clip(outside, {-inwards, -offset}, scratch);
    add(outside);
    clip(low, {inwards, offset}, scratch);
  }
}

}  // namespace vantage::internal::verify
