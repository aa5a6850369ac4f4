// What limits of the sensor add to a volume, once the scene is prepared: compute_volume with each, and with all.
// Names: sensor/<scene>/<target>/<range>/<limit>; "none" is the engine alone.
#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "support/cities.h"
#include "vantage/camera.h"
#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kRange = 300;

using Limit = std::pair<std::string, std::function<void(Sensor&)>>;

const std::vector<Limit>& limits() {
  static const Pinhole camera = pinhole_of(find_camera("sony_a7r_iv_35mm"));
  static const std::vector<Limit> kLimits = {
      {"none", [](Sensor&) {}},
      {"min_range", [](Sensor& sensor) { sensor.min_range_m = 20; }},
      {"incidence", [](Sensor& sensor) { sensor.incidence_deg = 60; }},
      {"pixel", [](Sensor& sensor) { sensor.pixel = PixelLimit{0.02}; }},
      {"sun",
       [](Sensor& sensor) {
         sensor.sun = SunLimit{Vec3(1, 0.5, 0.3), 20};
       }},
      {"fixed",
       [](Sensor& sensor) {
         sensor.camera = camera;
         sensor.mount = {.yaw_deg = 30, .min_pitch_deg = -60, .max_pitch_deg = -60};
       }},
      {"gimbal", [](Sensor& sensor) { sensor.camera = camera; }},
      {"limited_gimbal",
       [](Sensor& sensor) {
         sensor.camera = camera;
         sensor.mount = {.min_pitch_deg = -90, .max_pitch_deg = 30};
       }},
  };
  return kLimits;
}

void sensor_limits(State& state, const City& city, const std::function<void(Sensor&)>& limit) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.empty()) return state.SkipWithError("no street target was found");
  Sensor sensor{.max_range_m = kRange};
  limit(sensor);
  // A pixel needs a camera's resolution; the picture itself is limited where that is asked for.
  if (sensor.pixel && !sensor.camera) sensor.camera = pinhole_of_fov(170, 170, 60000, 60000);
  const PreparedTarget target(ready->prepared, ready->targets.front().target, sensor);
  Volume volume;
  for (auto _ : state) volume = compute_volume(target);
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
  state.counters["volume_m3"] = enclosed_volume(volume.mesh);
  state.counters["cut_ms"] = 1000 * volume.seconds.navigation;
}

void all_limits(Sensor& sensor) {
  for (const auto& [name, limit] : limits()) {
    if (name != "fixed" && name != "gimbal") limit(sensor);
  }
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence}) {
    const std::string start = std::string("sensor/") + city->name + "/T1/300m/";
    const auto add = [&](const std::string& name, const std::function<void(Sensor&)>& limit) {
      benchmark::RegisterBenchmark((start + name).c_str(),
                                   [city, limit](State& state) { sensor_limits(state, *city, limit); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    for (const auto& [name, limit] : limits()) add(name, limit);
    add("all", all_limits);
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
