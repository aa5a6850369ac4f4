#include "vantage/georeference.h"

#include <cmath>

#include "geo/local_frame.h"
#include "vantage/error.h"
#include "vantage/input.h"

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
  constexpr const char* kOrder = "give the longitude before the latitude";
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

}  // namespace vantage
