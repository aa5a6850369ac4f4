// What a tour is asked for: the vehicle, where it starts, how it looks.
#pragma once

#include <array>
#include <optional>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// How a vehicle moves.
struct TourVehicle {
  enum class Kind {
    multirotor,  ///< flies straight legs, stops and hovers
    fixed_wing,  ///< neither stops nor turns on the spot
  };
  Kind kind = Kind::multirotor;
  double speed_m_s = 8;          ///< along the path; 0.01 to 1000
  double acceleration_m_s2 = 2;  ///< of a multirotor, along the path; 0.001 to 1000
  double turn_radius_m = 40;     ///< of a fixed wing: the smallest radius, in plan; 0.01 to 1e5
  double min_climb_deg = -15;    ///< of a fixed wing: the path's angle to the horizon; > -90, <= -0.1
  double max_climb_deg = 20;     ///< likewise; >= 0.1, < 90
};

/// "multirotor", "fixed_wing".
VANTAGE_API const char* name_of(TourVehicle::Kind kind);

/// Where a tour begins: one of the two.
struct TourHome {
  std::optional<std::array<double, 2>> at_deg = std::nullopt;  ///< latitude and longitude (WGS 84), on the ground
  std::optional<Vec3> position = std::nullopt;                 ///< metres, scene frame, or as MissionFile::crs says
};

struct TourSettings {
  TourVehicle vehicle;
  std::optional<TourHome> home = std::nullopt;  ///< nothing: the tour begins anywhere
  bool closed = true;  ///< it returns to where it began; without a home in the same direction, too

  /// For so long each target is in view without a break: 0 to 86,400. A shortest tour would only touch the volumes, so
  /// it is not 0 by default. A multirotor hovers where it does not fly through the volume for that long.
  double dwell_s = 2;
  double margin_m = 1;        ///< meanwhile it is at least so deep inside the volume; 0 to 1e4
  bool simultaneous = false;  ///< several targets may be viewed at once; false: one after the other

  double gimbal_rate_deg_s = 30;  ///< at most so fast the camera turns; 0.001 to 36,000
  double clearance_m = 5;         ///< of the whole flight from the whole scene, but for its ground; 0 to 1e4
  double gap = 0.01;              ///< the search ends where (length - bound) / length is no larger; >= 0, < 1
  double time_limit_s = 60;       ///< or after so long; > 0, at most a week
};

/// Throws Error(input) for settings that are out of their range, with the key of a mission file as the place
/// ("tour.vehicle.speed").
VANTAGE_API void check_tour_settings(const TourSettings& settings);

}  // namespace vantage
