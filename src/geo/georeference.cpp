#include "vantage/georeference.h"

#include <cmath>

#include "common/input.h"
#include "geo/local_frame.h"
#include "geo/on_globe.h"
#include "vantage/earth.h"
#include "vantage/error.h"

namespace vantage {

std::string projection_text(const Georeference& georeference) {
  return "+proj=aeqd +lat_0=" + shortest(georeference.latitude_deg) +
         " +lon_0=" + shortest(georeference.longitude_deg) + " +datum=WGS84 +units=m +type=crs";
}

namespace {

using internal::geo::LonLat;
using internal::geo::OnGlobe;

/// Throws for what is not within 100 km of the origin.
void check_place(const OnGlobe& globe, LonLat at) {
  const auto is_near = [&](double longitude, double latitude) {
    return std::abs(latitude) <= 90 && std::abs(longitude) <= 180 &&
           globe.map().to_local({longitude, latitude}).norm() <= internal::geo::kFarthestM;
  };
  const auto refuse = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, "longitude " + shortest(at.longitude_deg) + ", latitude " + shortest(at.latitude_deg) + problem,
                "position", fix);
  };
  constexpr const char* kOrder = "longitude and latitude seem to be swapped: give them the other way round";
  const bool is_valid = std::abs(at.latitude_deg) <= 90 && std::abs(at.longitude_deg) <= 180;  // not-a-number is not
  if (!is_valid) {
    refuse(ErrorCode::not_on_earth, " is not a place on the earth",
           is_near(at.latitude_deg, at.longitude_deg) ? kOrder
                                                      : "give a longitude in -180 to 180 and a latitude in -90 to 90");
  }
  const double distance = globe.map().to_local(at).norm();
  if (distance <= internal::geo::kFarthestM) return;
  refuse(ErrorCode::too_far_away,
         " lies " + std::to_string(std::lround(distance / 1000)) + " km from the scene's origin",
         is_near(at.latitude_deg, at.longitude_deg)
             ? kOrder
             : "give positions within 100 km of it, in WGS 84: longitude before latitude");
}

/// Points of a coordinate reference system in the scene frame, each by `place(LonLat, index)`.
template <typename Point, typename Place>
std::vector<Point> placed(const OnGlobe& globe, const std::string& crs, std::span<const Point> points,
                          const Place& place) {
  const internal::geo::CoordinateSystem system(crs, "crs");
  std::vector<Point> positions;
  positions.reserve(points.size());
  for (const Point& point : points) {
    const std::string where = "point " + std::to_string(positions.size());
    if (!point.allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite", where,
                  "give " + std::string(point.size() == 2 ? "two" : "three") + " numbers");
    }
    const LonLat at = system.to_lonlat(point.template head<2>());
    const double distance = globe.map().to_local(at).norm();
    if (distance > internal::geo::kFarthestM) {
      throw Error(ErrorCode::too_far_away,
                  "the point lies " + std::to_string(std::lround(distance / 1000)) + " km from the scene's origin",
                  where,
                  system.is_geographic() ? "give positions within 100 km of it, longitude before latitude"
                                         : "give positions within 100 km of it, east before north");
    }
    positions.push_back(place(at, point, system));
  }
  return positions;
}

}  // namespace

Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg) {
  return scene_position(georeference, longitude_deg, latitude_deg, 0.0);
}

Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg,
                               double z_m) {
  const OnGlobe globe(georeference);
  check_place(globe, {longitude_deg, latitude_deg});
  return globe.at_z({longitude_deg, latitude_deg}, z_m);
}

Vec3 scene_point(const Georeference& georeference, double longitude_deg, double latitude_deg, double height_m) {
  const OnGlobe globe(georeference);
  check_place(globe, {longitude_deg, latitude_deg});
  return globe.to_scene({{longitude_deg, latitude_deg}, height_m});
}

double height_m(const Georeference& georeference, const Vec3& position) {
  return OnGlobe(georeference).to_geodetic(position).height_m;
}

Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg,
                               const SurfaceZ& z_at) {
  const OnGlobe globe(georeference);
  check_place(globe, {longitude_deg, latitude_deg});
  return globe.on_surface({longitude_deg, latitude_deg}, z_at);
}

bool seems_swapped(const Georeference& georeference, const Box& bounds, double longitude_deg, double latitude_deg) {
  const internal::geo::LocalFrame frame({georeference.longitude_deg, georeference.latitude_deg});
  const auto holds = [&](double longitude, double latitude) {
    if (!(std::abs(latitude) <= 90) || !(std::abs(longitude) <= 180)) return false;
    const Eigen::Array2d at = frame.to_local({longitude, latitude});
    return (at >= bounds.min.head<2>().array()).all() && (at <= bounds.max.head<2>().array()).all();
  };
  return !holds(longitude_deg, latitude_deg) && holds(latitude_deg, longitude_deg);
}

std::vector<Eigen::Vector2d> scene_positions(const Georeference& georeference, const std::string& crs,
                                             std::span<const Eigen::Vector2d> points) {
  return scene_positions(georeference, crs, points, SurfaceZ{});
}

std::vector<Eigen::Vector2d> scene_positions(const Georeference& georeference, const std::string& crs,
                                             std::span<const Eigen::Vector2d> points, const SurfaceZ& z_at) {
  const OnGlobe globe(georeference);
  return placed(globe, crs, points, [&](LonLat at, const Eigen::Vector2d&, const auto&) {
    return z_at ? globe.on_surface(at, z_at) : globe.at_z(at, 0);
  });
}

std::vector<Vec3> scene_positions(const Georeference& georeference, const std::string& crs,
                                  std::span<const Vec3> points) {
  const OnGlobe globe(georeference);
  return placed(globe, crs, points, [&](LonLat at, const Vec3& point, const auto& system) {
    return globe.to_scene({at, point.z() * system.vertical_unit_m().value_or(1)});
  });
}

double vertical_unit_m(const std::string& crs) {
  return internal::geo::CoordinateSystem(crs, "crs").vertical_unit_m().value_or(1);
}

std::vector<Eigen::Vector2d> positions_in_crs(const Georeference& georeference, const std::string& crs,
                                              std::span<const Eigen::Vector2d> points) {
  const OnGlobe globe(georeference);
  const internal::geo::CoordinateSystem system(crs, "crs");
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    positions.push_back(system.from_lonlat(globe.to_geodetic({point.x(), point.y(), 0}).place));
  }
  return positions;
}

std::vector<Vec3> positions_in_crs(const Georeference& georeference, const std::string& crs,
                                   std::span<const Vec3> points) {
  const OnGlobe globe(georeference);
  const internal::geo::CoordinateSystem system(crs, "crs");
  std::vector<Vec3> positions;
  positions.reserve(points.size());
  for (const Vec3& point : points) {
    const internal::geo::Geodetic place = globe.to_geodetic(point);
    const Eigen::Vector2d at = system.from_lonlat(place.place);
    positions.emplace_back(at.x(), at.y(), place.height_m);
  }
  return positions;
}

bool is_map(const Georeference& georeference) { return !OnGlobe(georeference).is_cartesian(); }

}  // namespace vantage
