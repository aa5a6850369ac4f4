#include <cmath>
#include <numbers>

#include "limit_attack.h"
#include "sensor_oracle.h"

namespace attack {

using vantage::SunLimit;
using vantage::Vec3;

namespace {

void claim_sun(Random& random, MeshCase& c) {
  const double exclude = random.magnitude(2, 90);
  Vec3 direction = random.direction();
  if (random.chance(0.7)) {
    direction = (middle_of(c) - draw_place(c, random)).normalized();  // the target is seen before it from there
    direction = (direction + random.uniform(0, 2) * std::sin(exclude * (std::numbers::pi / 180)) * random.direction())
                    .normalized();
  }
  if (random.chance(0.8)) direction.z() = std::abs(direction.z());  // missions know no other
  c.sensor.sun = SunLimit{direction, exclude};
}

}  // namespace

template <>
LimitFacts facts_of<Limit::sun>() {
  return {"sun", {"sun"}, {"sun:"}, false, {{15, "sun", claim_sun}, {16, "sun", claim_sun}}};
}

template <>
bool is_exact<Limit::sun>(const SunLimit& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::sun>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  if (random.chance(0.5)) c.sensor.sun = SunLimit{random.direction(), random.uniform(0.5, 90)};
}

template <>
void draw_in_flight<Limit::sun>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::sun>(MissionDraws& draws) {
  Random& random_ = draws.random;
  if (random_.chance(0.15)) {
    draws.sensor += ", sun: {azimuth: " + exact_text(random_.uniform(0, 360)) +
                    ", elevation: " + exact_text(random_.uniform(0, 89)) +
                    ", exclude: " + exact_text(random_.uniform(5, 60)) + "}";
  }
}

template <>
void draw_in_tour<Limit::sun>(TourDraws& /*draws*/) {}

template <>
void add_anchors<Limit::sun>(const SunLimit& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::sun>(const SunLimit& limit, MeshPlaces& places) {
  for (int i = 0; i < 10; ++i) {
    const double away = places.c.sensor.max_range_m * places.random.uniform(0.05, 0.95);
    places.about(places.centre - away * limit.direction.normalized(), 0.3 * away);
  }
}

template <>
AddMargins margins_of<Limit::sun>(const SunLimit& limit, const SeenBy& by) {
  return [&limit, &by](const Vec3& p, std::vector<Margin>& margins) {
    for (const SeenTarget& part : by.parts) {
      const double margin = -0.5 * depth_in_sun(limit, part, p);
      add_margin(margins, {"sun", margin, margin, false});
    }
  };
}

template <>
void move<Limit::sun>(SunLimit& /*limit*/, const Placement& /*pose*/) {}

template <>
void leave_out<Limit::sun>(vantage::Navigation& /*navigation*/, vantage::Sensor& sensor) {
  sensor.sun.reset();
}

template <>
void add_text<Limit::sun>(const SunLimit& limit, MissionLines& lines) {
  const Vec3 to_sun = limit.direction.normalized();
  constexpr double kDegree = std::numbers::pi / 180;
  lines.sensor += "  sun: {azimuth: " + exact_text(std::atan2(to_sun.x(), to_sun.y()) / kDegree) +
                  ", elevation: " + exact_text(std::asin(to_sun.z()) / kDegree) +
                  ", exclude: " + exact_text(limit.exclude_deg) + "}\n";
}

template <>
void write_beside<Limit::sun>(const SunLimit& /*limit*/, WrittenClaim& /*claim*/) {}

}  // namespace attack
