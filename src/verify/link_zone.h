// The zone of a radio link about one viewpoint, by the definition in vantage/sensor.h: an affine map makes a ball of
// it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vantage/scene.h"
#include "vantage/sensor.h"
#include "verify/box_index.h"
#include "verify/segment.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

class LinkZone {
 public:
  /// Keeps a reference to the view, whose only vertex is the antenna. `max_range`: metres, of the sensor.
  LinkZone(const Scene& scene, const TargetView& view, const RadioLink& link, double max_range);

  /// Number, in the scene, of the triangle that enters the zone of a viewpoint (local) most deeply.
  std::optional<std::size_t> entered_by(const Vec3& viewpoint) const;

  /// Whether a volume may lack the viewpoint, as some triangle comes as near to the line of sight as
  /// docs/verification.md says.
  bool may_lack(const Vec3& viewpoint) const;

 private:
  /// An ellipsoid of revolution about a line from the antenna, without what lies beyond `end` along the line.
  struct Ellipsoid {
    Vec3 axis;  ///< unit
    double middle, half_length, radius, end;
  };
  Ellipsoid zone_of(const Vec3& viewpoint) const;
  Ellipsoid widest_lost(const Vec3& viewpoint) const;
  bool is_behind(const Vec3& viewpoint, const FlatTriangle& triangle) const;
  double share_of_radius(const Ellipsoid& ellipsoid, const FlatTriangle& triangle) const;

  /// Calls visit(i) for triangles near the ellipsoid until it returns true; whether it did.
  template <typename Visit>
  bool any_near(const Ellipsoid& ellipsoid, Visit&& visit) const;

  const TargetView& view_;
  double excess_, range_;
  std::vector<FlatTriangle> triangles_;
  std::vector<std::size_t> number_;  ///< in the scene
  std::optional<BoxIndex> index_;
};

}  // namespace vantage::internal::verify
