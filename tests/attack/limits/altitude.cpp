#include "limit_attack.h"

namespace attack {

using vantage::Vec3;
using Altitude = vantage::Navigation::Altitude;

template <>
LimitFacts facts_of<Limit::altitude>() {
  const auto heights = [](Random& random, MeshCase& c) {
    const double low = random.uniform(-1, 8);
    c.navigation.altitude = {low, low + random.uniform(6, 40)};
  };
  return {"altitude", {"altitude"}, {"altitude: ["}, true, {{0, "altitude", heights}}};
}

template <>
bool is_exact<Limit::altitude>(const Altitude& /*limit*/) {
  return true;
}

template <>
void draw_in_case<Limit::altitude>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  const Vec3 origin = pose(Vec3::Zero());
  if (!random.chance(0.5)) return;
  const double low = random.uniform(-0.2, 0.4) * c.range;
  c.navigation.altitude = {origin.z() + low, origin.z() + low + random.uniform(0.1, 0.8) * c.range};
}

template <>
void draw_in_flight<Limit::altitude>(FlightDraws& draws) {
  auto& [random, c] = draws;
  if (!random.chance(0.1)) return;
  const double low = c.parts[0].parts[0][0].z() + random.uniform(-0.2, 0.3) * c.range;
  c.navigation.altitude = {low, low + random.uniform(0.1, 0.6) * c.range};
}

/// Of the target's height, or above the ground: one of both.
template <>
void draw_in_mission<Limit::altitude>(MissionDraws& draws) {
  Random& random = draws.random;
  const double low = random.uniform(-5, 12);
  if (!random.chance(0.2)) return;
  const bool is_agl = draws.has_ground && random.chance(0.5);
  const double high = low + random.uniform(2, 30);
  draws.add_navigation(is_agl ? "altitude: {agl: " + exact_pair(draws.scale * low, draws.scale * high) + "}"
                              : "altitude: " + exact_pair(draws.height(low), draws.height(high)));
}

template <>
void draw_in_tour<Limit::altitude>(TourDraws& draws) {
  Random& random = draws.random;
  if (random.chance(0.6)) draws.navigation.altitude = {random.uniform(0.5, 15), random.uniform(35, 90)};
}

template <>
void add_anchors<Limit::altitude>(const Altitude& limit, const Vec3& middle, std::vector<Vec3>& anchors) {
  for (const double z : {limit.min_m, limit.max_m}) anchors.emplace_back(middle.x(), middle.y(), z);
}

template <>
void add_places<Limit::altitude>(const Altitude& /*limit*/, MeshPlaces& /*places*/) {}  // others meet it often

template <>
AddMargins margins_of<Limit::altitude>(const Altitude& limit, const SeenBy& /*by*/) {
  return [&limit](const Vec3& p, std::vector<Margin>& margins) {
    const double above = p.z() - limit.min_m, below = limit.max_m - p.z();
    add_margin(margins, {"altitude min", above, above});
    add_margin(margins, {"altitude max", below, below});
  };
}

template <>
void move<Limit::altitude>(Altitude& limit, const Placement& pose) {
  pose.move(limit.min_m);
  pose.move(limit.max_m);
}

template <>
void leave_out<Limit::altitude>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.altitude.reset();
}

template <>
void add_text<Limit::altitude>(const Altitude& limit, MissionLines& lines) {
  lines.add_altitude("z: " + exact_pair(limit.min_m, limit.max_m));
}

template <>
void write_beside<Limit::altitude>(const Altitude& /*limit*/, WrittenClaim& /*claim*/) {}

}  // namespace attack
