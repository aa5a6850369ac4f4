// Navigation limits as a set of points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/navigation.h"
#include "verify/closed_mesh.h"
#include "verify/ground_probe.h"
#include "verify/obstacle_probe.h"

namespace vantage::internal::verify {

class Limits {
 public:
  /// Throws Error(input) for a reversed band, box or zone, for a zone without corners and for a keep-in mesh that is
  /// not closed.
  Limits(const Navigation& navigation, const Vec3& origin);

  /// Name of the first limit that the local point breaks; nothing where it keeps them all. Borders are allowed.
  std::optional<std::string> broken_by(const Vec3& point) const;

  /// Whether a volume may leave the point out for one of the limits, though it keeps them all: what is cut away for the
  /// clearance reaches too far beside edges and round corners (docs/mission-file.md).
  bool may_leave_out(const Vec3& point) const;

 private:
  Navigation navigation_;  ///< altitude, boxes and zones; the meshes are in `meshes_`
  Vec3 origin_;
  std::vector<Box> keep_in_bounds_, keep_out_bounds_;  ///< of zones
  std::vector<ClosedMesh> meshes_;
  std::optional<GroundProbe> ground_;
  std::vector<std::optional<GroundProbe>> keep_in_heights_, keep_out_heights_;  ///< of zones
  std::optional<ObstacleProbe> obstacles_;
};

}  // namespace vantage::internal::verify
