#include <algorithm>
#include <limits>
#include <memory>

#include "closed_mesh.h"
#include "limit_attack.h"

namespace attack {

using vantage::Clearance;
using vantage::Vec3;

template <>
LimitFacts facts_of<Limit::clearance>() {
  const auto distance = [](Random& random, MeshCase& c) {
    std::vector<std::uint32_t> ground;
    if (c.ground) ground.push_back(*c.ground);
    c.navigation.clearance = Clearance{random.uniform(0.3, 6), vantage::obstacles_of(c.scene, ground)};
  };
  return {"clearance", {"clearance"}, {"clearance:"}, false, {{8, "clearance", distance}}};
}

template <>
bool is_exact<Limit::clearance>(const Clearance& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::clearance>(CaseDraws& /*draws*/) {}

template <>
void draw_in_flight<Limit::clearance>(FlightDraws& draws) {
  auto& [random, c] = draws;
  if (random.chance(0.1) && !c.scene.mesh.empty()) {
    c.navigation.clearance = Clearance{c.range * random.magnitude(1e-3, 0.3), obstacles_of(c.scene)};
  }
}

template <>
void draw_in_mission<Limit::clearance>(MissionDraws& draws) {
  if (draws.random.chance(0.15)) draws.add_navigation("clearance: " + draws.length(draws.random.uniform(0.1, 3)));
}

template <>
void draw_in_tour<Limit::clearance>(TourDraws& /*draws*/) {}  // of the tour's settings

template <>
void add_anchors<Limit::clearance>(const Clearance& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {
}  // flights are drawn about obstacles anyway

template <>
void add_places<Limit::clearance>(const Clearance& limit, MeshPlaces& places) {
  for (const Vec3& corner : limit.obstacles->vertices) {
    Random& random = places.random;
    places.places.push_back(corner + limit.distance_m * random.uniform(0, 1.5) * random.direction());
  }
}

template <>
AddMargins margins_of<Limit::clearance>(const Clearance& limit, const SeenBy& /*by*/) {
  return [&limit](const Vec3& p, std::vector<Margin>& margins) {
    double nearest = std::numeric_limits<double>::infinity();
    const auto& [vertices, triangles] = *limit.obstacles;
    for (const vantage::Triangle& t : triangles) {
      const Corners corners = {vertices[t[0]] - p, vertices[t[1]] - p, vertices[t[2]] - p};
      nearest = std::min(nearest, distance_to_triangle(Vec3::Zero(), corners));
    }
    add_margin(margins, {"clearance", nearest - limit.distance_m, nearest - limit.distance_m});
  };
}

template <>
void move<Limit::clearance>(Clearance& limit, const Placement& pose) {
  vantage::Mesh moved = *limit.obstacles;
  pose.move(moved);
  limit = Clearance{limit.distance_m * pose.unit, std::make_shared<const vantage::Mesh>(std::move(moved))};
}

template <>
void leave_out<Limit::clearance>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.clearance.reset();
}

template <>
void add_text<Limit::clearance>(const Clearance& limit, MissionLines& lines) {
  lines.navigation += "  clearance: " + exact_text(limit.distance_m) + "\n";
}

template <>
void write_beside<Limit::clearance>(const Clearance& /*limit*/, WrittenClaim& claim) {
  claim.names_ground = claim.c.ground.has_value();
}

}  // namespace attack
