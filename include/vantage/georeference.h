// Where on the earth a scene lies.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// The scene frame of a scene that has a place on the earth: x east, y north, z up, in metres, from an origin in
/// WGS 84. x and y are the azimuthal equidistant projection of the WGS 84 ellipsoid about the origin (Snyder, "Map
/// projections: a working manual", 1987, chapter 25; EPSG method 9832): distances and directions from the origin are
/// those on the ellipsoid, and between points within 2 km of it distances are right to 0.1 mm. See docs/scene.md. But
/// a scene that was read from a tileset on the earth has another frame: see is_map in earth.h. Places without a height
/// are then at z = 0 of it.
struct Georeference {
  double latitude_deg = 0;   ///< of the origin; WGS 84, -90 to 90
  double longitude_deg = 0;  ///< of the origin; WGS 84, -180 to 180
  /// What z is measured from: "flat ground", "EGM96 geoid", "as in dem.tif", "NAP height"; empty when unknown.
  std::string vertical;
  std::string source_crs;  ///< of the file it came from: "EPSG:4326", "EPSG:7415"; empty when unknown
  /// Whom pictures of it have to name: kOpenStreetMapCredit; empty when nobody is known. Part of the place, since it is
  /// written wherever that is: into scenes, volumes and reports.
  std::string attribution = {};
};

/// What the licence of OpenStreetMap's data, the ODbL, asks of pictures and pages that show it.
inline constexpr const char* kOpenStreetMapCredit = "\u00a9 OpenStreetMap contributors";

/// Georeference::vertical of a map without terrain: z is measured from the ground, wherever that lies.
inline constexpr const char* kFlatGround = "flat ground";

/// x and y in the scene frame of a point that is given on the earth (WGS 84, degrees), exact to 15 nm. Takes about two
/// microseconds: a geodesic is solved. Throws Error(input) for a latitude beyond 90 or a longitude beyond 180 degrees,
/// and for a point more than 100 km from the origin, where distances in the frame are no longer good.
VANTAGE_API Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg);

/// Whether a place lies outside of `bounds` (scene frame), seen from above, and inside with longitude and latitude the
/// other way round: then somebody has most likely mixed them up.
VANTAGE_API bool seems_swapped(const Georeference& georeference, const Box& bounds, double longitude_deg,
                               double latitude_deg);

/// x and y in the scene frame of points of a coordinate reference system: "EPSG:28992", a WKT text, a PROJ text. Points
/// are (east, north) or (longitude, latitude), whatever order the system's authority has, in its unit. As read_scene
/// moves meshes that have a system. Uses no network, and the best transformation of those whose grids are installed.
/// Throws Error(input) for a system that is not known or neither geographic nor projected, and for a point that is not
/// finite, not on the earth or more than 100 km from the origin. Cost: up to 50 ms, and some microseconds for each
/// point.
VANTAGE_API std::vector<Eigen::Vector2d> scene_positions(const Georeference& georeference, const std::string& crs,
                                                         std::span<const Eigen::Vector2d> points);

/// The other way round: points of the scene frame in a coordinate reference system.
VANTAGE_API std::vector<Eigen::Vector2d> positions_in_crs(const Georeference& georeference, const std::string& crs,
                                                          std::span<const Eigen::Vector2d> points);

/// Metres in one unit of z of a coordinate reference system: negative where it counts depths, 1 where it has no
/// vertical axis. A height of the scene frame is z times this, as with the `crs` of a mission. Throws Error(input) as
/// scene_positions does. Cost: up to 50 ms.
VANTAGE_API double vertical_unit_m(const std::string& crs);

/// PROJ's words for the map about the origin: "+proj=aeqd +lat_0=… +lon_0=… +datum=WGS84 +units=m +type=crs". If the
/// frame is not that map (is_map), no projection says where it is: h metres above the ellipsoid and d metres from the
/// origin they are h * d / R apart, 3 cm for 100 m and 2 km.
VANTAGE_API std::string projection_text(const Georeference& georeference);

}  // namespace vantage
