#include "geo/local_frame.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "geo/proj_library.h"
#include "vantage/error.h"

namespace vantage {
namespace {

/// The shortest decimal that reads back as `value`, whatever the locale.
std::string decimal(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.begin(), text.end(), value).ptr;
  return {text.begin(), end};
}

}  // namespace

std::string projection_text(const Georeference& georeference) {
  return "+proj=aeqd +lat_0=" + decimal(georeference.latitude_deg) + " +lon_0=" + decimal(georeference.longitude_deg) +
         " +datum=WGS84 +units=m +type=crs";
}

Eigen::Vector2d scene_position(const Georeference& georeference, double longitude_deg, double latitude_deg) {
  const geo::LocalFrame frame({georeference.longitude_deg, georeference.latitude_deg});
  const auto is_near = [&](double longitude, double latitude) {
    return std::abs(latitude) <= 90 && std::abs(longitude) <= 180 &&
           frame.to_local({longitude, latitude}).norm() <= geo::kFarthestM;
  };
  const auto refuse = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, "longitude " + decimal(longitude_deg) + ", latitude " + decimal(latitude_deg) + problem,
                "position", fix);
  };
  constexpr const char* kOrder = "give the longitude before the latitude";
  const bool is_valid = std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 180;  // not-a-number is not
  if (!is_valid) {
    refuse(
        ErrorCode::not_on_earth, " is no place on the earth",
        is_near(latitude_deg, longitude_deg) ? kOrder : "give a longitude in -180 to 180 and a latitude in -90 to 90");
  }
  const Eigen::Vector2d position = frame.to_local({longitude_deg, latitude_deg});
  if (position.norm() > geo::kFarthestM) {
    refuse(ErrorCode::too_far_away,
           " lies " + std::to_string(std::lround(position.norm() / 1000)) + " km from the scene's origin",
           is_near(latitude_deg, longitude_deg)
               ? kOrder
               : "give positions within 100 km of it, in WGS 84: longitude before latitude");
  }
  return position;
}

namespace geo {

struct LocalFrame::Data {
  LonLat origin;
  geod_geodesic ellipsoid;
};

LocalFrame::LocalFrame(LonLat origin) {
  // Written so that not-a-number is refused too.
  const bool valid = std::abs(origin.latitude_deg) <= 90 && std::abs(origin.longitude_deg) <= 180;
  if (!valid) {
    throw Error(ErrorCode::not_on_earth,
                "latitude " + decimal(origin.latitude_deg) + ", longitude " + decimal(origin.longitude_deg) +
                    " is no place on the earth",
                "origin of the scene frame",
                std::abs(origin.longitude_deg) <= 90 && std::abs(origin.latitude_deg) <= 180
                    ? "latitude comes first: give them the other way round"
                    : "give a latitude in -90 to 90 and a longitude in -180 to 180");
  }
  data_ = std::make_unique<Data>();
  data_->origin = origin;
  proj().geod_init(&data_->ellipsoid, 6378137.0, 1 / 298.257223563);  // WGS 84
}
LocalFrame::~LocalFrame() = default;
LocalFrame::LocalFrame(LocalFrame&&) noexcept = default;
LocalFrame& LocalFrame::operator=(LocalFrame&&) noexcept = default;

LonLat LocalFrame::origin() const { return data_->origin; }

Eigen::Vector2d LocalFrame::to_local(LonLat position) const {
  if (!(std::abs(position.latitude_deg) <= 90) || !std::isfinite(position.longitude_deg)) {
    throw Error(ErrorCode::not_on_earth,
                "latitude " + decimal(position.latitude_deg) + ", longitude " + decimal(position.longitude_deg) +
                    " is no place on the earth",
                "position", "correct it; is its coordinate reference system the right one?");
  }
  double distance = 0, azimuth_deg = 0;
  proj().geod_inverse(&data_->ellipsoid, data_->origin.latitude_deg, data_->origin.longitude_deg, position.latitude_deg,
                      position.longitude_deg, &distance, &azimuth_deg, nullptr);
  const double azimuth = azimuth_deg * std::numbers::pi / 180;
  return {distance * std::sin(azimuth), distance * std::cos(azimuth)};
}

LonLat LocalFrame::to_lonlat(const Eigen::Vector2d& local) const {
  if (!local.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "a point that is not finite has no place on the earth", "scene frame",
                "correct its coordinates");
  }
  const double azimuth_deg = std::atan2(local.x(), local.y()) * 180 / std::numbers::pi;
  LonLat position;
  proj().geod_direct(&data_->ellipsoid, data_->origin.latitude_deg, data_->origin.longitude_deg, azimuth_deg,
                     local.norm(), &position.latitude_deg, &position.longitude_deg, nullptr);
  return position;
}

double geodesic_m(LonLat from, LonLat to) { return LocalFrame(from).to_local(to).norm(); }

void check_origin(LonLat origin, LonLat middle, const std::string& where) {
  const double distance = geodesic_m(origin, middle);
  if (distance <= kFarthestM) return;
  const LonLat swapped{origin.latitude_deg, origin.longitude_deg};
  const bool is_swapped = std::abs(swapped.latitude_deg) <= 90 && geodesic_m(swapped, middle) <= kFarthestM;
  throw Error(ErrorCode::too_far_away, "the origin lies " + std::to_string(std::lround(distance / 1000)) + " km away",
              where,
              is_swapped ? "latitude and longitude are the wrong way round: give the latitude first"
                         : "give an origin nearby, or none: then it is the middle");
}

bool move_origin(std::vector<Vec3>& points, const Georeference& from, const Georeference& to) {
  if (from.latitude_deg == to.latitude_deg && from.longitude_deg == to.longitude_deg) return false;
  const LocalFrame old_frame({from.longitude_deg, from.latitude_deg}), new_frame({to.longitude_deg, to.latitude_deg});
  for (Vec3& point : points) point.head<2>() = new_frame.to_local(old_frame.to_lonlat(point.head<2>()));
  return true;
}

}  // namespace geo
}  // namespace vantage
