#include "geo/local_frame.h"

#include <cmath>
#include <numbers>

#include "common/input.h"
#include "geo/proj_library.h"
#include "vantage/error.h"

namespace vantage::internal::geo {

struct LocalFrame::Data {
  LonLat origin;
  geod_geodesic ellipsoid;
};

LocalFrame::LocalFrame(LonLat origin) {
  // Written so that not-a-number is refused too.
  const bool valid = std::abs(origin.latitude_deg) <= 90 && std::abs(origin.longitude_deg) <= 180;
  if (!valid) {
    throw Error(ErrorCode::not_on_earth,
                "latitude " + shortest(origin.latitude_deg) + ", longitude " + shortest(origin.longitude_deg) +
                    " is not a place on the earth",
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
                "latitude " + shortest(position.latitude_deg) + ", longitude " + shortest(position.longitude_deg) +
                    " is not a place on the earth",
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

}  // namespace vantage::internal::geo
