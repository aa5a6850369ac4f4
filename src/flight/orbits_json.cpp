#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flight/view_json.h"
#include "vantage/standpoints.h"

namespace vantage {
namespace {

using OrbitJson = internal::flight::Json;

OrbitJson value_or_null(const std::optional<double>& value) { return value ? OrbitJson(*value) : OrbitJson(); }

OrbitJson row_of(const Orbit& orbit) {
  OrbitJson row = {{"kind", name_of(orbit.kind)},
                   {"shape", orbit.straight_m > 0 ? "racetrack" : "circle"},
                   {"value", orbit.value},
                   {"bound", orbit.bound},
                   {"centre", {orbit.centre.x(), orbit.centre.y(), orbit.centre.z()}},
                   {"longitude_deg", value_or_null(orbit.place.longitude_deg)},
                   {"latitude_deg", value_or_null(orbit.place.latitude_deg)},
                   {"above_ground_m", value_or_null(orbit.place.above_ground_m)},
                   {"above_sea_m", value_or_null(orbit.place.above_sea_m)},
                   {"radius_m", orbit.radius_m},
                   {"straight_m", orbit.straight_m},
                   {"heading_deg", orbit.heading_deg},
                   {"clockwise", orbit.clockwise},
                   {"length_m", orbit.length_m},
                   {"margin_m", orbit.margin_m},
                   {"min_distance_m", orbit.min_distance_m},
                   {"max_distance_m", orbit.max_distance_m},
                   {"min_pitch_deg", orbit.min_pitch_deg},
                   {"max_pitch_deg", orbit.max_pitch_deg},
                   {"pixel_m", value_or_null(orbit.pixel_m)},
                   {"incidence_deg", value_or_null(orbit.incidence_deg)},
                   {"obstacle_distance_m", value_or_null(orbit.obstacle_distance_m)}};
  row["obstacle"] = orbit.obstacle_distance_m ? OrbitJson(orbit.obstacle) : OrbitJson();
  return row;
}

}  // namespace

std::string json_text(const std::vector<NamedOrbits>& targets) {
  OrbitJson rows = OrbitJson::array();
  for (const NamedOrbits& target : targets) {
    OrbitJson row = {{"target", target.target},
                     {"margin_m", target.orbits.margin_m},
                     {"reason", target.orbits.reason},
                     {"notes", target.orbits.notes}};
    row["orbits"] = OrbitJson::array();
    for (const Orbit& orbit : target.orbits.found) row["orbits"].push_back(row_of(orbit));
    rows.push_back(std::move(row));
  }
  return internal::flight::dumped({{"targets", std::move(rows)}});
}

}  // namespace vantage
