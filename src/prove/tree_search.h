// Looking for pieces in a tree of boxes.
#pragma once

#include <array>
#include <cstdint>

#include "prove/scene_tree.h"

namespace vantage::internal::prove {

/// Visits the pieces, by their number in SceneTree::pieces, of all nodes but those whose box is `far`, and of
/// what lies below these.
template <typename Far, typename Visit>
void search_tree(const SceneTree& tree, const Far& far, const Visit& visit) {
  if (tree.nodes.empty()) return;
  std::array<std::uint32_t, 64> waiting;  // trees are balanced: 64 levels hold any
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t n = waiting[--count];
    const TreeNode& node = tree.nodes[n];
    if (far(node.box)) continue;
    if (node.second == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) visit(i);
      continue;
    }
    waiting[count++] = node.second;
    waiting[count++] = n + 1;
  }
}

}  // namespace vantage::internal::prove
