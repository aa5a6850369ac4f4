#include "exact/beyond_floor.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/facet_polygon.h"
#include "core/parallel.h"
#include "core/triangle_distance.h"
#include "exact/quadrant_parts.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

using core::FacetPolygon;

/// Limits are moved out by kShrinks. What is not nearer than this, in parts of the distance, keeps them.
constexpr double kAt = 1 - (Floor::kShrinks - 2) * numerics::kShrink;

bool is_beyond(const Plane& plane, const std::array<Vec3, 3>& corners) {
  return plane.dot(corners[0]) >= kAt && plane.dot(corners[1]) >= kAt && plane.dot(corners[2]) >= kAt;
}

}  // namespace

BeyondFloor::BeyondFloor(const Floor& floor) : floor_(floor), reach_(floor.bodies().size(), 0) {
  for (const Floor::Facet& facet : floor.facets()) {
    double& reach = reach_[facet.body];
    for (const Vec3& corner : facet.polygon.corners) reach = std::max(reach, corner.norm());
  }
}

bool BeyondFloor::holds(const Mesh& mesh, const std::function<bool(std::size_t)>& is_asked) const {
  constexpr std::size_t kGrain = 256;
  std::atomic<bool> all_do = true;
  // Sides that are kept: where corners are beyond them, so is all between.
  enum : char { kUnused, kUsed, kBeyond };
  std::vector<char> state(mesh.vertices.size(), kUnused);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!is_asked(i)) continue;
    for (const std::uint32_t v : mesh.triangles[i]) state[v] = kUsed;
  }
  parallel::for_ranges(state.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (state[v] == kUsed && is_beyond_kept(mesh.vertices[v])) state[v] = kBeyond;
    }
  });
  parallel::for_ranges(mesh.triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && all_do; ++i) {
      if (!is_asked(i)) continue;
      const auto& [a, b, c] = mesh.triangles[i];
      bool is_apart_from_all = state[a] == kBeyond && state[b] == kBeyond && state[c] == kBeyond;
      for (std::uint32_t body = 0; body < reach_.size() && is_apart_from_all; ++body) {
        if (floor_.bodies()[body].kind == Floor::Kind::kept) continue;
        is_apart_from_all = is_apart(body, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
      }
      if (!is_apart_from_all) all_do = false;
    }
  });
  return all_do;
}

bool BeyondFloor::is_beyond_kept(const Vec3& point) const {
  for (std::uint32_t body = 0; body < reach_.size(); ++body) {
    if (floor_.bodies()[body].kind != Floor::Kind::kept) continue;
    for (const std::uint32_t plane : floor_.planes_at(to_octahedral(point), body)) {
      if (!(floor_.planes()[plane].dot(point) >= kAt)) return false;
    }
  }
  return true;
}

/// A body that is taken away is convex: what one of its planes has beyond it is apart. Else the triangle is cut down to
/// what is before all of them.
bool BeyondFloor::is_apart(std::uint32_t body, const std::array<Vec3, 3>& corners) const {
  const double nearest = core::squared_distance_to_triangle(Vec3::Zero(), corners[0], corners[1], corners[2]);
  if (nearest >= reach_[body] * reach_[body]) return true;
  if (floor_.bodies()[body].kind == Floor::Kind::star) return is_apart_from_star(body, corners, std::sqrt(nearest));
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  for (const Vec3& at : {middle, corners[0], corners[1], corners[2]}) {
    for (const std::uint32_t plane : floor_.planes_at(to_octahedral(at), body)) {
      if (is_beyond(floor_.planes()[plane], corners)) return true;
    }
  }
  FacetPolygon polygon{{corners.begin(), corners.end()}, {0, 0, 0}}, scratch;
  for (const Plane& plane : floor_.planes_of(floor_.bodies()[body])) {
    core::clip_facet(polygon, -plane, -kAt, 0, 0, scratch);
    if (polygon.empty()) return true;
  }
  return false;
}

/// What of the triangle is in the cone of a facet must be beyond its plane. `nearest`: of its points to the centre.
bool BeyondFloor::is_apart_from_star(std::uint32_t body, const std::array<Vec3, 3>& corners, double nearest) const {
  const Floor::Body& star = floor_.bodies()[body];
  // A triangle that is all in one cone, but for so much, is as much before the planes beside it as these differ. About
  // a corner no more facets than kMostBeside are passed.
  constexpr double kBeside = 1e-13;
  constexpr int kMostBeside = 16;
  const double most_before = kMostBeside * floor_.steepness() * kBeside;
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  for (const std::uint32_t plane : floor_.planes_at(to_octahedral(middle), body)) {
    const Floor::Cone& cone = floor_.cone_of(star, plane);
    const bool is_in_cone = std::all_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
      return std::min({cone[0].dot(corner), cone[1].dot(corner), cone[2].dot(corner)}) >= -kBeside;
    });
    if (!is_in_cone) continue;
    if (std::all_of(corners.begin(), corners.end(),
                    [&](const Vec3& corner) { return floor_.planes()[plane].dot(corner) - most_before >= kAt; })) {
      return true;
    }
  }
  const FacetPolygon polygon{{corners.begin(), corners.end()}, {0, 0, 0}};
  FacetPolygon part, cut, scratch;
  std::vector<std::uint32_t> found;
  for_each_quadrant(polygon, part, scratch, [&](int quadrant, const FacetPolygon& in_quadrant) {
    floor_.planes_over(body, quadrant, in_quadrant.corners, nearest, found);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return std::all_of(found.begin(), found.end(), [&](std::uint32_t plane) {
    if (is_beyond(floor_.planes()[plane], corners)) return true;
    cut = polygon;
    for (const Vec3& side : floor_.cone_of(star, plane)) {
      core::clip_facet(cut, side, 0, 0, 0, scratch);
      if (cut.empty()) return true;
    }
    return std::all_of(cut.corners.begin(), cut.corners.end(),
                       [&](const Vec3& corner) { return floor_.planes()[plane].dot(corner) >= kAt; });
  });
}

}  // namespace vantage::internal::exact
