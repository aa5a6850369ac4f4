#include "depth/gl_clusters.h"

#include "core/walk_bvh.h"
#include "depth/depth.h"
#include "scene/prepared_data.h"

namespace vantage::internal::depth {
namespace {

// Fewer draw more commands, more draw more triangles in vain.
constexpr std::size_t kClusterPolygons = 128;

struct Range {
  std::size_t begin, end;
};

/// The range of the polygons under a node: they lie together, the left child's first.
Range polygons_under(const std::vector<core::BvhNode>& nodes, const core::BvhNode& node) {
  const core::BvhNode *first = &node, *last = &node;
  while (!first->leaf()) first = &nodes[first->first];
  while (!last->leaf()) last = &nodes[last->first + 1];
  return {first->first, std::size_t{last->first} + last->count};
}

void append_cluster(const PreparedScene::Data& data, const Range& polygons, ClusteredTriangles& result) {
  TriangleCluster cluster{static_cast<std::uint32_t>(result.indices.size()), 0, {}};
  for (std::size_t polygon = polygons.begin; polygon < polygons.end; ++polygon) {
    const auto corners = data.corners_of(polygon);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      for (const std::uint32_t vertex : {corners[0], corners[k], corners[k + 1]}) result.indices.push_back(vertex);
    }
    for (const std::uint32_t vertex : corners) cluster.bounds.extend(data.vertices[vertex]);
  }
  cluster.count = static_cast<std::uint32_t>(result.indices.size()) - cluster.first;
  if (cluster.count > 0) result.clusters.push_back(cluster);
}

/// Whether a box about `centre`, seen from the origin, may reach into the face's pyramid.
bool may_show(const CubeFace& face, const Vec3& centre, const Vec3& half) {
  const double rounding = 1e-12 * (centre.cwiseAbs().sum() + half.sum());
  const auto highest = [&](const Vec3& axis) { return axis.dot(centre) + axis.cwiseAbs().dot(half) + rounding; };
  if (highest(face.forward) < 0) return false;
  for (const Vec3& side : {face.right, face.up}) {
    if (highest(face.forward - side) < 0 || highest(face.forward + side) < 0) return false;
  }
  return true;
}

}  // namespace

ClusteredTriangles cluster_triangles(const PreparedScene::Data& data) {
  ClusteredTriangles result;
  const auto is_too_large = [&](const core::BvhNode& node) {
    const Range polygons = polygons_under(data.bvh.nodes, node);
    if (!node.leaf() && polygons.end - polygons.begin > kClusterPolygons) return true;
    append_cluster(data, polygons, result);
    return false;
  };
  core::walk_bvh(data.bvh, is_too_large, [](std::uint32_t) {});
  return result;
}

void append_commands(const std::vector<TriangleCluster>& clusters, const Vec3& eye, double range, int face,
                     std::vector<DrawCommand>& commands) {
  const CubeFace& axes = cube_faces()[face];
  bool follows = false;  // whether the last command ends where this cluster begins
  for (const TriangleCluster& cluster : clusters) {
    const Vec3 half = 0.5 * (cluster.bounds.max - cluster.bounds.min);
    const Vec3 centre = 0.5 * (cluster.bounds.max + cluster.bounds.min) - eye;
    const bool near = (centre.cwiseAbs() - half).cwiseMax(0).norm() <= range * (1 + 1e-9);
    const bool drawn = near && may_show(axes, centre, half);
    if (drawn && follows) {
      commands.back().count += cluster.count;
    } else if (drawn) {
      commands.push_back({cluster.count, 1, cluster.first, 0, static_cast<std::uint32_t>(face)});
    }
    follows = drawn;
  }
}

}  // namespace vantage::internal::depth
