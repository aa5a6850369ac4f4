#include <cmath>
#include <numbers>

#include "vantage/sensor.h"

namespace vantage {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// Refraction of the air at 1010 hPa and 10 degrees, in degrees: Saemundsson, "Atmospheric refraction", Sky and
/// Telescope 72 (1986). `elevation_deg`: without it.
double refraction_deg(double elevation_deg) {
  if (elevation_deg < -1) return 0;
  return 1.02 / 60 / std::tan((elevation_deg + 10.3 / (elevation_deg + 5.11)) * kRadiansPerDegree);
}

}  // namespace

Vec3 sun_direction(double latitude_deg, double longitude_deg, double unix_time_s) {
  // Michalsky, "The Astronomical Almanac's algorithm for approximate solar position (1950-2050)", Solar Energy 40
  // (1988).
  const double days = unix_time_s / 86400 - 10957.5;  // since noon of 2000-01-01
  const double mean_longitude = 280.460 + 0.9856474 * days;
  const double anomaly = (357.528 + 0.9856003 * days) * kRadiansPerDegree;
  const double longitude =
      (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kRadiansPerDegree;
  const double obliquity = (23.439 - 0.0000004 * days) * kRadiansPerDegree;
  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double hours = std::fmod(unix_time_s / 3600, 24);
  const double sidereal_deg = 15 * (6.697375 + 0.0657098242 * days + hours) + longitude_deg;
  const double hour_angle = sidereal_deg * kRadiansPerDegree - right_ascension;
  const double latitude = latitude_deg * kRadiansPerDegree;
  Vec3 direction(
      -std::cos(declination) * std::sin(hour_angle),
      std::sin(declination) * std::cos(latitude) - std::cos(declination) * std::sin(latitude) * std::cos(hour_angle),
      std::sin(declination) * std::sin(latitude) + std::cos(declination) * std::cos(latitude) * std::cos(hour_angle));
  const double level = direction.head<2>().norm();
  const double elevation = std::atan2(direction.z(), level);
  const double raised = elevation + refraction_deg(elevation / kRadiansPerDegree) * kRadiansPerDegree;
  if (level > 0) direction << direction.head<2>().eval() * (std::cos(raised) / level), std::sin(raised);
  return direction;
}

}  // namespace vantage
