// The cells of the grid that hold nothing but range sphere, cut in two.
#pragma once

#include <vector>

#include "exact/constraint_graph.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// Triangles on the range sphere.
struct RangeCells {
  std::vector<Vec3> vertices;  ///< target's frame, shrunk; before them one place for each vertex of the graph
  std::vector<Triangle> triangles;
  std::vector<ConstraintGraph::Edge> base;  ///< edges on the horizon, as the triangles run them
};

/// Numbers the nodes of the graph's grid that have no vertex yet.
RangeCells cut_range_cells(ConstraintGraph& graph, const OctahedralGrid& grid, const target::RangeRegion& range);

}  // namespace vantage::internal::exact
