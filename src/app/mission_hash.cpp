// docs/hashes.md
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "common/input.h"
#include "core/sha256.h"
#include "request/describe_mission.h"
#include "request/describe_spheres.h"
#include "request/sensor_json.h"
#include "vantage/mission.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using SortedJson = nlohmann::json;

/// Numbers are written as vantage writes them: the shortest decimal that reads back the same.
SortedJson number_text(double value) { return shortest(value + 0.0); }

struct NumberText {
  template <typename Number>
  SortedJson operator()(Number value) const {
    return number_text(static_cast<double>(value));
  }
};

SortedJson sorted_json_of(const Vec3& v) { return {number_text(v.x()), number_text(v.y()), number_text(v.z())}; }

/// Of zones that are boxes.
SortedJson boxes_json(const std::vector<Zone>& zones) {
  SortedJson list = SortedJson::array();
  for (const Zone& zone : zones) {
    if (zone.is_box) list.push_back({sorted_json_of(zone.box().min), sorted_json_of(zone.box().max)});
  }
  return list;
}

SortedJson sorted_json_of(const Zone::Ring& ring) {
  SortedJson list = SortedJson::array();
  for (const Eigen::Vector2d& p : ring) list.push_back({number_text(p.x()), number_text(p.y())});
  return list;
}

SortedJson bound(double at) { return std::isfinite(at) ? number_text(at) : SortedJson(); }

SortedJson sorted_json_of(const AboveGround& limit) {
  const Ground& ground = limit.ground;
  return {{"range", {bound(limit.min_m), bound(limit.max_m)}},
          {"ground", ground.surface ? SortedJson(volume_hash(*ground.surface)) : number_text(ground.plane_z_m)}};
}

/// Of the others.
SortedJson polygons_json(const std::vector<Zone>& zones) {
  SortedJson list = SortedJson::array();
  for (const Zone& zone : zones) {
    if (zone.is_box) continue;
    SortedJson rings = SortedJson::array();
    rings.push_back(sorted_json_of(zone.outer));
    for (const Zone::Ring& hole : zone.holes) rings.push_back(sorted_json_of(hole));
    list.push_back({{"rings", std::move(rings)}, {"z", {bound(zone.min_z_m), bound(zone.max_z_m)}}});
    if (zone.above_ground) list.back()["agl"] = sorted_json_of(*zone.above_ground);
  }
  return list;
}

// All members are named: a limit that is added does not compile here before it is hashed. Polygons are left out where
// there are none, so that missions without them keep their hash.
SortedJson sorted_json_of(const Navigation& limits) {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = limits;
  SortedJson json = {{"boxes", boxes_json(keep_in)}, {"keep_out", boxes_json(keep_out)}};
  json["altitude"] = altitude ? SortedJson{number_text(altitude->min_m), number_text(altitude->max_m)} : SortedJson();
  json["meshes"] = SortedJson::array();
  for (const KeepInMesh& mesh : meshes) json["meshes"].push_back(volume_hash(mesh.mesh));
  if (above_ground) json["agl"] = sorted_json_of(*above_ground);
  if (clearance) {
    json["clearance"] = {{"distance_m", number_text(clearance->distance_m)},
                         {"obstacles", volume_hash(*clearance->obstacles)}};
  }
  if (SortedJson zones = polygons_json(keep_in); !zones.empty()) json["keep_in_zones"] = std::move(zones);
  if (SortedJson zones = polygons_json(keep_out); !zones.empty()) json["keep_out_zones"] = std::move(zones);
  return json;
}

/// With null for what is not given of a camera, and a pair of pitches: so hashes have been from the first.
class SensorForHash : public internal::request::SensorObject<SortedJson, NumberText> {
 public:
  using SensorObject::keys;
  SensorForHash() : SensorObject(NumberText()) {}

  void keys(std::span<const internal::request::Own> /*keys*/, const std::optional<Pinhole>& camera,
            const Mount& mount) {
    if (!camera) return;
    json_["camera"] = {{"half_width", number_text(camera->half_width)},
                       {"half_height", number_text(camera->half_height)}};
    json_["camera"]["focal_px"] = camera->focal_px ? number_text(*camera->focal_px) : SortedJson();
    json_["mount"] = {{"yaw_deg", mount.yaw_deg ? number_text(*mount.yaw_deg) : SortedJson()},
                      {"pitch_deg", {number_text(mount.min_pitch_deg), number_text(mount.max_pitch_deg)}},
                      {"roll_deg", number_text(mount.roll_deg)}};
  }
};

// What is not given is left out, but for the range, so that missions without it keep their hash.
SortedJson sorted_json_of(const Sensor& sensor) {
  SensorForHash object;
  describe(sensor, object);
  SortedJson json = object.json();
  json["max_range_m"] = number_text(sensor.max_range_m);
  return json;
}

template <typename Options>
SortedJson options_json(const Options& options) {
  internal::request::JsonObject<SortedJson, NumberText> object{NumberText()};
  describe(options, object);
  return object.json();
}

SortedJson sorted_json_of(const Target& target) {
  SortedJson parts = SortedJson::array();
  for (const std::vector<Vec3>& part : target.parts) {
    SortedJson vertices = SortedJson::array();
    for (const Vec3& vertex : part) vertices.push_back(sorted_json_of(vertex));
    parts.push_back(std::move(vertices));
  }
  SortedJson json = {{"parts", std::move(parts)},
                     {"offset_m", number_text(target.offset_m)},
                     {"front", target.front ? sorted_json_of(*target.front) : SortedJson()}};
  if (target.front_by_order) json["front_by_order"] = true;
  if (target.volume) json["volume"] = volume_hash(target.volume->mesh);
  return json;
}

}  // namespace

std::string mission_hash(const Mission& mission) {
  SortedJson json = {{"sensor", sorted_json_of(mission.sensor)},
                     {"limits", sorted_json_of(mission.navigation)},
                     {"method", name_of(mission.as_written.method)}};
  if (mission.views.empty()) {
    json["target"] = sorted_json_of(mission.target);
  } else {
    json["views"] = SortedJson::array();
    for (const std::vector<Target>& view : mission.views) {
      SortedJson list = SortedJson::array();
      for (const Target& target : view) list.push_back(sorted_json_of(target));
      json["views"].push_back(std::move(list));
    }
    json["combine"] = volume_count(mission) > 1 ? "each" : "all";
  }
  const bool is_exact = mission.as_written.method == Method::exact;
  json["options"] = is_exact ? options_json(mission.as_written.exact) : options_json(mission.as_written.spheres);
  internal::core::Sha256 hash;
  hash.add("vantage mission 1\n");
  hash.add(json.dump());
  return hash.hex();
}

}  // namespace vantage
