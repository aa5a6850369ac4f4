#include "support/cities.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/shared_data.h"

namespace vantage::bench {
namespace {

using testing::shared_data;

constexpr std::uint64_t kSeed = 1;
constexpr int kStreetTargets = 5, kTiles = 5;

/// Copies side by side, the one in the middle where the scene was.
Scene repeat(const Scene& scene, int tiles) {
  Scene repeated;
  repeated.objects = scene.objects;
  const Box bounds = bounding_box(scene.mesh);
  const Vec3 size = bounds.max - bounds.min;
  const int middle = tiles / 2;
  for (int i = 0; i < tiles; ++i) {
    for (int j = 0; j < tiles; ++j) {
      const Vec3 shift((i - middle) * size.x(), (j - middle) * size.y(), 0);
      const auto first = static_cast<std::uint32_t>(repeated.mesh.vertices.size());
      for (const Vec3& v : scene.mesh.vertices) repeated.mesh.vertices.push_back(v + shift);
      for (const Triangle& t : scene.mesh.triangles)
        repeated.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      repeated.object_of.insert(repeated.object_of.end(), scene.object_of.begin(), scene.object_of.end());
    }
  }
  return repeated;
}

/// Of charlotte/baseline.json, which keeps the axes of the OBJ (y up).
std::vector<StreetTarget> baseline_targets() {
  std::ifstream stream(shared_data("charlotte/baseline.json"));
  const auto baseline = nlohmann::json::parse(stream);
  std::vector<StreetTarget> targets;
  for (const auto& entry : baseline.at("targets")) {
    StreetTarget found{{}, Vec3::Zero(), 0};
    for (const auto& v : entry.at("vertices")) found.target.parts[0].emplace_back(v[0], -v[2].get<double>(), v[1]);
    for (const Vec3& v : found.target.parts[0]) found.centre += v / static_cast<double>(found.target.parts[0].size());
    targets.push_back(found);
  }
  return targets;
}

/// Its streets hold no 20 m target: one just over a roof 30 m up, among towers of up to 76 m.
std::vector<StreetTarget> roof_target() {
  const Vec3 centre(120, 90, 30.01);
  StreetTarget found{{}, centre, 0};
  found.target.parts[0] = {centre + Vec3(11.547, 0, 0), centre + Vec3(-5.7735, 10, 0), centre + Vec3(-5.7735, -10, 0)};
  return {found};
}

}  // namespace

const City kCharlotte{"charlotte", "charlotte/uptownCharlotte.obj", UpAxis::y, {}, 3};
const City kMunich{"munich", "mesh/munich_merged.ply", UpAxis::z, {kSeed}, kStreetTargets};
const City kMunichRepeated{"munich_5x5", "mesh/munich_merged.ply", UpAxis::z, {kSeed}, kStreetTargets, kTiles};
const City kFlorence{"florence", "mesh/florence_merged.ply", UpAxis::z, {kSeed}, kStreetTargets};
const City kOpenfoam{"openfoam", "mesh/openfoam-buildings.obj.gz", UpAxis::z, {}, 1};

bool is_there(const City& city) { return std::filesystem::exists(shared_data(city.file)); }

Scene read_city(const City& city) {
  Scene single = read_scene(shared_data(city.file), {city.up, 1.0});
  return city.tiles > 1 ? repeat(single, city.tiles) : single;
}

const PreparedCity* prepared_city(const City& city) {
  static std::map<std::string, PreparedCity> cities;
  if (!is_there(city)) return nullptr;
  if (const auto known = cities.find(city.name); known != cities.end()) return &known->second;
  const auto keep = [&](PreparedCity made) { return &cities.emplace(city.name, std::move(made)).first->second; };
  if (city.tiles > 1) {
    const PreparedCity* single = prepared_city(kMunich);
    return keep({{}, PreparedScene(repeat(single->scene, city.tiles)), single->targets});
  }
  Scene scene = read_city(city);
  PreparedScene ready(scene);
  auto targets = &city == &kCharlotte ? baseline_targets()
                 : &city == &kOpenfoam
                     ? roof_target()
                     : find_street_targets(scene, ready, city.search, static_cast<std::size_t>(city.targets));
  return keep({std::move(scene), std::move(ready), std::move(targets)});
}

std::string absence(const City& city) {
  return std::string(city.file) + " is absent: set VANTAGE_SHARED to the folder that holds data/";
}

}  // namespace vantage::bench
