#include "limits/draws.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "vantage/error.h"

namespace vantage::bench {
namespace {

/// A convex polygon of 3 to 8 corners and up to 10 m across, anywhere in the middle of the scene, level or askew.
Target draw_target(const SceneStatistics& scene, Draw& draw) {
  const Box& box = scene.bounds;
  const auto between = [&](int axis, double low, double high) {
    return box.min[axis] + draw.uniform(low, high) * (box.max[axis] - box.min[axis]);
  };
  const double x = between(0, 0.25, 0.75), y = between(1, 0.25, 0.75);
  const Vec3 centre(x, y, between(2, 0.02, 0.7));
  const Vec3 normal = draw.chance(0.4) ? Vec3::UnitZ() : draw.direction();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const int count = 3 + static_cast<int>(draw.uniform(0, 5.999));
  const double radius = std::exp(draw.uniform(std::log(0.5), std::log(5)));
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(2 * std::numbers::pi * (i + draw.uniform(0.1, 0.9)) / count);
  std::vector<Vec3> corners;
  for (const double angle : angles) corners.push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
  Target target = Target::polygon(corners);
  target.front = normal;
  return target;
}

void widen(Sensor& sensor) {
  sensor.camera->half_width *= 1.01;
  sensor.camera->half_height *= 1.01;
}

}  // namespace

const std::vector<Limit>& limits() {
  static const std::vector<Limit> kLimits = {
      {"min_range", [](Sensor& s, Draw& d) { s.min_range_m = d.uniform(0.1, 0.4) * s.max_range_m; },
       [](Sensor& s) { s.min_range_m *= 0.99; }},
      {"incidence", [](Sensor& s, Draw& d) { s.incidence_deg = d.uniform(30, 75); },
       [](Sensor& s) { *s.incidence_deg *= 1.01; }},
      {"pixel",
       [](Sensor& s, Draw& d) {
         if (!s.camera) s.camera = pinhole_of_fov(150, 140, 20000, 15000);
         s.pixel = PixelLimit{d.uniform(0.6, 1.2) * s.max_range_m / *s.camera->focal_px, PixelLimit::Kind::worst};
       },
       [](Sensor& s) { s.pixel->size_m *= 1.01; }},
      {"sun",
       [](Sensor& s, Draw& d) {
         s.sun = SunLimit{d.direction(), d.uniform(10, 40)};
         s.sun->direction.z() = std::abs(s.sun->direction.z());
       },
       [](Sensor& s) { s.sun->exclude_deg *= 0.99; }},
      {"gimbal",
       [](Sensor& s, Draw& d) {
         s.camera = pinhole_of_fov(d.uniform(25, 80), d.uniform(20, 60), 4000, 3000);
         s.mount = {};
         if (d.chance(0.5)) {
           s.mount.min_pitch_deg = d.uniform(-90, -30);
           s.mount.max_pitch_deg = d.uniform(-10, 60);
         }
       },
       widen},
      {"fixed",
       [](Sensor& s, Draw& d) {
         s.camera = pinhole_of_fov(d.uniform(40, 90), d.uniform(40, 80), 4000, 3000);
         const double pitch = d.uniform(-90, 0);
         s.mount = {.yaw_deg = d.uniform(0, 360), .min_pitch_deg = pitch, .max_pitch_deg = pitch};
       },
       widen},
  };
  return kLimits;
}

Sensor draw_sensor(Draw& draw, const std::vector<std::string>& among, std::string& names) {
  for (;;) {
    Sensor sensor{.max_range_m = std::exp(draw.uniform(std::log(40), std::log(250)))};
    names.clear();
    for (const Limit& limit : limits()) {
      const bool is_second_camera = sensor.camera && std::string(limit.name) == "fixed";
      const bool is_wanted = among.empty() || std::find(among.begin(), among.end(), limit.name) != among.end();
      if (!is_wanted || is_second_camera || !draw.chance(0.4)) continue;
      limit.add(sensor, draw);
      if (!names.empty()) names += "+";
      names += limit.name;
    }
    try {
      check_sensor(sensor);
      return sensor;
    } catch (const Error&) {
      continue;  // limits that exclude each other
    }
  }
}

PreparedTarget draw_prepared(const PreparedCity& city, const Sensor& sensor, Draw& draw) {
  for (;;) {
    try {
      return PreparedTarget(city.prepared, draw_target(city.prepared.statistics(), draw), sensor);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;  // pierced
    }
  }
}

}  // namespace vantage::bench
