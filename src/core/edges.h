// The edges of an indexed mesh and the triangles that use them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// One side of one triangle. A triangle with a repeated vertex has a side with low == high.
struct EdgeUse {
  std::uint32_t low, high;  ///< vertices, low <= high
  std::uint32_t triangle;
  bool forward;  ///< the triangle runs it from low to high
};

/// The 3 F sides of all triangles, sorted by (low, high, triangle), so that those of one edge are neighbours. Linear
/// time. Throws Error(input) naming the triangle when an index is not below `vertices`.
VANTAGE_INTERNAL_API std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles, std::size_t vertices);

/// Calls `visit` with the uses of each edge in turn.
template <typename Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

/// Disjoint sets of 0 .. size - 1.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size);
  std::uint32_t find(std::uint32_t element);
  void join(std::uint32_t a, std::uint32_t b);
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> parent_;
  std::size_t count_;
};

}  // namespace vantage::internal::core
