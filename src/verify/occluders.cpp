#include "verify/occluders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "vantage/error.h"
#include "verify/seen_area.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

FlatTriangle local_triangle(const Mesh& mesh, std::size_t number, const Vec3& origin) {
  std::array<Vec3, 3> corners;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t index = mesh.triangles[number][i];
    const bool is_there = index < mesh.vertices.size();
    if (!is_there || !mesh.vertices[index].allFinite()) {
      throw Error(is_there ? ErrorCode::coordinate_not_finite : ErrorCode::index_out_of_range,
                  "a corner of the triangle does not exist or is not finite",
                  "scene triangle " + std::to_string(number), "read the scene again");
    }
    if (mesh.vertices[index].cwiseAbs().maxCoeff() > kFarthestCoordinate) {
      throw Error(ErrorCode::coordinate_too_large, "a corner of the triangle is farther than 1e9 m from the origin",
                  "scene triangle " + std::to_string(number), "give coordinates in metres");
    }
    corners[i] = mesh.vertices[index] - origin;
  }
  return {corners[0], corners[1], corners[2]};
}

/// Holds every segment that can count: its viewpoint is within range of all vertices, so of their mean.
Box region_of_segments(const TargetView& view, double max_range) {
  Box region;
  region.extend(Vec3(view.centre() - Vec3::Constant(max_range * (1 + 1e-6))));
  region.extend(Vec3(view.centre() + Vec3::Constant(max_range * (1 + 1e-6))));
  for (const Vec3& vertex : view.vertices()) region.extend(vertex);
  return region;
}

}  // namespace

Occluders::Occluders(const Scene& scene, const TargetView& view, double max_range) : view_(view) {
  const Box region = region_of_segments(view, max_range);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    const FlatTriangle triangle = local_triangle(scene.mesh, i, view.origin());
    if (triangle.normal_length == 0) continue;
    const double top =
        std::max({view.height(triangle.corner), view.height(triangle.second()), view.height(triangle.third())});
    Box box = triangle.bounds();
    box.min = box.min.cwiseMax(region.min);  // Embree is to see small numbers only
    box.max = box.max.cwiseMin(region.max);
    if (view.is_point()) add_if_touched(triangle, static_cast<std::uint32_t>(i));
    if ((top <= 0 && !view.all_sides()) || box.empty()) continue;
    triangles_.push_back(triangle);
    number_.push_back(static_cast<std::uint32_t>(i));
    boxes.push_back(box);
  }
  index_.emplace(boxes, std::max(region.min.cwiseAbs().maxCoeff(), region.max.cwiseAbs().maxCoeff()));
}

std::optional<double> Occluders::hit(const Segment& segment, const FlatTriangle& triangle) const {
  const Intersection hit = intersect(segment, triangle);
  if (hit.contact != Contact::crossing || hit.border < kGrazing) return std::nullopt;
  if (hit.position < kEnd) return std::nullopt;
  if (view_.is_point()) {
    if ((1 - hit.position) * segment.length < kPointSurface) return std::nullopt;
    return hit.position;
  }
  if (hit.position > 1 - kEnd) return std::nullopt;
  const Vec3 point = segment.at(hit.position);
  if (view_.height(point) < kSurfaceHeight && view_.over(point, kSurfaceHeight)) return std::nullopt;
  return hit.position;
}

void Occluders::add_if_touched(const FlatTriangle& triangle, std::uint32_t number) {
  const Vec3 offset = view_.centre() - triangle.corner;
  const Vec3 normal = triangle.normal / triangle.normal_length;
  if (std::abs(normal.dot(offset)) > kPointSurface) return;
  const double third = normal.dot(triangle.edge1.cross(offset)) / triangle.normal_length;
  const double second = normal.dot(offset.cross(triangle.edge2)) / triangle.normal_length;
  const double border = std::min({second, third, 1 - second - third});
  if (border < -kGrazing) return;
  touched_.push_back({normal.dot(view_.normal()) < 0 ? Vec3(-normal) : normal, number, border < kGrazing});
}

const Occluders::TouchedTriangle* Occluders::hiding_touched(const Vec3& viewpoint) const {
  const auto hides = [&](const TouchedTriangle& touched) {
    return touched.outward.dot(viewpoint - view_.centre()) < -kPointSurface;
  };
  const TouchedTriangle* edge = nullptr;
  bool is_over_edge = false;
  for (const TouchedTriangle& touched : touched_) {
    const bool is_behind = hides(touched);
    if (is_behind && !touched.is_edge) return &touched;
    if (is_behind) edge = &touched;
    if (!is_behind && touched.is_edge) is_over_edge = true;
  }
  return is_over_edge ? nullptr : edge;
}

bool Occluders::hide(const Vec3& viewpoint, const Vec3& target_point) const {
  if (hiding_touched(viewpoint)) return true;
  const Segment segment(viewpoint, target_point);
  return index_->any_along(viewpoint, target_point,
                           [&](std::uint32_t i) { return hit(segment, triangles_[i]).has_value(); });
}

/// In the scene's order: how Embree arranges its hierarchy must not show in the report. The list is this thread's.
const std::vector<std::uint32_t>& Occluders::candidates_in(const ViewPyramid& pyramid) const {
  thread_local std::vector<std::uint32_t> candidates;
  candidates.clear();
  index_->any_within(pyramid.sides(), [](std::uint32_t i) {
    candidates.push_back(i);
    return false;
  });
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

Occluders::SeenPart Occluders::seen_part(const Vec3& viewpoint) const {
  const ViewPyramid pyramid(viewpoint, view_);
  const PlaneAxes axes(view_);
  std::vector<std::vector<Vec3>> corners;
  for (const std::uint32_t i : candidates_in(pyramid)) pyramid.add_shadows(triangles_[i], kSurfaceHeight, corners);
  std::vector<FlatPolygon> shadows;
  for (const std::vector<Vec3>& shadow : corners) shadows.push_back(axes.flat(shadow));
  const auto size = [](const FlatPolygon& shadow) { return std::abs(area_of(shadow)); };
  const auto largest = std::max_element(shadows.begin(), shadows.end(),
                                        [&](const FlatPolygon& a, const FlatPolygon& b) { return size(a) < size(b); });
  SeenPart seen;
  if (largest != shadows.end() && size(*largest) > 0) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : *largest) middle += corner / static_cast<double>(largest->size());
    seen.hidden = axes.place(middle);
  }
  seen.area_m2 = area_left(axes.flat(view_.vertices()), std::move(shadows));
  return seen;
}

std::optional<Vec3> Occluders::find_hidden(const Vec3& viewpoint, std::size_t& rays) const {
  const ViewPyramid pyramid(viewpoint, view_);
  for (const std::uint32_t i : candidates_in(pyramid)) {
    // The surface that the target lies on is cut away first, so that the aim is at what may count.
    std::optional<Vec3> aim = pyramid.aim(triangles_[i], kSurfaceHeight);
    if (!aim) aim = pyramid.aim(triangles_[i], 0);
    if (!aim) continue;
    ++rays;
    if (hide(viewpoint, *aim)) return aim;
  }
  return std::nullopt;
}

std::optional<std::size_t> Occluders::first_hit(const Vec3& viewpoint, const Vec3& target_point) const {
  if (const TouchedTriangle* touched = hiding_touched(viewpoint)) return touched->number;
  const Segment segment(viewpoint, target_point);
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const std::optional<double> position = hit(segment, triangles_[i]);
    if (!position || *position >= nearest) continue;
    nearest = *position;
    first = number_[i];
  }
  return first;
}

}  // namespace vantage::internal::verify
