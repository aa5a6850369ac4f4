#include "vantage/tour_settings.h"

#include <cmath>
#include <string>

#include "vantage/error.h"
#include "vantage/input.h"

namespace vantage {
namespace {

constexpr double kRightAngleDeg = 90;

void require(bool holds, const char* key, double value, const char* range, const char* fix) {
  if (holds) return;
  throw Error(ErrorCode::value_out_of_range,
              std::string("tour.") + key + " must be " + range + ", not " + shortest(value), std::string("tour.") + key,
              fix);
}

void require_positive(double value, const char* key, const char* fix) {
  require(value > 0 && std::isfinite(value), key, value, "greater than 0", fix);
}

void require_not_negative(double value, const char* key, const char* fix) {
  require(value >= 0 && std::isfinite(value), key, value, "0 or more", fix);
}

void check_vehicle(const TourVehicle& vehicle) {
  require_positive(vehicle.speed_m_s, "vehicle.speed", "give metres per second");
  require_positive(vehicle.acceleration_m_s2, "vehicle.acceleration", "give metres per second, per second");
  require_positive(vehicle.turn_radius_m, "vehicle.turn_radius", "give metres");
  constexpr const char* kClimb = "give degrees, the steepest descent and the steepest climb: [-15, 20]";
  require(vehicle.min_climb_deg < 0 && vehicle.min_climb_deg > -kRightAngleDeg, "vehicle.climb[0]",
          vehicle.min_climb_deg, "between -90 and 0", kClimb);
  require(vehicle.max_climb_deg > 0 && vehicle.max_climb_deg < kRightAngleDeg, "vehicle.climb[1]",
          vehicle.max_climb_deg, "between 0 and 90", kClimb);
}

}  // namespace

const char* name_of(TourVehicle::Kind kind) {
  return kind == TourVehicle::Kind::multirotor ? "multirotor" : "fixed_wing";
}

void check_tour_settings(const TourSettings& settings) {
  check_vehicle(settings.vehicle);
  if (settings.home && settings.home->position && !settings.home->position->allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "tour.home is not finite", "tour.home", "give finite numbers");
  }
  require_not_negative(settings.dwell_s, "view.dwell", "give seconds");
  require_not_negative(settings.margin_m, "view.margin", "give metres");
  require_positive(settings.gimbal_rate_deg_s, "gimbal.rate", "give degrees per second");
  require_not_negative(settings.clearance_m, "clearance", "give metres");
  require(settings.gap >= 0 && settings.gap < 1, "gap", settings.gap, "0 or more, and less than 1",
          "give a share: 0.01 is one per cent");
  require_positive(settings.time_limit_s, "time_limit", "give seconds");
}

}  // namespace vantage
