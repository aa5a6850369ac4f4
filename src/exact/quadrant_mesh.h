// The triangulation of one quadrant of the octahedral map: docs/theory.md, "Triangulation".
#pragma once

#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "exact/constraint_graph.h"
#include "exact/direction_tree.h"
#include "exact/floor.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// What is not range cells. A vertex below the graph's point count is the graph's, others index `added` after that.
struct QuadrantMesh {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> blocker_of;    ///< per triangle: index of the blocker, or GaugeValue::kRange
  std::vector<OctahedralPoint> added;       ///< vertices that refinement made
  std::vector<double> added_gauge;          ///< the inverse depth there
  std::vector<std::uint32_t> graph_vertex;  ///< the graph's vertices that lie in the quadrant
  std::vector<double> graph_gauge;          ///< the inverse depth there; neighbouring quadrants may know a greater one
  std::vector<ConstraintGraph::Edge> base;  ///< edges on the horizon, as the triangles run them
  std::vector<OctahedralPoint> border_splits;  ///< where an edge of a range cell had to be split
  std::string failure;  ///< if not empty, creases meet in a way that the triangulation has no place for: the reason
  std::vector<OctahedralPoint> rim_splits;  ///< then: where a crease has split the rim
};

/// The envelope that is meshed, and how finely.
struct Envelope {
  const BlockerSet& blockers;
  const DirectionTree& tree;
  const target::RangeRegion& range;
  const Floor* floor;  ///< what is not beyond it is left out; null where there is none
  double tolerance_m;
  const core::ProgressReporter& progress;
};

/// A constrained Delaunay triangulation of the graph's creases in quadrant 0..3 (bit 0: a < 0, bit 1: b < 0).
/// Triangles that lie more than the tolerance inside the sphere get a point in the middle, and so do those above which
/// the gauge rises (a crease that rounding has lost), until there are none. Points closer than `snap` cannot be told
/// apart: if it fails, a larger one may help. Throws Error(cancelled).
QuadrantMesh mesh_quadrant(int quadrant, const ConstraintGraph& graph, const OctahedralGrid& grid,
                           const Envelope& envelope, double snap);

}  // namespace vantage::internal::exact
