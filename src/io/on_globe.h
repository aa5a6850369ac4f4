// From the scene frame to the globe: earth-centred coordinates (ECEF, EPSG:4978), in double precision.
#pragma once

#include <optional>

#include "geo/ellipsoid.h"
#include "vantage/georeference.h"

namespace vantage::internal::io {

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
  geo::Geodetic to_geodetic(const Vec3& scene) const;

  /// The point of the scene frame that is there.
  Vec3 to_scene(const geo::Geodetic& place) const;

  /// Whether the frame is a Cartesian one. In a map z is the height, and x and y do not depend on it.
  bool is_cartesian() const { return tangent_.has_value(); }

 private:
  geo::LocalFrame map_;
  std::optional<geo::TangentFrame> tangent_;
};

}  // namespace vantage::internal::io
