// Between the scene frame and the globe: longitude, latitude and height, and earth-centred coordinates (ECEF,
// EPSG:4978), in double precision.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geo/ellipsoid.h"
#include "vantage/earth.h"

namespace vantage::internal::geo {

/// z of the scene is taken as the height above the ellipsoid, whatever the georeference says that it is measured from.
/// The frame of a scene that was read from a tileset touches the ellipsoid at its origin, and is a Cartesian one: it is
/// turned as a whole, and straight lines stay straight. That of any other scene is a map: x and y give longitude and
/// latitude, and z is measured along the normal there. A straight line of length d then sags by d * d / 8R, at most.
class OnGlobe {
 public:
  explicit OnGlobe(const Georeference& georeference);

  /// Throws Error(input) for a point that is not finite.
  Vec3 to_earth(const Vec3& scene) const;

  /// Longitude, latitude and height of a point of the scene frame.
  Geodetic to_geodetic(const Vec3& scene) const;

  /// The point of the scene frame that is there. Throws Error(input) for what is no place on the earth.
  Vec3 to_scene(const Geodetic& place) const;

  /// x and y of the point at, above or below a place that has this z of the scene frame. Throws as to_scene. A place
  /// farther than kFarthestNormalM is where the map has it: its normal may not meet that z.
  Eigen::Vector2d at_z(LonLat place, double z_m) const;

  /// Likewise where a surface is: at z = 0 where it has none. Exact where its slope is 1 or less and no step is near.
  Eigen::Vector2d on_surface(LonLat place, const SurfaceZ& surface) const;

  /// Whether the frame is a Cartesian one. In a map z is the height, and x and y do not depend on it.
  bool is_cartesian() const { return tangent_.has_value(); }

  /// The map about the origin, which tells how far away places are.
  const LocalFrame& map() const { return map_; }

  static constexpr double kFarthestNormalM = 4000e3;

 private:
  LocalFrame map_;
  std::optional<TangentFrame> tangent_;
};

}  // namespace vantage::internal::geo
