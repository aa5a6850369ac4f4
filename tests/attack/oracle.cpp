#include "oracle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace attack {
namespace {

bool subtracts_exactly(double value, double origin) {
  const double rest = value - origin;
  const double back = value - rest;
  return (value - (rest + back)) + (back - origin) == 0;
}

// Sides of a plane: 1, -1, 0 (all in it), 2 (both).
int side_of(const Corners& plane, std::span<const Vec3> points) {
  int side = 0;
  for (const Vec3& p : points) {
    const int s = orientation(plane[0], plane[1], plane[2], p);
    if (s == 0) continue;
    if (side == -s) return 2;
    side = s;
  }
  return side;
}

bool apart(const vantage::Box& a, const vantage::Box& b) {
  return (a.min.array() >= b.max.array()).any() || (a.max.array() <= b.min.array()).any();
}

/// Of what vantage/volume.h takes for nothing: in parts of the longest side, and of the scene's size.
constexpr double kNoWidth = 1.01 * 0x1p-50;

double longest_side(const Corners& t) {
  return std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
}

double least_height(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / longest_side(t); }

bool has_width(const Corners& t) {
  return !collinear(t[0], t[1], t[2]) && least_height(t) > kNoWidth * longest_side(t);
}

}  // namespace

Blockers::Blockers(const vantage::Scene& scene, const std::vector<vantage::Target>& targets) {
  std::vector<Vec3> stored = scene.mesh.vertices;
  for (const vantage::Target& t : targets) stored.insert(stored.end(), t.parts[0].begin(), t.parts[0].end());
  for (int axis = 0; axis < 3; ++axis) {
    const double near = targets[0].parts[0][0][axis];
    const bool exact =
        std::all_of(stored.begin(), stored.end(), [&](const Vec3& p) { return subtracts_exactly(p[axis], near); });
    if (exact) origin[axis] = near;
  }
  for (const Vec3& p : stored) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  std::set<std::array<std::array<double, 3>, 3>> seen;
  vantage::Box bounds;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    Blocker blocker;
    for (int k = 0; k < 3; ++k) {
      blocker.corners[k] = scene.mesh.vertices[scene.mesh.triangles[i][k]] - origin;
      blocker.box.extend(blocker.corners[k]);
    }
    if (!has_width(blocker.corners)) continue;
    blocker.object = scene.object_of.empty() ? 0 : scene.object_of[i];
    blocker.thin = least_height(blocker.corners) <= kThin;
    std::array<std::array<double, 3>, 3> places;
    for (int k = 0; k < 3; ++k) places[k] = {blocker.corners[k].x(), blocker.corners[k].y(), blocker.corners[k].z()};
    std::sort(places.begin(), places.end());
    blocker.repeat = !seen.insert(places).second;
    triangles.push_back(blocker);
    bounds.extend(blocker.box);
  }
  if (triangles.empty()) return;
  middle = 0.5 * (bounds.min + bounds.max);
  const double size = 0.5 * (bounds.max - bounds.min).maxCoeff();
  merging = 2 * std::min(1e-9, 0x1p-46 * size);
  const double no_width = std::min(kThin, kNoWidth * size);
  std::erase_if(triangles, [&](const Blocker& blocker) { return least_height(blocker.corners) <= no_width; });
}

View::View(const Blockers& blockers, SeenTarget target) : blockers_(blockers), target_(std::move(target)) {
  for (const Vec3& p : target_.corners) box_.extend(p);
  const double noise = 1e-14 * std::max(blockers.largest, 1e-6);
  for (const Blocker& blocker : blockers.triangles) {
    side_.push_back(side_of(blocker.corners, target_.corners));
    const bool is_below = !target_.is_point() && !target_.corners.empty() &&
                          std::all_of(blocker.corners.begin(), blocker.corners.end(),
                                      [&](const Vec3& p) { return target_.height(p) < -noise; });
    below_.push_back(is_below);
  }
  last_plane_.resize(blockers.triangles.size());
  supports_of_.setConstant(NAN);
}

const std::vector<View::Support>& View::supports(const Vec3& point) const {
  if (supports_of_ == point) return supports_;
  supports_of_ = point;
  supports_.clear();
  const std::size_t n = target_.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = target_.corners[i], &b = target_.corners[(i + 1) % n];
    const int side = side_of({point, a, b}, target_.corners);
    if (side == 1 || side == -1) supports_.push_back({a, b, side});
  }
  return supports_;
}

bool View::outside_pyramid(const Corners& triangle, const Vec3& point) const {
  for (const Support& support : supports(point)) {
    const int side = side_of({point, support.a, support.b}, triangle);
    if (side == 0 || side == -support.side) return true;
  }
  return false;
}

bool View::hides(std::size_t i, const Vec3& point) const {
  const Blocker& blocker = blockers_.triangles[i];
  if (target_.is_point()) return segment_crosses(point, target_.corners[0], blocker.corners);
  if (target_.corners.size() < 3 || below_[i]) return false;
  vantage::Box pyramid = box_;
  pyramid.extend(point);
  if (apart(pyramid, blocker.box)) return false;
  const auto& [a, b, c] = blocker.corners;
  const int side = orientation(a, b, c, point);
  if (side_[i] != 2 && (side == 0 || side_[i] == 0 || side == side_[i])) return false;
  if (outside_pyramid(blocker.corners, point)) return false;
  for (std::size_t k = 0; k < target_.fan(); ++k) {
    const Corners t = target_.fan_triangle(k);
    if (!interior_misses(std::array{point, t[0], t[1], t[2]}, blocker.corners)) return true;
  }
  return false;
}

std::optional<std::size_t> View::first_hiding(const Vec3& point, TriangleFilter filter, std::size_t begin) const {
  for (std::size_t i = begin; i < blockers_.triangles.size(); ++i) {
    if (filter == TriangleFilter::not_thin && blockers_.triangles[i].thin) continue;
    if (hides(i, point)) return i;
  }
  return std::nullopt;
}

bool View::facet_clear(std::size_t i, const Corners& facet) const {
  const Blocker& blocker = blockers_.triangles[i];
  if (target_.corners.empty() || below_[i]) return true;
  vantage::Box hull = box_;
  for (const Vec3& p : facet) hull.extend(p);
  if (apart(hull, blocker.box)) return true;
  const int side = side_of(blocker.corners, facet);
  if (side_[i] != 2 && side != 2 && side_[i] * side >= 0) return true;
  if (target_.is_point())
    return interior_misses(std::array{facet[0], facet[1], facet[2], target_.corners[0]}, blocker.corners);
  std::vector<Vec3> points(facet.begin(), facet.end());
  points.insert(points.end(), target_.corners.begin(), target_.corners.end());
  if (target_.fan() > 1 && hull_of_two_misses(points, blocker.corners, last_plane_[i])) return true;
  for (std::size_t k = 0; k < target_.fan(); ++k) {
    const Corners t = target_.fan_triangle(k);
    if (!interior_misses(std::array{facet[0], facet[1], facet[2], t[0], t[1], t[2]}, blocker.corners)) return false;
  }
  return true;
}

std::optional<std::size_t> View::first_hiding(const Corners& facet, TriangleFilter filter) const {
  for (std::size_t i = 0; i < blockers_.triangles.size(); ++i) {
    if (filter == TriangleFilter::not_thin && blockers_.triangles[i].thin) continue;
    if (!facet_clear(i, facet)) return i;
  }
  return std::nullopt;
}

bool View::in_range(const Vec3& point, double range) const {
  return std::all_of(target_.corners.begin(), target_.corners.end(),
                     [&](const Vec3& corner) { return compare_distance(point, corner, range) <= 0; });
}

}  // namespace attack
