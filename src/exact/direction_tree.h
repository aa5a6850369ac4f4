// Which blockers may be seen in which directions: a quadtree over the chart that culls what is hidden.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/blocker.h"
#include "exact/chart.h"
#include "exact/range_region.h"

namespace vantage::exact {

/// Blockers stored one after another: blocker i owns the planes [first[i], first[i + 1]).
struct BlockerSet {
  std::vector<Plane> planes;
  std::vector<std::uint32_t> first{0};
  std::vector<std::uint32_t> polygon;  ///< scene polygon that each comes from

  std::size_t count() const { return polygon.size(); }
  std::span<const Plane> planes_of(std::size_t blocker) const {
    return {planes.data() + first[blocker], first[blocker + 1] - first[blocker]};
  }
};

/// Each cell keeps a lower bound on the envelope: the greatest, over the blockers and the range region, of the least
/// inverse depth that it has in the cell. A blocker whose inverse depth stays below that bound cannot be seen there.
/// Leaves list the blockers that may be seen and split while the lists are long, so the tree is fine only where the
/// view is.
class DirectionTree {
 public:
  /// Keeps references to both.
  DirectionTree(const BlockerSet& blockers, const RangeRegion& range);

  /// Whether something whose inverse depth is at most the least of `planes` may be seen anywhere.
  bool may_show(std::span<const Plane> planes) const;

  /// Adds blocker `index` of the set wherever it may be seen. False when that is nowhere.
  bool insert(std::uint32_t index);

  struct Leaf {
    ChartCell cell;
    double bound;                         ///< lower bound on the envelope in the cell (directions of |x| + |y| + z = 1)
    std::vector<std::uint32_t> blockers;  ///< ascending
  };
  /// The leaves, after the last insertion; lists are free of what later insertions have hidden.
  std::vector<Leaf> leaves() const;

  /// Blockers that may be seen in the direction of a chart point.
  std::span<const std::uint32_t> blockers_at(const ChartPoint& point) const;

 private:
  struct Node {
    ChartCell cell;
    double bound;
    std::uint32_t first_child = 0;  // 0: a leaf
    std::uint32_t child_count = 0;
    std::uint32_t list = 0;
    std::uint32_t depth = 0;
  };
  using QuadrantPlanes = std::vector<QuadrantLinear>;

  bool shows_below(std::uint32_t node, std::span<const QuadrantLinear> planes) const;
  bool insert_below(std::uint32_t node, std::uint32_t index, std::span<const QuadrantLinear> planes);
  void split(std::uint32_t node);
  void add_node(const ChartCell& cell, double bound, std::uint32_t depth);
  void prune(Node& node);
  double upper_bound(const Node& node, std::uint32_t index) const;

  const BlockerSet& blockers_;
  const RangeRegion& range_;
  std::vector<Node> nodes_;
  std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace vantage::exact
