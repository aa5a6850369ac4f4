#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "prove/limit_proof.h"
#include "prove/too_near.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t at) {
  while (parent[at] != at) at = parent[at] = parent[parent[at]];
  return at;
}

/// One corner for each group of triangles that touch each other, in the same places. Nothing of a group that reaches
/// out of the box.
std::vector<Vec3> corners_of_groups_within(const Mesh& mesh, const Vec3& origin, const Box& box) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), parent(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  parent = order;
  const auto key = [&](std::uint32_t v) {
    return std::tuple(mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const auto join = [&](std::uint32_t a, std::uint32_t b) { parent[root_of(parent, a)] = root_of(parent, b); };
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) join(order[i], order[i - 1]);
  }
  for (const Triangle& t : mesh.triangles) {
    join(t[0], t[1]);
    join(t[0], t[2]);
  }
  std::map<std::uint32_t, std::pair<Vec3, bool>> groups;  // a corner, and whether all are in the box
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3 at = mesh.vertices[v] - origin;
      const bool is_within = (at.array() > box.min.array()).all() && (at.array() < box.max.array()).all();
      const auto [group, is_new] = groups.try_emplace(root_of(parent, v), at, is_within);
      group->second.second = group->second.second && is_within;
    }
  }
  std::vector<Vec3> corners;
  for (const auto& [root, group] : groups) {
    if (group.second) corners.push_back(group.first);
  }
  return corners;
}

}  // namespace

template <>
ClaimProof prove_limit<Limit::clearance>(const Clearance& clearance, const Claimant& of,
                                         const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  const Mesh& mesh = *clearance.obstacles;
  TooNear obstacles{{}, clearance.distance_m};
  std::vector<Piece> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.triangles[t][k]] - volume.origin();
    if (distance_of_boxes(box_of(corners), volume.box()) >= clearance.distance_m) continue;
    triangles.push_back(Piece::triangle(corners, t));
  }
  obstacles.tree = make_tree(std::move(triangles));
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& facet, FacetFinding& finding) { obstacles.look(volume, facet, finding); },
      progress);
  const std::string limit = "the clearance";
  ClaimProof claim =
      volume.judged("clearance", findings, "no facet is too near to a triangle, and none is inside", limit);
  if (claim.verdict != ProofVerdict::proved) return claim;
  return with_points_outside(claim, volume, clearance.distance_m,
                             corners_of_groups_within(mesh, volume.origin(), volume.box()), limit);
}

}  // namespace vantage::internal::prove
