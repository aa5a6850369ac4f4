#include "live/limit_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "common/input.h"
#include "vantage/sensor.h"

namespace vantage::live {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// To a thousandth: millimetres.
std::string number(double value) { return shortest(std::round(value * 1e3) / 1e3 + 0.0); }

std::string metres(double value) { return number(value) + " m"; }
std::string degrees(double value) { return number(value) + "\u00b0"; }
std::string percent(double share) { return number(100 * share) + " %"; }

std::string band(double low, double high) {
  if (std::isinf(low) && std::isinf(high)) return "any height";
  if (std::isinf(low)) return "below " + metres(high);
  return std::isinf(high) ? "above " + metres(low) : metres(low) + " to " + metres(high);
}

/// "z 0 m to 60 m, 30 m to 120 m above the ground".
std::string heights_of(const Zone& zone) {
  const bool has_z = std::isfinite(zone.min_z_m) || std::isfinite(zone.max_z_m);
  const std::string z = has_z ? "z " + band(zone.min_z_m, zone.max_z_m) : "";
  if (!zone.above_ground) return has_z ? z : "any height";
  const std::string agl = band(zone.above_ground->min_m, zone.above_ground->max_m) + " above the ground";
  return has_z ? z + ", " + agl : agl;
}

std::string text_of(const Box& box) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += std::string(axis > 0 ? ", " : "") + "xyz"[axis] + " " + band(box.min[axis], box.max[axis]);
  }
  return text;
}

std::string text_of(const Zone& zone) {
  if (zone.is_box) return text_of(zone.box());
  std::string text = std::to_string(zone.outer.size()) + " corners";
  if (!zone.holes.empty()) text += ", " + std::to_string(zone.holes.size()) + " holes";
  return text + ", " + heights_of(zone);
}

std::string text_of(const Pinhole& camera, const MissionFile& file) {
  const auto [wide, high] = camera.fov_deg();
  const std::string view = degrees(wide) + " by " + degrees(high);
  const auto* const model = file.camera ? std::get_if<CameraModel>(&*file.camera) : nullptr;
  return model ? model->name + ", " + view : view;
}

std::string text_of(const Mount& mount) {
  std::string text = mount.min_pitch_deg == mount.max_pitch_deg
                         ? "fixed pitch " + degrees(mount.min_pitch_deg)
                         : "pitch " + degrees(mount.min_pitch_deg) + " to " + degrees(mount.max_pitch_deg);
  text += mount.yaw_deg ? ", yaw " + degrees(*mount.yaw_deg) : ", any yaw";
  return text + ", roll " + degrees(mount.roll_deg);
}

std::string text_of(const SunLimit& sun, const MissionFile& file) {
  const Vec3& to = sun.direction;
  const std::string place = "azimuth " + degrees(std::fmod(std::atan2(to.x(), to.y()) * kDegreesPerRadian + 360, 360)) +
                            ", elevation " + degrees(std::atan2(to.z(), to.head<2>().norm()) * kDegreesPerRadian);
  return "at least " + degrees(sun.exclude_deg) + " from " +
         (file.sun_time ? file.sun_time->text + ", " + place : place);
}

using Lines = std::vector<LimitLine>;

// All members are named: a limit that is added does not compile here before it is told.
void add_sensor(const Sensor& sensor, const MissionFile& file, Lines& lines) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor;
  const double range = range_limit_m(sensor);
  const bool is_of_pixel = range < max_range_m;
  lines.push_back({"Range", "at most " + metres(range) + (is_of_pixel ? ", from the size of a pixel" : "") +
                                (file.vlos ? ", as far as a pilot sees the aircraft" : "")});
  if (min_range_m > 0) lines.push_back({"Nearest", metres(min_range_m)});
  if (incidence_deg) lines.push_back({"Slant", "at most " + degrees(*incidence_deg) + " from the target's normal"});
  if (camera) {
    lines.push_back({"Camera", text_of(*camera, file)});
    lines.push_back({mount.min_pitch_deg == mount.max_pitch_deg ? "Mount" : "Gimbal", text_of(mount)});
  }
  if (pixel) {
    lines.push_back({"Pixel", "covers at most " + metres(pixel->size_m) +
                                  (pixel->kind == PixelLimit::Kind::worst ? ", slant counted" : ", seen face on")});
  }
  if (sun) lines.push_back({"Sun", text_of(*sun, file)});
  if (link) {
    lines.push_back(
        {"Radio link", number(link->frequency_ghz) + " GHz, " + percent(link->clear) + " of the zone's radius clear"});
  }
  if (visible) lines.push_back({"Seen", "at least " + percent(visible->share) + " of the target"});
}

void add_navigation(const Navigation& navigation, Lines& lines) {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  if (altitude) lines.push_back({"Altitude", "z " + band(altitude->min_m, altitude->max_m)});
  if (above_ground) lines.push_back({"Above ground", band(above_ground->min_m, above_ground->max_m)});
  if (clearance) lines.push_back({"Clearance", metres(clearance->distance_m) + " from all that is not ground"});
  for (std::size_t i = 0; i < keep_in.size(); ++i) {
    lines.push_back({"Keep in, " + zone_name(keep_in, i), text_of(keep_in[i])});
  }
  for (const KeepInMesh& mesh : meshes) {
    lines.push_back({"Keep in, mesh", mesh.name + ", " + text_of(bounding_box(mesh.mesh))});
  }
  for (std::size_t i = 0; i < keep_out.size(); ++i) {
    lines.push_back({"Keep out, " + zone_name(keep_out, i), text_of(keep_out[i])});
  }
}

/// z of the ground, from its lowest to its highest point.
std::pair<double, double> extent_of(const Ground& ground) {
  if (!ground.surface) return {ground.plane_z_m, ground.plane_z_m};
  const Box box = bounding_box(*ground.surface);
  return {box.min.z(), box.max.z()};
}

/// Whatever is without bounds is drawn from here to there: over a range that is shorter than the scene no position is
/// higher than that.
std::pair<double, double> room_of(const Mission& mission) {
  const Box scene = bounding_box(mission.scene().mesh);
  double target = -std::numeric_limits<double>::infinity();
  for (const std::vector<Vec3>& part : mission.target.parts) {
    for (const Vec3& corner : part) target = std::max(target, corner.z());
  }
  const double beyond = std::min(range_limit_m(mission.sensor), (scene.max - scene.min).norm());
  return {scene.min.z(), std::max(scene.max.z(), target + beyond)};
}

DrawnZone drawn(const Zone& zone, std::string name, bool is_kept_out, const std::pair<double, double>& room) {
  DrawnZone result{is_kept_out, std::move(name), {zone.outer}, zone.min_z_m, zone.max_z_m};
  result.rings.insert(result.rings.end(), zone.holes.begin(), zone.holes.end());
  if (zone.above_ground) {
    const auto [low, high] = extent_of(zone.above_ground->ground);
    result.low_m = std::max(result.low_m, low + zone.above_ground->min_m);
    result.high_m = std::min(result.high_m, high + zone.above_ground->max_m);
  }
  if (std::isinf(result.low_m)) result.low_m = std::min(room.first, result.high_m);
  if (std::isinf(result.high_m)) result.high_m = std::max(room.second, result.low_m);
  return result;
}

}  // namespace

std::vector<LimitLine> limit_lines(const Mission& mission) {
  Lines lines;
  add_sensor(mission.sensor, mission.as_written, lines);
  add_navigation(mission.navigation, lines);
  return lines;
}

std::vector<DrawnZone> drawn_zones(const Mission& mission) {
  const std::pair<double, double> room = room_of(mission);
  const Navigation& navigation = mission.navigation;
  std::vector<DrawnZone> zones;
  for (std::size_t i = 0; i < navigation.keep_in.size(); ++i) {
    zones.push_back(drawn(navigation.keep_in[i], zone_name(navigation.keep_in, i), false, room));
  }
  for (std::size_t i = 0; i < navigation.keep_out.size(); ++i) {
    const Zone& zone = navigation.keep_out[i];  // the page draws boxes itself: they can be moved
    if (!zone.is_box) zones.push_back(drawn(zone, zone_name(navigation.keep_out, i), true, room));
  }
  return zones;
}

}  // namespace vantage::live
