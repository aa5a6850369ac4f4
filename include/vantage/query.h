// Point queries against the exact visibility of a target, without a mesh.
#pragma once

#include <string>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

struct PointAnswer {
  bool inside = false;  ///< the whole target is visible, in range, and the point is within the navigation limits
  double margin_m = 0;  ///< signed distance to the volume's boundary along the line to the target's centre, positive
                        ///< inside; navigation limits bound it too, the target itself, where the line ends, does not.
                        ///< Minus infinity where no point of that line is in the volume
  std::vector<std::string> blocked_by;  ///< names of the scene objects that hide part of the target, sorted, no repeats
  bool out_of_range = false;
  bool behind_target = false;  ///< never for a point that is seen from all sides
  std::vector<std::string>
      outside_of;  ///< limits that the point breaks: "altitude min", "boxes", "keep_out 0", "mesh NAME"
};

/// Answers for many points (scene frame, metres), in their order; exact, no tolerance. Uses the threads of the caller's
/// arena (TBB). Cost: one walk of the scene's hierarchy a point, and a few passes over the triangles of each navigation
/// mesh. Throws Error(input) for a point that is not finite, and for targets and ranges as compute_visibility does.
std::vector<PointAnswer> query_points(const PreparedScene& scene, const Target& target, const Sensor& sensor,
                                      const Navigation& navigation, const std::vector<Vec3>& points);

}  // namespace vantage
