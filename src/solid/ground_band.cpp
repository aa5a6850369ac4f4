#include "solid/ground_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/edges.h"
#include "core/triangle_tree.h"
#include "core/weld.h"

namespace vantage::internal::solid {
namespace {

/// Twice the area in plan of (a, b, c); positive where they turn left.
double turn_in_plan(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Triangles thinner in plan than this part of their longest side have no direction that rounding would leave them.
constexpr double kThinnest = 1e-13;

/// The triangles near by, welded, about the origin, turned to face up.
Mesh triangles_near(const Mesh& surface, const Box& near, const Vec3& origin) {
  Mesh mesh;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Box box = core::triangle_box(surface, t);
    if (box.min.x() > near.max.x() || box.max.x() < near.min.x()) continue;
    if (box.min.y() > near.max.y() || box.max.y() < near.min.y()) continue;
    std::array<Vec3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = surface.vertices[surface.triangles[t][k]] - origin;
    const double turn = turn_in_plan(at[0], at[1], at[2]);
    const double longest = std::max({(at[1] - at[0]).head<2>().squaredNorm(), (at[2] - at[1]).head<2>().squaredNorm(),
                                     (at[0] - at[2]).head<2>().squaredNorm()});
    if (!(std::abs(turn) > kThinnest * longest)) continue;
    if (turn < 0) std::swap(at[1], at[2]);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), at.begin(), at.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return core::welded(mesh);
}

/// Whether all of `other` lies to the right of a side of `one`, or on it.
bool is_beside(const Mesh& mesh, const Triangle& one, const Triangle& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = mesh.vertices[one[k]], &b = mesh.vertices[one[(k + 1) % 3]];
    if (std::all_of(other.begin(), other.end(),
                    [&](std::uint32_t vertex) { return turn_in_plan(a, b, mesh.vertices[vertex]) <= 0; })) {
      return true;
    }
  }
  return false;
}

/// No two triangles overlap in plan, and at each edge no more than two meet, at both its ends in the same places.
bool is_height_field(const Mesh& mesh) {
  bool paired = true;
  const std::vector<core::EdgeUse> uses = core::edge_uses(mesh.triangles, mesh.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    paired = paired && (edge.size() == 1 || (edge.size() == 2 && edge[0].forward != edge[1].forward));
  });
  if (!paired) return false;
  Mesh plan = mesh;
  for (Vec3& vertex : plan.vertices) vertex.z() = 0;
  const core::TriangleTree tree(plan);
  for (std::uint32_t t = 0; t < plan.triangles.size(); ++t) {
    bool overlaps = false;
    tree.for_each_near(core::triangle_box(plan, t), 0, [&](std::uint32_t other) {
      if (other <= t || overlaps) return;
      overlaps = !is_beside(plan, plan.triangles[t], plan.triangles[other]) &&
                 !is_beside(plan, plan.triangles[other], plan.triangles[t]);
    });
    if (overlaps) return false;
  }
  return true;
}

/// From the z of a vertex of the ground to that of one above it.
using HeightOfVertex = std::function<double(double)>;
HeightOfVertex shifted(double by) {
  return [by](double z) { return z + by; };
}
HeightOfVertex at(double height) {
  return [height](double) { return height; };
}

/// The solid over and under the triangles, from one height of each vertex to another one.
Solid between(const Mesh& mesh, const HeightOfVertex& bottom, const HeightOfVertex& top,
              const GroundBandLabels& labels) {
  LabelledMesh solid;
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const bool is_top : {false, true}) {
    for (const Vec3& vertex : mesh.vertices) {
      solid.mesh.vertices.emplace_back(vertex.x(), vertex.y(), is_top ? top(vertex.z()) : bottom(vertex.z()));
    }
  }
  const auto add = [&](const Triangle& triangle, std::uint32_t label) {
    solid.mesh.triangles.push_back(triangle);
    solid.labels.push_back(label);
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    add({c, b, a}, labels.min);
    add({a + count, b + count, c + count}, labels.max);
  }
  const std::vector<core::EdgeUse> uses = core::edge_uses(mesh.triangles, mesh.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    if (edge.size() == 2) return;
    const std::uint32_t a = edge[0].forward ? edge[0].low : edge[0].high,
                        b = edge[0].forward ? edge[0].high : edge[0].low;
    add({a, b, b + count}, labels.edge);
    add({a, b + count, a + count}, labels.edge);
  });
  return Solid(solid, "heights above the ground");
}

/// Of triangles that lie over each other: the space over and under any of them, without what is too low or too high
/// above one of them.
Solid between_all(const Mesh& mesh, double min_m, double max_m, const GroundBandLabels& labels,
                  const core::ProgressReporter& progress) {
  const Box box = bounding_box(mesh);
  const double room = 1 + (box.max - box.min).maxCoeff() + max_m - min_m;
  const double lowest = box.min.z() + min_m - room, highest = box.max.z() + max_m + room;
  std::vector<Solid> columns, too_low, too_high;
  constexpr double kFacetsOfPrisms = 24;
  progress.expect(kFacetsOfPrisms * static_cast<double>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    progress.tick();
    Mesh one{{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]}, {{0, 1, 2}}};
    const auto prism = [&](const HeightOfVertex& bottom, const HeightOfVertex& top, std::uint32_t label) {
      return between(one, bottom, top, {label, label, label});
    };
    columns.push_back(prism(at(lowest), at(highest), labels.edge));
    too_low.push_back(prism(at(lowest), shifted(min_m), labels.min));
    too_high.push_back(prism(shifted(max_m), at(highest), labels.max));
  }
  const core::ProgressReporter one = progress.part(0, 0);  // asks only whether to go on
  return subtract(subtract(unite(columns, one), unite(too_low, one), one), unite(too_high, one), one);
}

}  // namespace

Solid make_ground_band(const Mesh& surface, double min_m, double max_m, const Box& near, const Vec3& origin,
                       const GroundBandLabels& labels, const core::ProgressReporter& progress) {
  const Mesh mesh = triangles_near(surface, near, origin);
  if (mesh.empty()) return Solid();
  if (!is_height_field(mesh)) return between_all(mesh, min_m, max_m, labels, progress);
  return between(mesh, shifted(min_m), shifted(max_m), labels);
}

}  // namespace vantage::internal::solid
