// The triangulation of the floor over one quadrant of the octahedral map.
#pragma once

#include <string>
#include <vector>

#include "exact/constraint_graph.h"
#include "exact/quadrant_mesh.h"

namespace vantage::internal::exact {

/// Where the volume is beyond the floor. A vertex below the graph's point count is the graph's, others index `added`
/// after that.
struct FloorMesh {
  std::vector<Triangle> triangles;      ///< as the map is seen from above: towards the centre they are to be reversed
  std::vector<std::uint32_t> plane_of;  ///< per triangle: the plane of the floor
  std::vector<OctahedralPoint> added;   ///< where creases cross
  std::vector<double> added_gauge;
  std::vector<std::uint32_t> graph_vertex;
  std::vector<double> graph_gauge;          ///< neighbouring quadrants may know a lower one
  std::vector<ConstraintGraph::Edge> base;  ///< edges on the horizon, as the triangles run them
  std::string failure;                      ///< as in QuadrantMesh
  std::vector<OctahedralPoint> rim_splits;  ///< the same
};

/// As mesh_quadrant, but for the floor, which `envelope` must have. Its facets lie beyond it, if anything.
FloorMesh mesh_floor(int quadrant, const ConstraintGraph& graph, const Envelope& envelope, double snap);

}  // namespace vantage::internal::exact
