#include <cmath>
#include <numbers>

#include "limit_attack.h"

namespace attack {

using vantage::Vec3;

template <>
LimitFacts facts_of<Limit::incidence>() {
  const auto angle = [](Random& random, MeshCase& c) {
    if (c.target.is_point() && !c.target.front) return claim_min_range(random, c);
    c.sensor.incidence_deg = random.uniform(10, 85);
  };
  return {"incidence", {"incidence"}, {"incidence:"}, false, {{10, "incidence", angle}}};
}

template <>
bool is_exact<Limit::incidence>(const double& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::incidence>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  const vantage::Target& target = c.parts[0];
  if ((!target.is_point() || target.front) && random.chance(0.5)) c.sensor.incidence_deg = random.uniform(1, 89);
}

template <>
void draw_in_flight<Limit::incidence>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::incidence>(MissionDraws& draws) {
  Random& random = draws.random;
  if (random.chance(0.15)) draws.sensor += ", incidence: " + exact_text(random.uniform(20, 88));
}

template <>
void draw_in_tour<Limit::incidence>(TourDraws& draws) {
  Random& random = draws.random;
  if (random.chance(0.2)) draws.mission_sensor += ", incidence: " + exact_text(random.uniform(40, 85));
}

template <>
void add_anchors<Limit::incidence>(const double& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::incidence>(const double& /*limit*/, MeshPlaces& /*places*/) {}  // others meet it often

template <>
AddMargins margins_of<Limit::incidence>(const double& limit, const SeenBy& by) {
  const double angle = limit * std::numbers::pi / 180;
  return [angle, &by](const Vec3& p, std::vector<Margin>& margins) {
    for (const SeenTarget& part : by.parts) {
      for (const Vec3& corner : part.corners) {
        const double height = part.normal.dot(p - corner);
        const double margin = height * std::sin(angle) - (p - corner - height * part.normal).norm() * std::cos(angle);
        add_margin(margins, {"incidence", margin, margin});
      }
    }
  };
}

template <>
void move<Limit::incidence>(double& /*limit*/, const Placement& /*pose*/) {}

template <>
void leave_out<Limit::incidence>(vantage::Navigation& /*navigation*/, vantage::Sensor& sensor) {
  sensor.incidence_deg.reset();
}

template <>
void add_text<Limit::incidence>(const double& limit, MissionLines& lines) {
  lines.sensor += "  incidence: " + exact_text(limit) + "\n";
}

template <>
void write_beside<Limit::incidence>(const double& /*limit*/, WrittenClaim& /*claim*/) {}

}  // namespace attack
