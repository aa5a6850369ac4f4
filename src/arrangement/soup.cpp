#include "arrangement/soup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/edges.h"
#include "core/exact_crossing.h"
#include "core/orientation.h"
#include "core/walk_bvh.h"

namespace vantage::internal::arrangement {
namespace {

/// The same on every machine (PCG hash, Jarzynski and Olano 2020).
std::uint32_t random_number(std::uint32_t& state) {
  state = state * 747796405u + 2891336453u;
  const std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

/// Vectors with coordinates between -1 and 1. Along each axis no two are nearer to each other than half of what they
/// would be at equal distances: many walls lie in planes across an axis.
std::vector<Vec3> moves_of(std::size_t count, std::uint32_t seed) {
  std::vector<Vec3> moves(count);
  std::vector<std::uint32_t> places(count);
  for (int axis = 0; axis < 3; ++axis) {
    std::iota(places.begin(), places.end(), 0u);
    for (std::size_t i = count; i > 1; --i) std::swap(places[i - 1], places[random_number(seed) % i]);
    for (std::size_t i = 0; i < count; ++i) {
      const double place = places[i] + 0.25 + 0.5 * (random_number(seed) * 0x1p-32);
      moves[i][axis] = 2 * place / static_cast<double>(count) - 1;
    }
  }
  return moves;
}

bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto flat = [&](const Vec3& p) { return Eigen::Vector2d(p[axis], p[(axis + 1) % 3]); };
    if (core::turn(flat(a), flat(b), flat(c)) != 0) return false;
  }
  return true;
}

}  // namespace

std::optional<Soup> Soup::of(std::span<const Operand> operands, double step, std::uint32_t seed) {
  Soup soup;
  const std::vector<Vec3> moves = moves_of(operands.size(), seed);
  for (std::uint32_t m = 0; m < operands.size(); ++m) {
    const Mesh& mesh = *operands[m].mesh;
    const Vec3 move = (m > 0 ? step : 0) * moves[m];
    const auto first = static_cast<std::uint32_t>(soup.points_.size());
    soup.given_.insert(soup.given_.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Vec3& vertex : mesh.vertices) soup.points_.push_back(vertex + move);
    const auto first_facet = static_cast<std::uint32_t>(soup.facets_.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      auto [a, b, c] = mesh.triangles[t];
      if (operands[m].is_complement) std::swap(b, c);
      soup.facets_.push_back({{first + a, first + b, first + c}, {}, m, false, Vec3::Zero(), 0, t});
    }
    if (!soup.add_edges(first_facet)) return std::nullopt;
  }
  for (const Vec3& point : soup.points_) soup.largest_ = std::max(soup.largest_, point.cwiseAbs().maxCoeff());
  for (Facet& facet : soup.facets_) {
    const auto& [a, b, c] = facet.corners;
    const Vec3 &p = soup.points_[a], &q = soup.points_[b], &r = soup.points_[c];
    facet.is_flat = has_no_area(p, q, r);
    const core::BoundedVec3 normal = core::cross(core::bounded_difference(q, p), core::bounded_difference(r, p));
    facet.normal = {normal[0].near(), normal[1].near(), normal[2].near()};
    constexpr double kRounding = 0x1p-52;
    facet.off_by = 0;
    for (const core::Bounded& one : normal) facet.off_by = std::max(facet.off_by, one.error + kRounding * one.size());
  }
  soup.build_bvh();
  return soup;
}

bool Soup::add_edges(std::uint32_t first_facet) {
  std::vector<Triangle> triangles;
  for (std::size_t f = first_facet; f < facets_.size(); ++f) triangles.push_back(facets_[f].corners);
  const std::vector<core::EdgeUse> uses = core::edge_uses(triangles, points_.size());
  bool is_closed = true;
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    if (edge.size() != 2 || edge[0].low == edge[0].high || edge[0].forward == edge[1].forward) {
      is_closed = false;
      return;
    }
    const bool first_is_forward = edge[0].forward;
    const std::uint32_t forth = first_facet + edge[first_is_forward ? 0 : 1].triangle,
                        back = first_facet + edge[first_is_forward ? 1 : 0].triangle;
    const auto number = static_cast<std::uint32_t>(edges_.size());
    edges_.push_back({edge[0].low, edge[0].high, {forth, back}});
    facets_[forth].edges[facets_[forth].corner_of(edge[0].low)] = number;
    facets_[back].edges[facets_[back].corner_of(edge[0].high)] = number;
  });
  return is_closed;
}

void Soup::build_bvh() {
  std::vector<core::Bounds> boxes;
  boxes.reserve(facets_.size());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const Facet& facet : facets_) {
    Box box;
    for (const std::uint32_t corner : facet.corners) box.extend(points_[corner]);
    core::Bounds& bounds = boxes.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      bounds.min[i] = std::nextafter(static_cast<float>(box.min[axis]), -kInfinity);
      bounds.max[i] = std::nextafter(static_cast<float>(box.max[axis]), kInfinity);
    }
  }
  bvh_ = core::build_bvh(boxes, order_);
}

core::Bounded Soup::height(std::uint32_t facet, std::uint32_t point) const {
  const auto& [a, b, c] = facets_[facet].corners;
  const Vec3 &p = points_[a], &q = points_[b], &r = points_[c];
  const core::BoundedVec3 normal = core::cross(core::bounded_difference(q, p), core::bounded_difference(r, p));
  return core::dot(normal, core::bounded_difference(points_[point], p));
}

std::optional<std::uint64_t> Soup::level_at(std::uint32_t point, std::uint32_t mesh,
                                            std::span<const Operand> operands) const {
  const Vec3& p = points_[point];
  std::vector<int> windings(operands.size(), 0);
  const auto is_above = [&](const core::BvhNode& node) {
    const auto& [low, high] = node.bounds;
    return p.x() >= low[0] && p.x() <= high[0] && p.y() >= low[1] && p.y() <= high[1] && p.z() <= high[2];
  };
  const bool is_off_surface = core::walk_bvh(bvh_, is_above, [&](std::uint32_t item) {
    const Facet& facet = facets_[order_[item]];
    if (facet.mesh == mesh) return true;
    const core::TriangleCorners corners{points_[facet.corners[0]], points_[facet.corners[1]],
                                        points_[facet.corners[2]]};
    if (core::is_on_triangle(p, corners)) return false;
    windings[facet.mesh] += core::crossing_above(p, corners);
    return true;
  });
  if (!is_off_surface) return std::nullopt;
  std::uint64_t level = 0;
  for (std::size_t m = 0; m < operands.size(); ++m) {
    if (m == mesh) continue;
    const int winding = windings[m] + (operands[m].is_complement ? 1 : 0);
    if (winding != 0 && winding != 1) return std::nullopt;
    if (winding == 1) level += operands[m].weight;
  }
  return level;
}

}  // namespace vantage::internal::arrangement
