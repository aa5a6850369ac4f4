// The cells of the grid that hold nothing but range sphere, cut in two.
#pragma once

#include <vector>

#include "exact/constraint_graph.h"
#include "exact/range_region.h"

namespace vantage::exact {

/// Triangles on the range sphere. A corner below `kOwn` is a vertex of the constraint graph; kOwn + i is
/// `vertices[i]`.
struct RangeCells {
  static constexpr std::uint32_t kOwn = 1u << 31;

  std::vector<Vec3> vertices;  ///< target's frame, not shrunk
  std::vector<Triangle> triangles;
  std::vector<ConstraintGraph::Edge> base;  ///< edges on the horizon, as the triangles run them
};

/// Numbers the nodes of the graph's grid that have no vertex yet.
RangeCells cut_range_cells(ConstraintGraph& graph, const ChartGrid& grid, const RangeRegion& range);

}  // namespace vantage::exact
