#include "query/ground_heights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/edges.h"
#include "core/walk_bvh.h"
#include "core/weld.h"

namespace vantage::internal::query {
namespace {

/// In parts of a triangle: a point that rounding put beside both of two neighbours must not fall between them.
constexpr double kBesideTriangle = 1e-12;

double turn(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

/// The height of the plane of a triangle at a place; nothing where that lies beside the triangle.
std::optional<double> height_at(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y) {
  const Vec3 u = b - a, v = c - a;
  const double area = turn(u.x(), u.y(), v.x(), v.y());
  if (area == 0) return std::nullopt;
  const double px = x - a.x(), py = y - a.y();
  const double along_u = turn(px, py, v.x(), v.y()) / area, along_v = turn(u.x(), u.y(), px, py) / area;
  const bool is_in =
      along_u >= -kBesideTriangle && along_v >= -kBesideTriangle && along_u + along_v <= 1 + kBesideTriangle;
  if (!is_in) return std::nullopt;
  return a.z() + along_u * u.z() + along_v * v.z();
}

core::Bounds plan_bounds(const std::array<Vec3, 3>& corners) {
  core::Bounds bounds{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto along = static_cast<Eigen::Index>(axis);
    const auto [low, high] = std::minmax({corners[0][along], corners[1][along], corners[2][along]});
    bounds.min[axis] = std::nextafterf(static_cast<float>(low), -INFINITY);
    bounds.max[axis] = std::nextafterf(static_cast<float>(high), INFINITY);
  }
  return bounds;
}

/// Sides of triangles that no other triangle shares: at these the ground may end.
std::vector<bool> at_border(const Mesh& mesh) {
  Mesh joined = mesh;
  const std::vector<std::uint32_t> first = core::first_at_position(mesh.vertices);
  for (Triangle& triangle : joined.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = first[vertex];
  }
  std::vector<bool> result(mesh.triangles.size(), false);
  const std::vector<core::EdgeUse> uses = core::edge_uses(joined.triangles, joined.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    for (const core::EdgeUse& use : edge) result[use.triangle] = result[use.triangle] || edge.size() != 2;
  });
  return result;
}

}  // namespace

GroundHeights::GroundHeights(Ground ground) : ground_(std::move(ground)) {
  if (!ground_.surface) return;
  const Mesh& mesh = *ground_.surface;
  std::vector<core::Bounds> bounds;
  for (const Triangle& t : mesh.triangles) {
    bounds.push_back(plan_bounds({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}));
  }
  std::vector<std::uint32_t> order;
  bvh_ = core::build_bvh(bounds, order);
  const std::vector<bool> border = at_border(mesh);
  for (const std::uint32_t t : order) pieces_.push_back({t, border[t]});
}

std::optional<GroundHeights::Range> GroundHeights::at(double x, double y) const {
  if (!ground_.surface) return Range{ground_.plane_z_m, ground_.plane_z_m};
  const Mesh& mesh = *ground_.surface;
  std::optional<Range> range;
  const auto holds = [&](const core::BvhNode& node) {
    const auto& [min, max] = node.bounds;
    return x >= min[0] && x <= max[0] && y >= min[1] && y <= max[1];
  };
  core::walk_bvh(bvh_, holds, [&](std::uint32_t item) {
    const Triangle& t = mesh.triangles[pieces_[item].triangle];
    const auto z = height_at(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], x, y);
    if (!z) return;
    if (!range) range = Range{*z, *z};
    range->lowest_m = std::min(range->lowest_m, *z);
    range->highest_m = std::max(range->highest_m, *z);
  });
  return range;
}

/// In plan.
void GroundHeights::add_border_crossing(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b,
                                        std::vector<double>& out) const {
  const Vec3 side = b - a, to_a = a - origin;
  const double across = turn(direction.x(), direction.y(), side.x(), side.y());
  if (across != 0) out.push_back(turn(to_a.x(), to_a.y(), side.x(), side.y()) / across);
}

void GroundHeights::add_crossings(const Vec3& origin, const Vec3& direction, double reach, double above_m,
                                  std::vector<double>& out) const {
  if (!ground_.surface) {
    if (direction.z() != 0) out.push_back((ground_.plane_z_m + above_m - origin.z()) / direction.z());
    return;
  }
  const Mesh& mesh = *ground_.surface;
  const Vec3 end = origin + reach * direction;
  const auto meets = [&](const core::BvhNode& node) {
    double begin = 0, finish = 1;
    for (unsigned axis = 0; axis < 2; ++axis) {
      const double from = origin[axis], to = end[axis], low = node.bounds.min[axis], high = node.bounds.max[axis];
      if (from == to) {
        if (from < low || from > high) return false;
        continue;
      }
      const auto [near, far] = std::minmax({(low - from) / (to - from), (high - from) / (to - from)});
      begin = std::max(begin, near);
      finish = std::min(finish, far);
    }
    constexpr double kRounding = 1e-12;
    return begin <= finish + kRounding;
  };
  core::walk_bvh(bvh_, meets, [&](std::uint32_t item) {
    const auto& [triangle, is_at_border] = pieces_[item];
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double slope = normal.dot(direction);
    if (slope != 0) out.push_back((normal.dot(a - origin) + normal.z() * above_m) / slope);
    if (!is_at_border) return;
    add_border_crossing(origin, direction, a, b, out);
    add_border_crossing(origin, direction, b, c, out);
    add_border_crossing(origin, direction, c, a, out);
  });
}

}  // namespace vantage::internal::query
