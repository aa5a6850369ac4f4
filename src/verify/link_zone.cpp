#include "verify/link_zone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

constexpr double kSpeedOfLight = 299792458;  // metres a second

/// The corners of a triangle that are not beyond `end` along `axis`, and where its sides pass that.
std::vector<Vec3> cut_off(const FlatTriangle& triangle, const Vec3& antenna, const Vec3& axis, double end) {
  const std::array<Vec3, 3> corners = {triangle.corner, triangle.second(), triangle.third()};
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &from = corners[i], &to = corners[(i + 1) % 3];
    const double a = axis.dot(from - antenna) - end, b = axis.dot(to - antenna) - end;
    if (a <= 0) kept.push_back(from);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) kept.push_back(from + a / (a - b) * (to - from));
  }
  return kept;
}

}  // namespace

LinkZone::LinkZone(const Scene& scene, const TargetView& view, const RadioLink& link, double max_range)
    : view_(view),
      excess_(link.clear * link.clear / 2 * kSpeedOfLight / (link.frequency_ghz * 1e9)),
      range_(max_range) {
  // Wider than any ellipsoid that is asked for.
  const double reach = 1.2 * max_range + 40 * excess_ + kLinkRadiusLoose * std::sqrt(excess_ * max_range);
  Box region;
  region.extend(Vec3(view.centre() - Vec3::Constant(reach)));
  region.extend(Vec3(view.centre() + Vec3::Constant(reach)));
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene.mesh.vertices[scene.mesh.triangles[i][k]] - view.origin();
    const FlatTriangle triangle(corners[0], corners[1], corners[2]);
    Box box = triangle.bounds();
    box.min = box.min.cwiseMax(region.min);
    box.max = box.max.cwiseMin(region.max);
    if (triangle.normal_length == 0 || box.empty()) continue;
    triangles_.push_back(triangle);
    number_.push_back(i);
    boxes.push_back(box);
  }
  index_.emplace(boxes, std::max(region.min.cwiseAbs().maxCoeff(), region.max.cwiseAbs().maxCoeff()));
}

/// All points over which the way to the viewpoint is longer by the excess at most: foci in both ends.
LinkZone::Ellipsoid LinkZone::zone_of(const Vec3& viewpoint) const {
  const Vec3 way = viewpoint - view_.centre();
  const double distance = way.norm();
  return {distance > 0 ? Vec3(way / distance) : Vec3::UnitZ(), distance / 2, (distance + excess_) / 2,
          std::sqrt(excess_ * (2 * distance + excess_)) / 2, std::numeric_limits<double>::infinity()};
}

// The scene is grown by up to k R(d), d being the distance from the antenna: R(d)^2 = 2 e d (D - d + e / 2) / D, with
// the range D; in the last tenth of it R(0.9 D) counts. All points within that of the line of sight are in an ellipsoid
// about the first D' = 1.1 D of the line and m = 4 k^2 e before and beyond: at s along the line its radius is
// k sqrt(2 e (D' - s + m) (s + m) / D'), and s <= d <= s + m. What lies farther beyond the viewpoint than
// w = k sqrt(2 e (t + w)) takes nothing away, but for that which see may_lack.
LinkZone::Ellipsoid LinkZone::widest_lost(const Vec3& viewpoint) const {
  const Vec3 way = viewpoint - view_.centre();
  const double distance = way.norm(), range = 1.1 * range_;
  const double part = 2 * kLinkRadiusLoose * kLinkRadiusLoose * excess_, more = 2 * part;
  const double beyond = 0.5 * part + std::sqrt(0.25 * part * part + part * distance);  // w^2 = part (t + w)
  const double half_length = range / 2 + more;
  return {distance > 0 ? Vec3(way / distance) : Vec3::UnitZ(), range / 2, half_length,
          std::sqrt(part / range) * half_length + kLinkLeastRadius, distance + beyond};
}

/// The distance of the triangle's nearest point from the middle, when the ellipsoid is a ball of radius 1.
double LinkZone::share_of_radius(const Ellipsoid& ellipsoid, const FlatTriangle& triangle) const {
  std::vector<Vec3> corners = cut_off(triangle, view_.centre(), ellipsoid.axis, ellipsoid.end);
  for (Vec3& corner : corners) {
    const Vec3 from = corner - view_.centre();
    const double along = ellipsoid.axis.dot(from);
    const Vec3 aside = from - along * ellipsoid.axis;
    corner = (along - ellipsoid.middle) / ellipsoid.half_length * ellipsoid.axis + aside / ellipsoid.radius;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    least = std::min(least, distance(Vec3::Zero(), FlatTriangle(corners[0], corners[i - 1], corners[i])));
  }
  return least;
}

template <typename Visit>
bool LinkZone::any_near(const Ellipsoid& ellipsoid, Visit&& visit) const {
  const Vec3 &axis = ellipsoid.axis, beside = axis.unitOrthogonal(), above = axis.cross(beside);
  const double start = ellipsoid.middle - ellipsoid.half_length;
  const double end = std::min(ellipsoid.middle + ellipsoid.half_length, ellipsoid.end);
  std::vector<HalfSpace> sides;
  const auto add = [&](const Vec3& normal, double offset) {
    sides.push_back({normal, offset + normal.dot(view_.centre())});
  };
  add(axis, start);
  add(-axis, -end);
  for (const Vec3& normal : {beside, above}) {
    add(normal, -ellipsoid.radius);
    add(-normal, -ellipsoid.radius);
  }
  return index_->any_within(sides, visit);
}

std::optional<std::size_t> LinkZone::entered_by(const Vec3& viewpoint) const {
  const Ellipsoid zone = zone_of(viewpoint);
  double least = 1 - kLinkGrazing;
  std::optional<std::uint32_t> deepest;
  any_near(zone, [&](std::uint32_t i) {
    const double share = share_of_radius(zone, triangles_[i]);
    // In the scene's order where they are equal: how Embree arranges its hierarchy must not show in the report.
    if (share < least || (deepest && share == least && i < *deepest)) {
      least = share;
      deepest = i;
    }
    return false;
  });
  if (!deepest) return std::nullopt;
  return number_[*deepest];
}

bool LinkZone::may_lack(const Vec3& viewpoint) const {
  const Ellipsoid near = widest_lost(viewpoint);
  Ellipsoid whole = near;
  whole.end = std::numeric_limits<double>::infinity();
  return any_near(whole, [&](std::uint32_t i) {
    if (share_of_radius(near, triangles_[i]) < 1) return true;
    return is_behind(viewpoint, triangles_[i]) && share_of_radius(whole, triangles_[i]) < 1;
  });
}

// Where a triangle stands in the way of some line, the volume ends at a plane before it: n . x = h is the triangle's,
// and nothing that is nearer than (h + sqrt(h^2 - 2 d e + e^2)) / 2 is taken away, with its largest distance d from the
// antenna; where that is not real, nothing that is nearer than h less the largest radius.
bool LinkZone::is_behind(const Vec3& viewpoint, const FlatTriangle& triangle) const {
  Vec3 normal = triangle.normal / triangle.normal_length;
  double height = normal.dot(triangle.corner - view_.centre());
  if (height < 0) {
    normal = -normal;
    height = -height;
  }
  double farthest = 0;
  for (const Vec3& corner : {triangle.corner, triangle.second(), triangle.third()}) {
    farthest = std::max(farthest, (corner - view_.centre()).norm());
  }
  farthest = std::min(farthest, range_ + excess_ / 2);
  const double root = height * height - 2 * farthest * excess_ + excess_ * excess_;
  const double widest = kLinkRadiusLoose * std::sqrt(excess_ * (range_ + excess_)) + kLinkLeastRadius;
  const double before = root > 0 ? 0.5 * (height + std::sqrt(root)) : height - widest;
  return normal.dot(viewpoint - view_.centre()) >= before * (1 - kLinkGrazing);
}

}  // namespace vantage::internal::verify
