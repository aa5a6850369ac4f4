#include "geo/ellipsoid.h"

#include <cmath>
#include <numbers>

namespace vantage::internal::geo {
namespace {

constexpr double kSquaredEccentricity = kFlattening * (2 - kFlattening);
constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

Vec3 to_ecef(const Geodetic& point) {
  const double latitude = point.place.latitude_deg * kDegree, longitude = point.place.longitude_deg * kDegree;
  const double normal = kEquatorM / std::sqrt(1 - kSquaredEccentricity * std::sin(latitude) * std::sin(latitude));
  const double across = (normal + point.height_m) * std::cos(latitude);
  return {across * std::cos(longitude), across * std::sin(longitude),
          (normal * (1 - kSquaredEccentricity) + point.height_m) * std::sin(latitude)};
}

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

TangentFrame::TangentFrame(LonLat place) : origin(to_ecef({place, 0})) {
  const double latitude = place.latitude_deg * kDegree, longitude = place.longitude_deg * kDegree;
  const double sin_lat = std::sin(latitude), cos_lat = std::cos(latitude);
  const double sin_lon = std::sin(longitude), cos_lon = std::cos(longitude);
  axes << -sin_lon, cos_lon, 0, -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat, cos_lat * cos_lon, cos_lat * sin_lon,
      sin_lat;
}

}  // namespace vantage::internal::geo
