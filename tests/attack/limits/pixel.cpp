// Limit::pixel, and the limit of the other kind, which is a range.
#include "limit_attack.h"

namespace attack {

using vantage::PixelLimit;
using vantage::Vec3;

namespace {

void claim_worst_pixel(Random& random, MeshCase& c) {
  if (c.target.is_point() && !c.target.front) return claim_min_range(random, c);
  claim_camera(random, c);
  c.sensor.mount = {};
  c.sensor.pixel =
      PixelLimit{random.uniform(0.3, 1.5) * kClaimRange / *c.sensor.camera->focal_px, PixelLimit::Kind::worst};
}

void claim_pixel_face_on(Random& random, MeshCase& c) {
  claim_camera(random, c);
  c.sensor.pixel =
      PixelLimit{random.uniform(0.3, 1.2) * kClaimRange / *c.sensor.camera->focal_px, PixelLimit::Kind::perpendicular};
}

}  // namespace

template <>
LimitFacts facts_of<Limit::pixel>() {
  return {"pixel",
          {"pixel"},
          {"pixel:"},
          false,
          {{13, "pixel", claim_worst_pixel}, {14, "pixel face on", claim_pixel_face_on}}};
}

template <>
bool is_exact<Limit::pixel>(const PixelLimit& /*limit*/) {
  return false;
}

// With the camera, of which it makes sense.

template <>
void draw_in_case<Limit::pixel>(CaseDraws& /*draws*/) {}

template <>
void draw_in_flight<Limit::pixel>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::pixel>(MissionDraws& /*draws*/) {}

template <>
void draw_in_tour<Limit::pixel>(TourDraws& /*draws*/) {}

template <>
void add_anchors<Limit::pixel>(const PixelLimit& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::pixel>(const PixelLimit& /*limit*/, MeshPlaces& /*places*/) {}  // others meet it often

template <>
AddMargins margins_of<Limit::pixel>(const PixelLimit& limit, const SeenBy& by) {
  const double radius = 0.5 * limit.size_m * by.sensor.camera->focal_px.value();
  return [radius, &by](const Vec3& p, std::vector<Margin>& margins) {
    for (const SeenTarget& part : by.parts) {
      if (part.all_sides) continue;
      for (const Vec3& corner : part.corners) {
        const double margin = radius - (p - corner - radius * part.normal).norm();
        add_margin(margins, {"pixel", margin, margin});
      }
    }
  };
}

template <>
void move<Limit::pixel>(PixelLimit& limit, const Placement& pose) {
  limit.size_m *= pose.unit;
}

/// Of either kind.
template <>
void leave_out<Limit::pixel>(vantage::Navigation& /*navigation*/, vantage::Sensor& sensor) {
  sensor.pixel.reset();
}

template <>
void add_text<Limit::pixel>(const PixelLimit& limit, MissionLines& lines) {
  lines.sensor += "  pixel: {size: " + exact_text(limit.size_m) + ", kind: worst}\n";
}

template <>
void write_beside<Limit::pixel>(const PixelLimit& /*limit*/, WrittenClaim& /*claim*/) {}

}  // namespace attack
