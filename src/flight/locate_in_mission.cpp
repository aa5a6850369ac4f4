#include <Eigen/Core>
#include <array>
#include <optional>

#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/flight_plan.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"

namespace vantage {
namespace {

/// Longitude and latitude, or x and y for a plan in the scene frame.
std::optional<Eigen::Vector2d> home_of_tour(const FlightPlan& plan, const Mission& mission) {
  if (plan.home || !mission.home) return std::nullopt;
  const Eigen::Vector2d at = mission.home->head<2>();
  if (plan.is_in_scene_frame || !mission.scene().georeference) return at;
  return positions_in_crs(*mission.scene().georeference, "EPSG:4326", std::array{at}).front();
}

/// Nothing where the scene does not say what of it is ground: locating says when it is needed.
std::optional<Ground> ground_if_known(const Mission& mission) {
  try {
    return ground_of(mission);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::ground_missing) throw;
    return std::nullopt;
  }
}

}  // namespace

LocatedPlan locate_flight(const Mission& mission, const FlightPlan& plan, LocateOptions options) {
  std::optional<Ground> ground;
  if (options.ground == nullptr) {
    ground = ground_if_known(mission);
    options.ground = ground ? &*ground : nullptr;
  }
  if (!options.georeference) options.georeference = mission.scene().georeference;
  if (!options.levels.sea_level_z_m) options.levels.sea_level_z_m = sea_level_m(mission);
  if (!options.home) options.home = home_of_tour(plan, mission);
  return locate_flight(plan, options);
}

}  // namespace vantage
