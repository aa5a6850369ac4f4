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

/// What nothing that flies exceeds by far: beyond it a slip of the pen is more likely, and times and lengths overflow.
struct Bounds {
  double least, most;
  const char* unit;
};
constexpr Bounds kSpeed = {0.01, 1000, " m/s"}, kAcceleration = {0.001, 1000, " m/s2"}, kTurnRadius = {0.01, 1e5, " m"};
constexpr Bounds kDwell = {0, 86'400, " s, a day"}, kMargin = {0, 1e4, " m"}, kClearance = {0, 1e4, " m"};
constexpr Bounds kGimbalRate = {0.001, 36'000, " degrees per second"}, kTimeLimit = {1e-9, 604'800, " s, a week"};
constexpr double kLeastClimbDeg = 0.1;

void require_within(double value, const Bounds& bounds, const char* key, const char* fix) {
  if (bounds.least <= 0) {
    require(value >= 0 && std::isfinite(value), key, value, "0 or more", fix);
  } else {
    require(value > 0 && std::isfinite(value), key, value, "greater than 0", fix);
  }
  const std::string range = "between " + shortest(bounds.least) + " and " + shortest(bounds.most) + bounds.unit;
  require(value >= bounds.least && value <= bounds.most, key, value, range.c_str(), fix);
}

void check_vehicle(const TourVehicle& vehicle) {
  require_within(vehicle.speed_m_s, kSpeed, "vehicle.speed", "give metres per second");
  require_within(vehicle.acceleration_m_s2, kAcceleration, "vehicle.acceleration",
                 "give metres per second, per second");
  require_within(vehicle.turn_radius_m, kTurnRadius, "vehicle.turn_radius", "give metres");
  constexpr const char* kClimb = "give degrees, the steepest descent and the steepest climb: [-15, 20]";
  require(vehicle.min_climb_deg <= -kLeastClimbDeg && vehicle.min_climb_deg > -kRightAngleDeg, "vehicle.climb[0]",
          vehicle.min_climb_deg, "between -90 and -0.1", kClimb);
  require(vehicle.max_climb_deg >= kLeastClimbDeg && vehicle.max_climb_deg < kRightAngleDeg, "vehicle.climb[1]",
          vehicle.max_climb_deg, "between 0.1 and 90", kClimb);
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
  require_within(settings.dwell_s, kDwell, "view.dwell", "give seconds");
  require_within(settings.margin_m, kMargin, "view.margin", "give metres");
  require_within(settings.gimbal_rate_deg_s, kGimbalRate, "gimbal.rate", "give degrees per second");
  require_within(settings.clearance_m, kClearance, "clearance", "give metres");
  require(settings.gap >= 0 && settings.gap < 1, "gap", settings.gap, "0 or more, and less than 1",
          "give a share: 0.01 is one per cent");
  require_within(settings.time_limit_s, kTimeLimit, "time_limit", "give seconds");
}

}  // namespace vantage
