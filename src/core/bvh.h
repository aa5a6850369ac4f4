// Bounding volume hierarchy over boxes: binned surface-area heuristic (Wald 2007).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vantage::internal::core {

/// Axis-aligned box in single precision, rounded outward: it holds the double box that it was made from.
struct Bounds {
  std::array<float, 3> min, max;
};

struct BvhNode {
  Bounds bounds;
  std::uint32_t first;  ///< leaf: first item; inner node: index of the left child, the right one follows it
  std::uint32_t count;  ///< leaf: number of items; inner node: 0
  bool leaf() const { return count > 0; }
};

struct Bvh {
  std::vector<BvhNode> nodes;  ///< the root comes first; empty when there are no items

  /// The ranks of nodes in a hierarchy of groups: 0 for the nodes above the groups, and for a group's nodes numbers
  /// from 1 on, in the order of the groups. Else empty.
  std::vector<std::uint32_t> rank = {};

  /// Whether a node, one of `nodes`, holds several groups: then it depends on which groups there are.
  bool is_above_groups(const BvhNode& node) const {
    return !rank.empty() && rank[static_cast<std::size_t>(&node - nodes.data())] == 0;
  }
};

/// Builds the hierarchy and the order in which the items must be stored: item i of a leaf is `order[i]` of the input.
/// Deterministic for any number of threads. Cost: O(n log n).
Bvh build_bvh(const std::vector<Bounds>& items, std::vector<std::uint32_t>& order);

/// The same over groups of items. What is below a group's root depends on the group's items and their order alone: a
/// walk that takes the nearest first, and enters all nodes above groups, meets the same nodes of a group in the same
/// order whatever other groups there are. `group_of`: the group of each item, any numbers; groups are in their order.
Bvh build_bvh_of_groups(const std::vector<Bounds>& items, const std::vector<std::uint64_t>& group_of,
                        std::vector<std::uint32_t>& order);

}  // namespace vantage::internal::core
