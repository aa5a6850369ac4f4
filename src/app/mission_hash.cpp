// docs/hashes.md
#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/sha256.h"
#include "vantage/hash.h"
#include "vantage/input.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

using Json = nlohmann::json;  // its keys are sorted

/// Numbers are written as vantage writes them: the shortest decimal that reads back the same.
Json number(double value) { return shortest(value + 0.0); }

Json json_of(const Vec3& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

Json json_of(const std::vector<Box>& boxes) {
  Json list = Json::array();
  for (const Box& box : boxes) list.push_back({json_of(box.min), json_of(box.max)});
  return list;
}

// All members are named: a limit that is added does not compile here before it is hashed.
Json json_of(const Navigation& limits) {
  const auto& [altitude, keep_in, keep_out, meshes] = limits;
  Json json = {{"boxes", json_of(keep_in)}, {"keep_out", json_of(keep_out)}};
  json["altitude"] = altitude ? Json{number(altitude->min_m), number(altitude->max_m)} : Json();
  json["meshes"] = Json::array();
  for (const KeepInMesh& mesh : meshes) json["meshes"].push_back(volume_hash(mesh.mesh));
  return json;
}

Json json_of(const Target& target) {
  Json parts = Json::array();
  for (const std::vector<Vec3>& part : target.parts) {
    Json vertices = Json::array();
    for (const Vec3& vertex : part) vertices.push_back(json_of(vertex));
    parts.push_back(std::move(vertices));
  }
  return {{"parts", std::move(parts)},
          {"offset_m", number(target.offset_m)},
          {"front", target.front ? json_of(*target.front) : Json()}};
}

Json json_of(const SpheresOptions& options) {
  Json json = {{"sphere", options.sphere == SpheresOptions::Sphere::centers ? "centers" : "conservative"},
               {"cubemap", number(options.cubemap)},
               {"merge", number(options.merge)},
               {"split", options.split == SpheresOptions::Split::always ? "always" : "euler"},
               {"max_splits", number(options.max_splits)},
               {"min_edge_m", number(options.min_edge_m)}};
  json["resolution"] =
      options.resolution ? Json{number((*options.resolution)[0]), number((*options.resolution)[1])} : Json();
  return json;
}

}  // namespace

std::string mission_hash(const Mission& mission) {
  Json json = {{"target", json_of(mission.target)},
               {"sensor", {{"max_range_m", number(mission.sensor.max_range_m)}}},
               {"limits", json_of(mission.navigation)},
               {"method", name_of(mission.as_written.method)}};
  if (mission.as_written.method == Method::spheres) {
    json["options"] = json_of(mission.as_written.spheres);
  } else {
    json["options"] = {{"tolerance_m", number(mission.as_written.exact.tolerance_m)}};
  }
  internal::core::Sha256 hash;
  hash.add("vantage mission 1\n");
  hash.add(json.dump());
  return hash.hex();
}

}  // namespace vantage
