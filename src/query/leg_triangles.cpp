// Triangles near a leg: clearance, and closed meshes to stay in.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/bounds_distance.h"
#include "core/triangle_distance.h"
#include "core/walk_bvh.h"
#include "query/leg_convex.h"
#include "query/leg_limits.h"
#include "query/leg_segment.h"

namespace vantage::internal::query {
namespace {

Mesh moved_mesh(const Mesh& mesh, const Vec3& origin) {
  Mesh moved = mesh;
  for (Vec3& vertex : moved.vertices) vertex -= origin;
  return moved;
}

Vec3 flat(const Vec3& place) { return {place.x(), place.y(), 0}; }

}  // namespace

LegTriangles::LegTriangles(const Mesh& mesh, bool in_plan) : in_plan_(in_plan) {
  const Box box = bounding_box(mesh);
  origin_ = box.empty() ? Vec3(Vec3::Zero()) : Vec3(0.5 * (box.min + box.max));
  mesh_ = moved_mesh(mesh, origin_);
  std::vector<core::Bounds> bounds(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < bounds.size(); ++t) {
    Box of_triangle;
    for (const Vec3& corner : corners(t)) of_triangle.extend(in_plan_ ? flat(corner) : corner);
    for (unsigned axis = 0; axis < 3; ++axis) {
      bounds[t].min[axis] = std::nextafterf(static_cast<float>(of_triangle.min[axis]), -INFINITY);
      bounds[t].max[axis] = std::nextafterf(static_cast<float>(of_triangle.max[axis]), INFINITY);
    }
  }
  bvh_ = core::build_bvh(bounds, order_);
}

std::array<Vec3, 3> LegTriangles::corners(std::uint32_t triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
}

void LegTriangles::near(const Leg& leg, double reach, const std::function<void(std::uint32_t)>& visit) const {
  const Vec3 from = in_plan_ ? flat(leg.from) : leg.from, to = in_plan_ ? flat(leg.to) : leg.to;
  const double room = 1e-12 * (from.norm() + to.norm());
  core::walk_bvh(
      bvh_, [&](const core::BvhNode& node) { return distance_to_box(from, to, node.bounds) <= reach + room; },
      [&](std::uint32_t item) { visit(order_[item]); });
}

double LegTriangles::distance(const Vec3& given) const {
  const Vec3 place = in_plan_ ? flat(given) : given;
  double least = INFINITY;
  core::walk_nearer_first(
      bvh_, [&](const core::Bounds& bounds) { return core::squared_distance_to(bounds, place); },
      [&](const core::BvhNode&, double squared) { return squared < least; },
      [&](std::uint32_t item) {
        auto [a, b, c] = corners(order_[item]);
        if (in_plan_) {
          a = flat(a);
          b = flat(b);
          c = flat(c);
        }
        least = std::min(least, core::squared_distance_to_triangle(place, a, b, c));
      });
  return std::sqrt(least);
}

LegIntervals too_near(const LegTriangles& triangles, const Tube& tube, double distance) {
  const Tube local = tube.moved(-triangles.origin());
  const double reach = distance + tube.radius;
  LegIntervals parts;
  triangles.near(local.leg, reach, [&](std::uint32_t triangle) {
    const std::array<Vec3, 3> at = triangles.corners(triangle);
    const NearestPair pair = nearest_to_polygon(local.leg.from, local.leg.to, at);
    const auto squared = [&](double share) {
      return core::squared_distance_to_triangle(local.at(share), at[0], at[1], at[2]);
    };
    if (const auto part = below_level(squared, reach * reach, pair.share)) parts.push_back(*part);
  });
  return joined(std::move(parts));
}

LegMesh::LegMesh(const KeepInMesh& mesh) : triangles_(mesh.mesh), tree_(triangles_.mesh()) {}

bool LegMesh::is_inside(const Vec3& local) const {
  constexpr double kOnSurface = 1e-12;  // of the distance from the middle of the mesh
  return tree_.distance(local) <= kOnSurface * local.norm() || tree_.winding_number(local) > 0;
}

double LegMesh::outside(const Vec3& place) const {
  const Vec3 local = place - triangles_.origin();
  const double distance = tree_.distance(local);
  return is_inside(local) ? -distance : distance;
}

// Between two places where the leg passes a triangle, or nearly, all of it is inside or none. A place too many does no
// harm. Triangles that it slides along are left out: where they end it passes their neighbours.
LegIntervals LegMesh::broken(const Tube& tube) const {
  const Tube local = tube.moved(-triangles_.origin());
  const Vec3 along = local.leg.to - local.leg.from;
  std::vector<double> cuts{0, 1};
  const double room = 1e-9 * (local.leg.from.norm() + local.leg.to.norm());
  triangles_.near(local.leg, room, [&](std::uint32_t triangle) {
    const auto [a, b, c] = triangles_.corners(triangle);
    const Vec3 normal = (b - a).cross(c - a);
    const double slope = normal.dot(along);
    if (slope == 0) return;
    const double cut = normal.dot(a - local.leg.from) / slope;
    if (cut > 0 && cut < 1) cuts.push_back(cut);
  });
  std::sort(cuts.begin(), cuts.end());
  LegIntervals parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    if (!is_inside(local.at(0.5 * (cuts[i] + cuts[i + 1])))) parts.push_back({cuts[i], cuts[i + 1]});
  }
  if (tube.radius > 0) {
    const LegIntervals near = too_near(triangles_, tube, 0);
    parts.insert(parts.end(), near.begin(), near.end());
  }
  return joined(std::move(parts));
}

}  // namespace vantage::internal::query
