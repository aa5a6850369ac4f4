// The spheres method: six depth images of one viewpoint on each device, and a whole volume of one target.
// Names: depth/<scene>/<texels>/<sampling>/<device> and spheres/<scene>/<target>/<range>/<texels>/<sphere>. A depth
// image is rendered and read back; the scene was uploaded before. A volume starts from the prepared scene: opening the
// device, uploading, rendering, tessellation, booleans.
#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "depth/depth.h"
#include "support/cities.h"
#include "support/internals.h"
#include "vantage/error.h"
#include "vantage/spheres.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kDepthRange = 600;

const std::map<std::string, DeviceChoice::Kind> kDevices = {
    {"cpu", DeviceChoice::Kind::cpu}, {"opengl", DeviceChoice::Kind::opengl}, {"gpu", DeviceChoice::Kind::gpu}};

/// Opened, and the scene uploaded, once a process. Throws Error(input) where the device is not there.
depth::DepthRenderer& renderer(const City& city, const std::string& device) {
  static std::map<std::pair<std::string, std::string>, std::unique_ptr<depth::DepthRenderer>> opened;
  auto& slot = opened[{city.name, device}];
  if (!slot) slot = depth::make_depth_renderer(prepared_city(city)->prepared, {kDevices.at(device), 0}).renderer;
  return *slot;
}

void depth(State& state, const City& city, int face_size, depth::Sampling sampling, const std::string& device) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  try {
    depth::DepthRenderer& images = renderer(city, device);
    const Vec3 viewpoint = ready->targets.front().target.parts[0].front() + Vec3(0, 0, 1e-3);
    double sum = 0;
    for (auto _ : state) {
      images.render({{&viewpoint, 1}, face_size, sampling, kDepthRange},
                    [&](std::size_t, std::span<const float> inverse_depths) { sum += inverse_depths.back(); });
    }
    benchmark::DoNotOptimize(sum);
    state.SetLabel(images.device().name);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    state.SkipWithError(error.problem().c_str());
  }
}

void spheres(State& state, const City& city, std::size_t target, double range, SpheresOptions options) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  Volume volume;
  SpheresReport report;
  for (auto _ : state) {
    volume = compute_visibility_spheres(PreparedTarget(ready->prepared, ready->targets.at(target).target, {range}),
                                        options, &report);
  }
  if (volume.outcome != Outcome::computed) return state.SkipWithError(volume.reason.c_str());
  state.counters["render_ms"] = report.render_seconds * 1e3;
  state.counters["boolean_ms"] = report.boolean_seconds * 1e3;
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
  state.counters["volume_m3"] = enclosed_volume(volume.mesh);
  state.SetLabel(report.device.name);
}

void add(const std::string& name, const std::function<void(State&)>& body) {
  auto* entry = benchmark::RegisterBenchmark(name.c_str(), body);
  entry->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
  entry->Repetitions(5)->ReportAggregatesOnly(true)->MinTime(0.05);
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunichRepeated})
    for (const int size : {40, 200, 512, 2048})
      for (const auto& [word, sampling] :
           {std::pair{"centers", depth::Sampling::centers}, std::pair{"nearest", depth::Sampling::nearest}})
        for (const auto& device : kDevices)
          add(std::string("depth/") + city->name + "/" + std::to_string(size) + "/" + word + "/" + device.first,
              [city, size, sampling = sampling, name = device.first](State& state) {
                depth(state, *city, size, sampling, name);
              });
  for (std::size_t target = 0; target < 3; ++target)
    for (const int range : {100, 300})
      for (const int size : {40, 200})
        for (const auto& [word, sphere] : {std::pair{"conservative", SpheresOptions::Sphere::conservative},
                                           std::pair{"centers", SpheresOptions::Sphere::centers}}) {
          SpheresOptions options;
          options.sphere = sphere;
          options.cubemap = size;
          options.max_splits = 0;
          add("spheres/charlotte/T" + std::to_string(target + 1) + "/" + std::to_string(range) + "m/" +
                  std::to_string(size) + "/" + word,
              [target, range, options](State& state) { spheres(state, kCharlotte, target, range, options); });
        }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
