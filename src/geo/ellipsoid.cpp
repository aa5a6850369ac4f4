#include "geo/ellipsoid.h"

#include <cmath>

namespace vantage::internal::geo {

Geodetic from_ecef(const Vec3& point) {
  const double across = std::hypot(point.x(), point.y());
  // The latitude whose normal meets the point: the error falls to a 150th at each step, for points near the surface.
  double latitude = std::atan2(point.z(), across * (1 - kSquaredEccentricity)), normal = kEquatorM;
  for (int step = 0; step < 10; ++step) {
    const double sine = std::sin(latitude);
    normal = kEquatorM / std::sqrt(1 - kSquaredEccentricity * sine * sine);
    latitude = std::atan2(point.z() + kSquaredEccentricity * normal * sine, across);
  }
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  // Good at the poles and at the equator.
  const double height =
      across * cosine + point.z() * sine - kEquatorM * std::sqrt(1 - kSquaredEccentricity * sine * sine);
  return {{std::atan2(point.y(), point.x()) / kDegree, latitude / kDegree}, height};
}

}  // namespace vantage::internal::geo
