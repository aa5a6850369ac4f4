// What limits of navigation cost: finding the ground of a scene, once, and the cut of each target's volume.
// Names: navigation/monaco/<what>, on the terrain under Monaco; the map itself is built before.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "support/shared_data.h"
#include "vantage/city.h"
#include "vantage/ground.h"
#include "vantage/navigation.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

struct Slope {
  City city;
  PreparedScene prepared;
  PreparedTarget target;
  Volume volume;  ///< before any limit but the range
};

/// A target that looks down on the middle of the map, from above all roofs. Null where the inputs are absent.
const Slope* slope() {
  static const std::optional<Slope> kSlope = []() -> std::optional<Slope> {
    const std::filesystem::path map = testing::shared_data("osm/monaco.osm.pbf"),
                                terrain = testing::shared_data("osm-terrain/N43E007.hgt.zip");
    if (!std::filesystem::exists(map) || !std::filesystem::exists(terrain)) return std::nullopt;
    CityOptions options;
    options.region = {{{43.7395, 7.4275}}, 550, {}};
    options.terrain = terrain;
    City city = build_city(map, options);
    PreparedScene prepared(city.scene);
    double top = 0;
    for (const Vec3& vertex : city.scene.mesh.vertices) top = std::max(top, vertex.z());
    const double z = top + 1;
    Target plate = Target::polygon({{-5, -5, z}, {5, -5, z}, {5, 5, z}, {-5, 5, z}});
    plate.front = -Vec3::UnitZ();
    PreparedTarget target(prepared, plate, Sensor{.max_range_m = 300});
    Volume volume = compute_volume(target);
    return Slope{std::move(city), std::move(prepared), std::move(target), std::move(volume)};
  }();
  return kSlope ? &*kSlope : nullptr;
}

void find_ground(State& state) {
  if (!slope()) return state.SkipWithError("the map or the terrain of Monaco is absent");
  std::size_t triangles = 0;
  for (auto _ : state) {
    const auto ground = ground_of(slope()->city.scene);
    triangles = ground->surface->triangles.size();
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}

void find_obstacles(State& state) {
  if (!slope()) return state.SkipWithError("the map or the terrain of Monaco is absent");
  std::size_t triangles = 0;
  for (auto _ : state) triangles = obstacles_of(slope()->city.scene)->triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
}

void engine_alone(State& state) {
  if (!slope()) return state.SkipWithError("the map or the terrain of Monaco is absent");
  Volume volume;
  for (auto _ : state) volume = compute_volume(slope()->target);
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
}

void cut(State& state, const std::function<void(Navigation&)>& limit) {
  if (!slope()) return state.SkipWithError("the map or the terrain of Monaco is absent");
  Navigation navigation;
  limit(navigation);
  Volume volume;
  for (auto _ : state) volume = cut_to_navigation(slope()->volume, navigation);
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
  state.counters["volume_m3"] = enclosed_volume(volume.mesh);
}

const bool registered = [] {
  const auto add = [](const char* name, const std::function<void(State&)>& run) {
    benchmark::RegisterBenchmark((std::string("navigation/monaco/") + name).c_str(), run)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  const auto add_cut = [&](const char* name, const std::function<void(Navigation&)>& limit) {
    add(name, [limit](State& state) { cut(state, limit); });
  };
  add("prepare_ground", find_ground);
  add("prepare_obstacles", find_obstacles);
  add("engine", engine_alone);
  add_cut("altitude", [](Navigation& navigation) { navigation.altitude = {80, 140}; });
  add_cut("agl", [](Navigation& navigation) { navigation.above_ground = {20, 120, *ground_of(slope()->city.scene)}; });
  add_cut("zone", [](Navigation& navigation) {
    Zone zone;
    zone.outer = {{-150, -150}, {150, -150}, {150, 150}, {0, 20}, {-150, 150}};
    navigation.keep_in = {zone};
  });
  add_cut("zone_agl", [](Navigation& navigation) {
    Zone zone;
    zone.outer = {{-150, -150}, {150, -150}, {150, 150}, {0, 20}, {-150, 150}};
    zone.above_ground = {20, 120, *ground_of(slope()->city.scene)};
    navigation.keep_in = {zone};
  });
  add_cut("clearance", [](Navigation& navigation) { navigation.clearance = {10, obstacles_of(slope()->city.scene)}; });
  return true;
}();

}  // namespace
}  // namespace vantage::bench
