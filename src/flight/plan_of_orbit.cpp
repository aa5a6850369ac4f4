// Orbits as plans of ground stations.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "flight/view_aim.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/standpoints.h"

namespace vantage {
namespace {

/// Where the camera looks from the centre of an orbit.
Vec3 target_centre(const ViewDescription& view) {
  const double yaw = view.yaw_deg * std::numbers::pi / 180, pitch = view.pitch_deg * std::numbers::pi / 180;
  const Vec3 along(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch));
  return view.position + view.distance_m * along;
}

/// So far above the home, but 20 m at most, the limits of height allow to climb: a millimetre less, for rounding. 0
/// where it lies above them.
double room_above(const Vec3& home, const Navigation& navigation) {
  constexpr double kRoundingM = 1e-3;
  Navigation heights;
  heights.altitude = navigation.altitude;
  heights.above_ground = navigation.above_ground;
  const double most_m = DjiAircraft().takeoff_height_m;
  double room_m = most_m;
  for (const LegBreak& broken : LegLimits(heights).broken({home, home + Vec3(0, 0, most_m)})) {
    if (!broken.limit.ends_with(" max")) continue;
    room_m = std::clamp(broken.intervals.front().begin * most_m - kRoundingM, 0.0, room_m);
  }
  return room_m;
}

}  // namespace

FlightOut plan_of_orbit(const Orbit& orbit, const Mission& mission, PlanFormat format) {
  if (!mission.scene().georeference && format != PlanFormat::csv) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, and the plan has to",
                name_of(format), "write it as .csv, or give a scene with a place: a map, or a mesh with 'crs'");
  }
  const TourSettings settings = mission.as_written.tour.value_or(TourSettings());
  FlightOut out;
  out.flight = flight_of(orbit);
  if (orbit.straight_m == 0) out.flight = {{FlightPoint{orbit.centre}}, 0};
  out.actions.resize(out.flight.points.size());
  FlightAction& first = out.actions.front();
  if (orbit.straight_m == 0) first.loiter_radius_m = (orbit.clockwise ? 1 : -1) * orbit.radius_m;
  if (orbit.place.is_centred) first.look_at = target_centre(orbit.place);
  first.sees = mission.target.name;
  out.name = mission.target.name;
  if (mission.scene().georeference) {
    out.georeference = *mission.scene().georeference;
  } else {
    out.heights = HeightDatum::scene_z;
  }
  out.levels.sea_level_z_m = sea_level_m(mission);
  out.keep_in = mission.navigation.keep_in;
  out.keep_out = mission.navigation.keep_out;
  out.aircraft = internal::flight::aircraft_of_camera(mission);
  out.home = mission.home;
  if (mission.home) out.highest_takeoff_m = room_above(*mission.home, mission.navigation);
  out.vehicle =
      settings.vehicle.kind == TourVehicle::Kind::fixed_wing ? PlanVehicle::fixed_wing : PlanVehicle::multirotor;
  out.speed_m_s = settings.vehicle.speed_m_s;
  out.takes_off = out.returns_home = mission.home.has_value();
  const bool knows_no_home = format == PlanFormat::kml || format == PlanFormat::gpx || format == PlanFormat::geojson ||
                             format == PlanFormat::czml;
  if (mission.home && mission.scene().georeference && !knows_no_home) out.heights = HeightDatum::home;
  return out;
}

}  // namespace vantage
