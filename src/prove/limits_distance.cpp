// What lies too near to a triangle is convex, and holds it: no facet is so near, and one point of it is outside.
#include "prove/limits_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "prove/tree_search.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

/// Triangles to keep a distance from. Those that touch each other are one group.
struct TooNear {
  SceneTree tree;
  double distance_m = 0;

  void look(const LimitedVolume& volume, const LimitedVolume::Corners& facet, FacetFinding& finding) const {
    const Box box = box_of(facet);
    double needed = distance_m - volume.tolerance_of(facet);
    search_tree(
        tree, [&](const Box& node) { return distance_of_boxes(node, box) >= needed; },
        [&](std::uint32_t i) {
          const std::array<Vec3, 3> triangle = tree.pieces[i].first_three();
          const NearestPoints nearest = nearest_points(facet, triangle);
          if (surely_apart_by(nearest, facet, triangle) >= needed) return;
          finding.is_open = true;
          finding.broken.see(distance_m - at_most_from(triangle, nearest.on_a), nearest.on_a);
          needed = nearest.distance;
        });
  }
};

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

/// `inside`: points of which no facet is near, as facets have been looked at.
ClaimProof with_points_outside(const ClaimProof& claim, const LimitedVolume& volume, double distance_m,
                               const std::vector<Vec3>& points, const std::string& limit) {
  if (claim.verdict != ProofVerdict::proved) return claim;
  if (!points.empty() && !(distance_m > 2 * volume.tolerance_m())) {
    return not_proved(claim.name, "the distance is less than what numbers can tell");
  }
  for (const Vec3& point : points) {
    const std::optional<bool> is_outside = volume.is_outside(point);
    if (!is_outside) return not_proved(claim.name, "what it is about may be inside");
    if (!*is_outside) return volume.wrong(claim.name, {distance_m, point}, limit);
  }
  return claim;
}

}  // namespace

ClaimProof prove_clearance(const LimitedVolume& volume, const Clearance& clearance,
                           const core::ProgressReporter& progress) {
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

ClaimProof prove_min_range(const LimitedVolume& volume, double min_range_m, const std::vector<View>& parts,
                           const core::ProgressReporter& progress) {
  TooNear target{{}, min_range_m};
  std::vector<Piece> triangles;
  std::vector<Vec3> middles;
  for (const View& part : parts) {
    const Vec3 shift = part.origin - volume.origin();
    middles.push_back(shift);
    const std::vector<Vec3>& corners = part.whole;
    const Vec3 first = shift + corners[0];
    if (corners.size() == 1) triangles.push_back(Piece::triangle({first, first, first}, 0));
    for (std::size_t k = 2; k < corners.size(); ++k) {
      triangles.push_back(Piece::triangle({first, shift + corners[k - 1], shift + corners[k]}, 0));
    }
  }
  target.tree = make_tree(std::move(triangles));
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& facet, FacetFinding& finding) { target.look(volume, facet, finding); },
      progress);
  const std::string limit = "the least range";
  ClaimProof claim =
      volume.judged("min_range", findings, "no facet is too near to the target, which is outside", limit);
  return with_points_outside(claim, volume, min_range_m, middles, limit);
}

}  // namespace vantage::internal::prove
