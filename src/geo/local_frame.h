// Between the earth and a scene's frame. The only module that sees PROJ.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"

namespace vantage::internal::geo {

/// Georeference::vertical of heights above the WGS 84 ellipsoid, as CoordinateSystem calls it.
inline constexpr const char* kEllipsoidalHeight = "ellipsoidal height";

/// z of the mean sea level in a scene whose heights are measured from `vertical` (Georeference): 0 where that names a
/// level that countries and the earth have at the sea; nothing for the ground, the ellipsoid and a file's own level
/// ("as in dem.tif"), which do not say it.
inline std::optional<double> sea_level_z_m(std::string_view vertical) {
  std::string name(vertical);  // of the system in a file, which may name its ellipsoid in any words
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const bool is_known = !name.empty() && vertical != kFlatGround && !name.starts_with("as in ") &&
                        name.find("ellipsoid") == std::string::npos && name.find("unknown") == std::string::npos;
  return is_known ? std::optional(0.0) : std::nullopt;
}

/// Degrees, WGS 84, in this order everywhere in the library (mission files say [lat, lon] where they name a centre).
struct LonLat {
  double longitude_deg = 0;
  double latitude_deg = 0;
};

/// The horizontal scene frame about an origin (see Georeference). Cheap to make; any number of threads may use it at
/// once. A position is found by solving the geodesic from the origin to it (Karney, "Algorithms for geodesics", 2013),
/// which is exact to 15 nm everywhere, poles and antimeridian included, and takes about a microsecond.
class LocalFrame {
 public:
  /// Throws Error(input) for a latitude or longitude that is out of range (-90 to 90, -180 to 180) or not finite.
  VANTAGE_INTERNAL_API explicit LocalFrame(LonLat origin);
  VANTAGE_INTERNAL_API ~LocalFrame();
  LocalFrame(LocalFrame&&) noexcept;
  LocalFrame& operator=(LocalFrame&&) noexcept;

  VANTAGE_INTERNAL_API LonLat origin() const;
  /// Metres, (east, north). Longitudes may be any finite number of degrees. Throws Error(input) for a position that is
  /// not on the earth.
  VANTAGE_INTERNAL_API Eigen::Vector2d to_local(LonLat position) const;
  /// Longitude in -180 to 180. Throws Error(input) for a point that is not finite.
  VANTAGE_INTERNAL_API LonLat to_lonlat(const Eigen::Vector2d& local) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// No scene is so large, metres: a place that far from the origin is a mistake, and the frame's distances are no longer
/// good there.
inline constexpr double kFarthestM = 100e3;

double geodesic_m(LonLat from, LonLat to);

/// Throws Error(input) for an origin farther than kFarthestM from `middle`, that of what is to lie about it.
VANTAGE_INTERNAL_API void check_origin(LonLat origin, LonLat middle, const std::string& where);

/// Points of the frame about `from`'s origin into that about `to`'s; the same frame leaves every bit as it is. Between
/// maps z is left alone; one from a tileset is no map (OnGlobe). Returns whether the frames differ. Throws Error(input)
/// for an origin that is not a place on the earth.
bool move_origin(std::vector<Vec3>& points, const Georeference& from, const Georeference& to);

/// From a coordinate reference system to WGS 84 and back: "EPSG:4326", "EPSG:28992", "EPSG:7415" (of a compound one
/// only the horizontal part is used), a WKT text, a PROJ text, or a CityJSON URL
/// ("https://www.opengis.net/def/crs/EPSG/0/7415", "urn:ogc:def:crs:EPSG::7415"). Horizontal coordinates are always
/// (east, north) or (longitude, latitude), whatever the authority's order of axes. Uses no network, and the best
/// transformation among those whose grids are installed. Not for two threads at once; takes up to 50 ms to make.
class CoordinateSystem {
 public:
  /// Throws Error(input) for a text that PROJ does not know, a system that is not geographic or projected, or a PROJ
  /// that lacks its database; `where` says where the text was found.
  VANTAGE_INTERNAL_API CoordinateSystem(const std::string& text, const std::string& where);
  VANTAGE_INTERNAL_API ~CoordinateSystem();
  VANTAGE_INTERNAL_API CoordinateSystem(CoordinateSystem&&) noexcept;
  CoordinateSystem& operator=(CoordinateSystem&&) noexcept;

  VANTAGE_INTERNAL_API LonLat
  to_lonlat(const Eigen::Vector2d& position) const;  ///< throws Error(input) where the projection has no value
  VANTAGE_INTERNAL_API Eigen::Vector2d from_lonlat(LonLat position) const;  ///< likewise
  VANTAGE_INTERNAL_API bool is_geographic() const;       ///< coordinates are angles: degrees, but for a few old ones
  VANTAGE_INTERNAL_API const std::string& name() const;  ///< "EPSG:28992 (Amersfoort / RD New)"
  VANTAGE_INTERNAL_API const std::string& code() const;  ///< "EPSG:28992"; empty when it has none
  /// "NAP height" of a compound system, "ellipsoidal height" of a geographic or projected one with three axes; else
  /// empty.
  VANTAGE_INTERNAL_API const std::string& vertical_name() const;
  /// Metres in one unit.
  struct Units {
    double horizontal_m = 1;                          ///< of the eastings; 1 where coordinates are angles
    std::optional<double> vertical_m = std::nullopt;  ///< of the third axis, negative when it is a depth
  };
  VANTAGE_INTERNAL_API const Units& units() const;
  std::optional<double> vertical_unit_m() const { return units().vertical_m; }
  /// The area that the system is made for, in the authority's words, when the position lies outside it; nothing inside,
  /// or where no area is known.
  std::optional<std::string> area_without(LonLat position) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage::internal::geo
