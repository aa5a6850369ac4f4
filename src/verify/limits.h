// Navigation limits as a set of points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/constraints.h"
#include "verify/closed_mesh.h"
#include "verify/ground_probe.h"

namespace vantage::internal::verify {

class Limits {
 public:
  /// Throws Error(input) for a reversed band, box or zone, for a zone without corners and for a keep-in mesh that is
  /// not closed.
  Limits(const Navigation& navigation, const Vec3& origin);

  /// Name of the first limit that the local point breaks; nothing where it keeps them all. Borders are allowed.
  std::optional<std::string> broken_by(const Vec3& point) const;

 private:
  Navigation navigation_;  ///< altitude, boxes and zones; the meshes are in `meshes_`
  Vec3 origin_;
  std::vector<Box> keep_in_bounds_, keep_out_bounds_;  ///< of zones
  std::vector<ClosedMesh> meshes_;
  std::optional<GroundProbe> ground_;
};

}  // namespace vantage::internal::verify
