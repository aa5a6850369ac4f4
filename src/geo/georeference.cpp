#include "vantage/georeference.h"

#include <cmath>

#include "common/input.h"
#include "geo/local_frame.h"
#include "vantage/error.h"

namespace vantage {

std::string projection_text(const Georeference& georeference) {
  return "+proj=aeqd +lat_0=" + shortest(georeference.latitude_deg) +
         " +lon_0=" + shortest(georeference.longitude_deg) + " +datum=WGS84 +units=m +type=crs";
}

Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg) {
  const internal::geo::LocalFrame frame({georeference.longitude_deg, georeference.latitude_deg});
  const auto is_near = [&](double longitude, double latitude) {
    return std::abs(latitude) <= 90 && std::abs(longitude) <= 180 &&
           frame.to_local({longitude, latitude}).norm() <= internal::geo::kFarthestM;
  };
  const auto refuse = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, "longitude " + shortest(longitude_deg) + ", latitude " + shortest(latitude_deg) + problem,
                "position", fix);
  };
  constexpr const char* kOrder = "longitude and latitude seem to be swapped: give them the other way round";
  const bool is_valid = std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 180;  // not-a-number is not
  if (!is_valid) {
    refuse(
        ErrorCode::not_on_earth, " is not a place on the earth",
        is_near(latitude_deg, longitude_deg) ? kOrder : "give a longitude in -180 to 180 and a latitude in -90 to 90");
  }
  Eigen::Vector2d position = frame.to_local({longitude_deg, latitude_deg});
  if (position.norm() > internal::geo::kFarthestM) {
    refuse(ErrorCode::too_far_away,
           " lies " + std::to_string(std::lround(position.norm() / 1000)) + " km from the scene's origin",
           is_near(latitude_deg, longitude_deg)
               ? kOrder
               : "give positions within 100 km of it, in WGS 84: longitude before latitude");
  }
  return position;
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
  const internal::geo::LocalFrame frame({georeference.longitude_deg, georeference.latitude_deg});
  const internal::geo::CoordinateSystem system(crs, "crs");
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    const std::string place = "point " + std::to_string(positions.size());
    if (!point.allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite", place, "give two numbers");
    }
    const Eigen::Vector2d& position = positions.emplace_back(frame.to_local(system.to_lonlat(point)));
    if (position.norm() <= internal::geo::kFarthestM) continue;
    throw Error(ErrorCode::too_far_away,
                "the point lies " + std::to_string(std::lround(position.norm() / 1000)) + " km from the scene's origin",
                place,
                system.is_geographic() ? "give positions within 100 km of it, longitude before latitude"
                                       : "give positions within 100 km of it, east before north");
  }
  return positions;
}

double vertical_unit_m(const std::string& crs) {
  return internal::geo::CoordinateSystem(crs, "crs").vertical_unit_m().value_or(1);
}

std::vector<Eigen::Vector2d> positions_in_crs(const Georeference& georeference, const std::string& crs,
                                              std::span<const Eigen::Vector2d> points) {
  const internal::geo::LocalFrame frame({georeference.longitude_deg, georeference.latitude_deg});
  const internal::geo::CoordinateSystem system(crs, "crs");
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(points.size());
  for (const Eigen::Vector2d& point : points) positions.push_back(system.from_lonlat(frame.to_lonlat(point)));
  return positions;
}

}  // namespace vantage
