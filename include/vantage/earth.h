// Places with heights: between the earth and the scene frame.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"

namespace vantage {

/// Whether the scene frame is the map that Georeference describes. It is not of a scene that was read from a tileset on
/// the earth: then it is a Cartesian frame that touches the WGS 84 ellipsoid at the origin, and all functions here and
/// in georeference.h go by way of ECEF. Which x and y a place has depends on z there, and heights above the ellipsoid
/// are not z: see docs/tilesets.md.
VANTAGE_API bool is_map(const Georeference& georeference);

/// x and y in the scene frame of the point with this z there that lies at, above or below a place on the earth (WGS 84,
/// degrees). As scene_position without z_m, which takes 0.
VANTAGE_API Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg,
                                           double z_m);

/// z of a surface, such as the ground, by x and y of the scene frame; nothing where it is not known.
using SurfaceZ = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// The same where z depends on x and y, as on the ground; where it is not known 0 is taken. `z_at` is not asked if the
/// frame is a map, and else four times.
VANTAGE_API Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg,
                                           const SurfaceZ& z_at);

/// The point of the scene frame at a place and a height above the zero of the scene's heights: z where the frame is a
/// map, and else the height above the ellipsoid. Throws Error(input) as scene_position.
VANTAGE_API Vec3 scene_point(const Georeference& georeference, double longitude_deg, double latitude_deg,
                             double height_m);

/// The height of a point of the scene frame above the zero of the scene's heights. Throws Error(input) for one that is
/// not finite.
VANTAGE_API double height_m(const Georeference& georeference, const Vec3& position);

/// Points of a coordinate reference system on a surface: as scene_positions without `z_at`, which takes z = 0.
VANTAGE_API std::vector<Eigen::Vector2d> scene_positions(const Georeference& georeference, const std::string& crs,
                                                         std::span<const Eigen::Vector2d> points, const SurfaceZ& z_at);

/// Of points with heights: above the zero of the scene's heights, in the unit of the system's vertical axis if it has
/// one (vertical_unit_m). Throws Error(input) as without heights.
VANTAGE_API std::vector<Vec3> scene_positions(const Georeference& georeference, const std::string& crs,
                                              std::span<const Vec3> points);

/// The other way round. The heights are metres above the zero of the scene's heights, whatever the system.
VANTAGE_API std::vector<Vec3> positions_in_crs(const Georeference& georeference, const std::string& crs,
                                               std::span<const Vec3> points);

}  // namespace vantage
