// The triangles of a scene that may hide a target, in a tree of boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

struct TreeTriangle {
  std::array<Vec3, 3> corners;  ///< about the origin that was given
  std::uint32_t of = 0;         ///< the scene's triangle that it is, or is a part of
};

/// Nodes lie in depth-first order: the first child of an inner node is the next one.
struct TreeNode {
  Box box;
  std::uint32_t begin = 0, end = 0;  ///< of the triangles, in SceneTree::triangles
  std::uint32_t second = 0;          ///< the second child; 0: a leaf
};

struct SceneTree {
  std::vector<TreeTriangle> triangles;
  std::vector<TreeNode> nodes;  ///< none where there are no triangles
};

/// Leaves hold few triangles. Cost: O(n log n).
SceneTree make_tree(std::vector<TreeTriangle> triangles);

}  // namespace vantage::internal::prove
