// The scene's triangles for OpenGL, in clusters that lie together: what is out of range or beside a face is not drawn.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::depth {

struct TriangleCluster {
  std::uint32_t first, count;  ///< indices, three a triangle
  Box bounds;                  ///< relative to the scene's origin
};

struct ClusteredTriangles {
  std::vector<std::uint32_t> indices;  ///< into PreparedScene::Data::vertices
  std::vector<TriangleCluster> clusters;
};

/// The fans of the polygons, in the order of the scene's hierarchy; a cluster is a subtree.
ClusteredTriangles cluster_triangles(const PreparedScene::Data& data);

/// As glMultiDrawElementsIndirect reads it.
struct DrawCommand {
  std::uint32_t count, instances, first, base_vertex, base_instance;
};

/// Appends what `face` of the cube about `eye` (relative to the scene's origin) may show within `range`;
/// `base_instance` is the face.
void append_commands(const std::vector<TriangleCluster>& clusters, const Vec3& eye, double range, int face,
                     std::vector<DrawCommand>& commands);

}  // namespace vantage::internal::depth
