#include <Eigen/Core>
#include <optional>

#include "core/format.h"
#include "flight/obstacles.h"
#include "geo/on_globe.h"
#include "geo/zone_reach.h"
#include "vantage/earth.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"

namespace vantage {
namespace {

/// Longitude and latitude, or x and y for a plan in the scene frame.
Eigen::Vector2d home_of_tour(bool is_in_scene_frame, const Mission& mission) {
  if (is_in_scene_frame || !mission.scene().georeference) return mission.home->head<2>();
  const auto place = internal::geo::OnGlobe(*mission.scene().georeference).to_geodetic(*mission.home).place;
  return {place.longitude_deg, place.latitude_deg};
}

/// Whether the plan's home is that of the mission's tour, but for what plans round.
bool is_home_of_tour(const FlightPlan& plan, const Mission& mission) {
  constexpr double kSameM = 0.1, kSameDeg = 1e-6;
  if (!mission.home) return false;
  if (!plan.home) return true;
  const Eigen::Vector2d away = plan.home->horizontal - home_of_tour(plan.is_in_scene_frame, mission);
  return away.cwiseAbs().maxCoeff() <= (plan.is_in_scene_frame ? kSameM : kSameDeg);
}

bool has_zones_of_the_earth(const Mission& mission) {
  const MissionFile& file = mission.as_written;
  const bool has_zones = !mission.navigation.keep_in.empty() || !mission.navigation.keep_out.empty();
  return has_zones && !(file.crs.empty() && file.keep_in_files.empty() && file.keep_out_files.empty());
}

/// In a Cartesian frame such zones are on the safe side within their reach alone.
std::optional<Warning> beyond_zones(const Mission& mission, const Flight& flight, const std::string& plan) {
  const std::optional<Georeference>& georeference = mission.scene().georeference;
  if (!georeference || is_map(*georeference) || !has_zones_of_the_earth(mission)) return std::nullopt;
  const internal::geo::ZoneReach reach = internal::geo::zone_reach(mission);
  for (const FlightPoint& point : flight.points) {
    if (reach.holds(point.position)) continue;
    return Warning{
        WarningCode::plan_beyond_zones,
        internal::core::format("{} leaves the region where zones are kept with certainty, within {:.0f} m of "
                               "the scene's origin and from z {:.0f} to {:.0f}: farther away they may be off",
                               plan, reach.farthest_m, reach.lowest_m, reach.highest_m)};
  }
  return std::nullopt;
}

}  // namespace

LocatedPlan locate_flight(const Mission& mission, const FlightPlan& plan, LocateOptions options) {
  std::optional<Ground> ground;
  if (options.ground == nullptr) {
    ground = internal::flight::ground_if_known(mission);
    options.ground = ground ? &*ground : nullptr;
  }
  if (!options.georeference) options.georeference = mission.scene().georeference;
  if (!options.levels.sea_level_z_m) options.levels.sea_level_z_m = sea_level_m(mission);
  if (!options.home && is_home_of_tour(plan, mission)) {
    if (!plan.home) options.home = home_of_tour(plan.is_in_scene_frame, mission);
    if (!options.home_z_m) options.home_z_m = mission.home->z();
  }
  LocatedPlan located = locate_flight(plan, options);
  if (auto note = beyond_zones(mission, located.flight, plan.file)) located.notes.push_back(*std::move(note));
  return located;
}

}  // namespace vantage
