// The target and the scene's polygons in the target's own frame.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "scene/prepared_data.h"
#include "vantage/geometry.h"
#include "vantage/target.h"

namespace vantage::internal::target {

/// The target in its own frame, with what every blocker needs of it worked out once. `centre` is the origin.
struct LocalTarget {
  struct Edge {
    Eigen::Vector2d outward;  ///< unit normal of the edge, away from the target
    double distance;          ///< of the edge's line from the centre; > 0
  };
  std::vector<Eigen::Vector2d> vertices;                       ///< counter-clockwise about the origin, metres
  std::vector<Edge> edges;                                     ///< edge i runs from vertex i to vertex i + 1
  double radius = 0;                                           ///< of the farthest vertex from the origin
  double clearance = std::numeric_limits<double>::infinity();  ///< of the nearest edge's line from the origin
  double slack = 0;     ///< points this near to the plane, or to an edge's line, are on it (Lengths::slack)
  double rounding = 0;  ///< of coordinates (Lengths::rounding)
};
LocalTarget make_local_target(const std::vector<Eigen::Vector2d>& polygon, double slack, double rounding);

/// Corners of a scene polygon in the target's frame.
void local_polygon(const PreparedScene::Data& scene, const TargetFrame& frame, std::uint32_t polygon,
                   std::vector<Vec3>& corners);

}  // namespace vantage::internal::target
