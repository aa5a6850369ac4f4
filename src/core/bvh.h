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
};

/// Builds the hierarchy and the order in which the items must be stored: item i of a leaf is `order[i]` of the input.
/// Deterministic for any number of threads. Cost: O(n log n).
Bvh build_bvh(const std::vector<Bounds>& items, std::vector<std::uint32_t>& order);

}  // namespace vantage::internal::core
