#include "solid/ground_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/edges.h"
#include "core/pieces.h"
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

/// Triangles about the origin, and for each of them the rounding of its coordinates, metres: from before the origin was
/// subtracted, and where a corner was computed to lie on a side. A part of a triangle keeps that of the whole.
struct NearGround {
  Mesh mesh;
  std::vector<double> rounding;
};

NearGround with_roundings(const Mesh& mesh, const Vec3& origin) {
  constexpr double kRoundings = 8 * std::numeric_limits<double>::epsilon();
  NearGround ground{mesh, {}};
  for (const Triangle& triangle : mesh.triangles) {
    double largest = 0;
    for (const std::uint32_t v : triangle) {
      const Vec3& at = mesh.vertices[v];
      largest = std::max({largest, at.cwiseAbs().maxCoeff(), (at + origin).cwiseAbs().maxCoeff()});
    }
    ground.rounding.push_back(kRoundings * largest);
  }
  return ground;
}

/// The vertices in plan, without triangles.
Mesh flat_plan(const Mesh& mesh) {
  Mesh plan;
  for (const Vec3& vertex : mesh.vertices) plan.vertices.emplace_back(vertex.x(), vertex.y(), 0);
  return plan;
}

/// Corners that stand in one place to the rounding of all triangles at one of them become one corner: that one goes to
/// the other. Those that stay are not moved, so no corner is moved twice.
void join_corners(NearGround& ground, const core::ProgressReporter& progress) {
  Mesh& mesh = ground.mesh;
  core::drop_unused_vertices(mesh);
  std::vector<double> rounding(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) rounding[v] = std::min(rounding[v], ground.rounding[t]);
  }
  Mesh plan = flat_plan(mesh);
  std::vector<std::uint32_t> joined(mesh.vertices.size());
  for (std::uint32_t v = 0; v < joined.size(); ++v) {
    joined[v] = v;
    plan.triangles.push_back({v, v, v});
  }
  const core::TriangleTree tree(plan);
  for (std::uint32_t v = 0; v < joined.size(); ++v) {
    progress.tick();
    tree.for_each_near(core::triangle_box(plan, v), rounding[v], [&](std::uint32_t other) {
      progress.tick();
      if (other >= joined[v] || joined[other] != other) return;
      if ((mesh.vertices[other] - mesh.vertices[v]).cwiseAbs().maxCoeff() <= rounding[v]) joined[v] = other;
    });
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Triangle at = {joined[a], joined[b], joined[c]};
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
    mesh.triangles[kept] = at;
    ground.rounding[kept++] = ground.rounding[t];
  }
  mesh.triangles.resize(kept);
  ground.rounding.resize(kept);
  core::drop_unused_vertices(mesh);
}

/// A side of a triangle that no other triangle runs the other way, in plan.
struct OpenSide {
  std::uint32_t from, to, triangle;
};

std::vector<OpenSide> open_sides(const Mesh& mesh) {
  std::vector<OpenSide> sides;
  const std::vector<core::EdgeUse> uses = core::edge_uses(mesh.triangles, mesh.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    if (edge.size() > 1) return;
    const auto& [low, high, triangle, forward] = edge[0];
    sides.push_back(forward ? OpenSide{low, high, triangle} : OpenSide{high, low, triangle});
  });
  return sides;
}

/// Calls `visit(one, other)` for open sides of two triangles that run along each other in plan, to the rounding of the
/// one, for more than a point. Twice for two as a rule, in either order.
template <typename Visit>
void for_each_touching(const NearGround& ground, const std::vector<OpenSide>& sides,
                       const core::ProgressReporter& progress, const Visit& visit) {
  Mesh plan = flat_plan(ground.mesh);
  for (const OpenSide& side : sides) plan.triangles.push_back({side.from, side.to, side.to});
  const core::TriangleTree tree(plan);
  for (std::uint32_t i = 0; i < sides.size(); ++i) {
    const Vec3 a = plan.vertices[sides[i].from], along = plan.vertices[sides[i].to] - a;
    const double length = along.norm(), rounding = ground.rounding[sides[i].triangle];
    progress.tick();
    tree.for_each_near(core::triangle_box(plan, i), rounding, [&](std::uint32_t k) {
      progress.tick();
      if (k == i || sides[k].triangle == sides[i].triangle) return;
      const Vec3 p = plan.vertices[sides[k].from] - a, q = plan.vertices[sides[k].to] - a;
      const auto off = [&](const Vec3& v) { return std::abs(along.x() * v.y() - along.y() * v.x()) / length; };
      if (off(p) > rounding || off(q) > rounding) return;
      const double s = p.dot(along) / length, t = q.dot(along) / length;
      if (std::min(std::max(s, t), length) - std::max(std::min(s, t), 0.0) > rounding) visit(sides[i], sides[k]);
    });
  }
}

/// Where a corner of one triangle lies between the ends of a side of another one, to the rounding of that one, it is
/// split there: grounds are often made so. Each split moves the side by no more than that rounding in plan, and along z
/// by as much again times one and its slope; a side with n corners between its ends is split about log2(n) times one
/// after another. A corner as near to an end of the side as rounding is left alone. Returns false where corners are
/// left that would take more rounds.
bool split_at_corners(NearGround& ground, const core::ProgressReporter& progress) {
  // Two rounds at the most halve what has corners yet of a side, which is no longer than 2^51 roundings; a triangle has
  // three sides.
  constexpr int kRounds = 3 * 2 * 52;
  Mesh& mesh = ground.mesh;
  for (int round = 0; round < kRounds; ++round) {
    struct Split {
      std::uint32_t from, to, corner;
      double from_middle;  ///< as a part of the side
    };
    std::vector<std::optional<Split>> splits(mesh.triangles.size());
    for_each_touching(ground, open_sides(mesh), progress, [&](const OpenSide& side, const OpenSide& other) {
      const Vec3 a = mesh.vertices[side.from], along = mesh.vertices[side.to] - a;
      const double length = along.head<2>().norm(), rounding = ground.rounding[side.triangle];
      for (const std::uint32_t corner : {other.from, other.to}) {
        const Vec3 at = mesh.vertices[corner] - a;
        const double share = at.head<2>().dot(along.head<2>()) / (length * length);
        if (!(share * length > rounding && (1 - share) * length > rounding)) continue;
        const double off = std::abs(at.z() - share * along.z());
        if (off > rounding * (1 + std::abs(along.z()) / length)) continue;
        const Triangle& corners = mesh.triangles[side.triangle];
        if (std::find(corners.begin(), corners.end(), corner) != corners.end()) continue;
        std::optional<Split>& known = splits[side.triangle];
        const double from_middle = std::abs(share - 0.5);
        if (!known || from_middle < known->from_middle) known = {side.from, side.to, corner, from_middle};
      }
    });
    bool is_split = false;
    for (std::uint32_t t = 0; t < splits.size(); ++t) {
      if (!splits[t]) continue;
      const auto& [from, to, corner, unused] = *splits[t];
      Triangle second = mesh.triangles[t];
      std::replace(second.begin(), second.end(), from, corner);
      std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), to, corner);
      mesh.triangles.push_back(second);
      ground.rounding.push_back(ground.rounding[t]);
      is_split = true;
    }
    if (!is_split) return true;
  }
  return false;
}

/// No triangle was turned over where its corners were moved.
bool faces_up(const Mesh& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return turn_in_plan(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) > 0;
  });
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

/// No two triangles overlap in plan, and where two touch along a side they have its ends in common, in space.
bool is_height_field(const NearGround& ground, const core::ProgressReporter& progress) {
  const Mesh& mesh = ground.mesh;
  bool paired = true;
  const std::vector<core::EdgeUse> uses = core::edge_uses(mesh.triangles, mesh.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    paired = paired && (edge.size() == 1 || (edge.size() == 2 && edge[0].forward != edge[1].forward));
  });
  for_each_touching(ground, open_sides(mesh), progress, [&](const OpenSide&, const OpenSide&) { paired = false; });
  if (!paired) return false;
  Mesh plan = mesh;
  for (Vec3& vertex : plan.vertices) vertex.z() = 0;
  const core::TriangleTree tree(plan);
  for (std::uint32_t t = 0; t < plan.triangles.size(); ++t) {
    progress.tick();
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

/// The band of triangles that lie over each other: the space over and under any of them, without what is too low or too
/// high above one of them.
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
  NearGround ground = with_roundings(mesh, origin);
  join_corners(ground, progress);
  const bool is_sound = split_at_corners(ground, progress) && faces_up(ground.mesh);
  if (!is_sound || !is_height_field(ground, progress)) {
    return between_all(is_sound ? ground.mesh : mesh, min_m, max_m, labels, progress);
  }
  return between(ground.mesh, shifted(min_m), shifted(max_m), labels);
}

}  // namespace vantage::internal::solid
