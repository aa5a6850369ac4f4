#include "limit_attack.h"
#include "over_ground.h"

namespace attack {

using vantage::AboveGround;
using vantage::Vec3;

template <>
LimitFacts facts_of<Limit::above_ground>() {
  const auto heights = [](Random& random, MeshCase& c) {
    const double low = random.uniform(0, 8);
    c.navigation.above_ground = AboveGround{low, low + random.uniform(6, 40), vantage::Ground{}};
    if (c.ground && random.chance(0.7)) c.navigation.above_ground->ground = vantage::ground_of(c.scene, *c.ground);
  };
  return {"agl", {"agl", "ground edge"}, {"altitude: {agl"}, true, {{7, "agl", heights}}};
}

template <>
bool is_exact<Limit::above_ground>(const AboveGround& limit) {
  return !limit.ground.surface;
}

template <>
void draw_in_case<Limit::above_ground>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  const Vec3 origin = pose(Vec3::Zero());
  if (!random.chance(0.2)) return;
  const double low = random.uniform(-0.2, 0.4) * c.range, plane_z_m = origin.z() - random.uniform(0, 0.2) * c.range;
  c.navigation.above_ground = {low, low + random.uniform(0.1, 0.8) * c.range, vantage::Ground{plane_z_m}};
}

template <>
void draw_in_flight<Limit::above_ground>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::above_ground>(MissionDraws& /*draws*/) {}  // with the altitude

template <>
void draw_in_tour<Limit::above_ground>(TourDraws& draws) {
  Random& random = draws.random;
  if (!draws.has_ground || !random.chance(0.3)) return;
  const double low = random.uniform(1, 12), high = random.uniform(30, 90);
  draws.mission_navigation += "altitude: {agl: " + exact_pair(low, high) + "}";
}

template <>
void add_anchors<Limit::above_ground>(const AboveGround& /*limit*/, const Vec3& /*middle*/,
                                      std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::above_ground>(const AboveGround& /*limit*/, MeshPlaces& /*places*/) {}  // others meet it often

template <>
AddMargins margins_of<Limit::above_ground>(const AboveGround& limit, const SeenBy& /*by*/) {
  return [&limit](const Vec3& p, std::vector<Margin>& margins) {
    const auto& [low, high, ground] = limit;
    const std::vector<Plan> places = near_places(ground, p);
    const auto add = [&, &over = ground](const char* name, const auto& value) {
      add_margin(margins, between(name, places, [&](const Plan& place) { return value(pieces_at(over, place)); }));
    };
    add("ground edge", [](const Pieces& g) { return g.is_there() ? kNoLimit : -g.beside; });
    add("agl min", [&, low = low](const Pieces& g) { return g.is_there() ? p.z() - g.highest - low : kNoLimit; });
    add("agl max", [&, high = high](const Pieces& g) { return g.is_there() ? g.lowest + high - p.z() : kNoLimit; });
  };
}

template <>
void move<Limit::above_ground>(AboveGround& limit, const Placement& pose) {
  pose.move(limit);
}

template <>
void leave_out<Limit::above_ground>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.above_ground.reset();
}

template <>
void add_text<Limit::above_ground>(const AboveGround& limit, MissionLines& lines) {
  lines.add_altitude("agl: " + exact_pair(limit.min_m, limit.max_m));
  lines.navigation += limit.ground.surface ? "  # above ground that is none of a mission's text\n"
                                           : "  ground: " + exact_text(limit.ground.plane_z_m) + "\n";
}

template <>
void write_beside<Limit::above_ground>(const AboveGround& limit, WrittenClaim& claim) {
  claim.ground = limit.ground;
}

}  // namespace attack
