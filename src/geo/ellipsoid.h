// The ellipsoid of WGS 84 (NIMA TR8350.2, 2000): longitude, latitude and height from and to ECEF (EPSG:4978).
#pragma once

#include <Eigen/Core>

#include "geo/local_frame.h"
#include "vantage/geometry.h"

namespace vantage::internal::geo {

/// Georeference::source_crs of a scene whose frame is a TangentFrame: it was read from a tileset on the earth.
inline constexpr const char* kEarthCentred = "EPSG:4978";

inline constexpr double kEquatorM = 6378137.0, kFlattening = 1 / 298.257223563;

struct Geodetic {
  LonLat place;
  double height_m = 0;  ///< above the ellipsoid
};

Vec3 to_ecef(const Geodetic& point);

/// For points that are not within some kilometres of the earth's centre. Exact to 1 nm near the surface.
Geodetic from_ecef(const Vec3& point);

/// A frame that touches the ellipsoid at a place: x east, y north, z up. Straight lines stay straight.
struct TangentFrame {
  explicit TangentFrame(LonLat place);

  Vec3 origin;           ///< ECEF
  Eigen::Matrix3d axes;  ///< its rows are east, north and up
  Vec3 to_local(const Vec3& ecef) const { return axes * (ecef - origin); }
  Vec3 to_earth(const Vec3& local) const { return axes.transpose() * local + origin; }
};

}  // namespace vantage::internal::geo
