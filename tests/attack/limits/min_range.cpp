#include "limit_attack.h"
#include "sensor_oracle.h"

namespace attack {

using vantage::Vec3;

void claim_min_range(Random& random, MeshCase& c) { c.sensor.min_range_m = random.magnitude(0.3, 20); }

template <>
LimitFacts facts_of<Limit::min_range>() {
  return {"min_range", {"min_range"}, {"min_range:"}, false, {{9, "min_range", claim_min_range}}};
}

template <>
bool is_exact<Limit::min_range>(const double& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::min_range>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  if (random.chance(0.5)) c.sensor.min_range_m = c.range * random.magnitude(1e-3, 0.7);
}

template <>
void draw_in_flight<Limit::min_range>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::min_range>(MissionDraws& draws) {
  Random& random = draws.random;
  if (random.chance(0.2)) draws.sensor += ", min_range: " + draws.length(draws.range * random.uniform(0.02, 0.6));
}

template <>
void draw_in_tour<Limit::min_range>(TourDraws& draws) {
  Random& random = draws.random;
  if (random.chance(0.2)) draws.mission_sensor += ", min_range: " + exact_text(random.uniform(2, 10));
}

template <>
void add_anchors<Limit::min_range>(const double& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::min_range>(const double& limit, MeshPlaces& places) {
  places.about(places.centre, 1.5 * limit);
}

template <>
AddMargins margins_of<Limit::min_range>(const double& limit, const SeenBy& by) {
  return [&limit, &by](const Vec3& p, std::vector<Margin>& margins) {
    for (const SeenTarget& part : by.parts) {
      const double margin = distance_to_target(part, p) - limit;
      add_margin(margins, {"min_range", margin, margin});
    }
  };
}

template <>
void move<Limit::min_range>(double& limit, const Placement& pose) {
  limit *= pose.unit;
}

template <>
void leave_out<Limit::min_range>(vantage::Navigation& /*navigation*/, vantage::Sensor& sensor) {
  sensor.min_range_m = 0;
}

template <>
void add_text<Limit::min_range>(const double& limit, MissionLines& lines) {
  lines.sensor += "  min_range: " + exact_text(limit) + "\n";
}

template <>
void write_beside<Limit::min_range>(const double& /*limit*/, WrittenClaim& /*claim*/) {}

}  // namespace attack
