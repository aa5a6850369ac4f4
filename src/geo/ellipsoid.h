// The ellipsoid of WGS 84 (NIMA TR8350.2, 2000): longitude, latitude and height from and to ECEF (EPSG:4978).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "geo/local_frame.h"
#include "vantage/geometry.h"

namespace vantage::internal::geo {

/// Georeference::source_crs of a scene whose frame is a TangentFrame: it was read from a tileset on the earth.
inline constexpr const char* kEarthCentred = "EPSG:4978";

inline constexpr double kEquatorM = 6378137.0, kFlattening = 1 / 298.257223563;
inline constexpr double kSquaredEccentricity = kFlattening * (2 - kFlattening);
inline constexpr double kDegree = std::numbers::pi / 180;

struct Geodetic {
  LonLat place;
  double height_m = 0;  ///< above the ellipsoid
};

inline Vec3 to_ecef(const Geodetic& point) {
  const double latitude = point.place.latitude_deg * kDegree, longitude = point.place.longitude_deg * kDegree;
  const double normal = kEquatorM / std::sqrt(1 - kSquaredEccentricity * std::sin(latitude) * std::sin(latitude));
  const double across = (normal + point.height_m) * std::cos(latitude);
  return {across * std::cos(longitude), across * std::sin(longitude),
          (normal * (1 - kSquaredEccentricity) + point.height_m) * std::sin(latitude)};
}

/// For points that are not within some kilometres of the earth's centre. Exact to 1 nm near the surface.
Geodetic from_ecef(const Vec3& point);

/// A frame that touches the ellipsoid at a place: x east, y north, z up. Straight lines stay straight.
struct TangentFrame {
  explicit TangentFrame(LonLat place) : origin(to_ecef({place, 0})) {
    const double latitude = place.latitude_deg * kDegree, longitude = place.longitude_deg * kDegree;
    const double sin_lat = std::sin(latitude), cos_lat = std::cos(latitude);
    const double sin_lon = std::sin(longitude), cos_lon = std::cos(longitude);
    axes << -sin_lon, cos_lon, 0, -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat, cos_lat * cos_lon, cos_lat * sin_lon,
        sin_lat;
  }

  Vec3 origin;           ///< ECEF
  Eigen::Matrix3d axes;  ///< its rows are east, north and up
  Vec3 to_local(const Vec3& ecef) const { return axes * (ecef - origin); }
  Vec3 to_earth(const Vec3& local) const { return axes.transpose() * local + origin; }
};

}  // namespace vantage::internal::geo
