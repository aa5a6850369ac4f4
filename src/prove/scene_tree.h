// The triangles of a scene that may hide a target, in a tree of boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// What of a triangle lies in front of the target: a convex polygon of three or four corners, or nothing.
struct Piece {
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< about View::origin
  std::uint32_t count = 0;                                                              ///< of the corners
  std::uint32_t of = 0;                                                                 ///< the scene's triangle

  static Piece triangle(const std::array<Vec3, 3>& corners, std::uint32_t of) {
    return {{corners[0], corners[1], corners[2], Vec3::Zero()}, 3, of};
  }
  std::array<Vec3, 3> first_three() const { return {corners[0], corners[1], corners[2]}; }
  std::span<const Vec3> polygon() const { return {corners.data(), count}; }
};

/// Nodes lie in depth-first order: the first child of an inner node is the next one.
struct TreeNode {
  Box box;                           ///< empty where all its pieces are
  std::uint32_t begin = 0, end = 0;  ///< of the pieces, in SceneTree::pieces
  std::uint32_t second = 0;          ///< the second child; 0: a leaf
};

struct SceneTree {
  std::vector<Piece> pieces;
  std::vector<TreeNode> nodes;  ///< none where there are no pieces
};

/// Halved again and again by the middles of the boxes of `scene`'s triangles, as their stored numbers add up, so that a
/// checker of certificates builds the same tree (vantage/prove.h). Leaves hold one or two pieces, by number. Cost:
/// O(n log n).
SceneTree make_tree(const Mesh& scene, std::vector<Piece> pieces);
/// The same by the middles of the pieces themselves. None may be empty.
SceneTree make_tree(std::vector<Piece> pieces);

}  // namespace vantage::internal::prove
