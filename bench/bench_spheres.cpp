// The spheres method: a whole volume of one target, from the prepared scene: opening the device, uploading, rendering,
// tessellation, booleans. Names: spheres/<scene>/<target>/<range>/<texels>/<sphere>. Its depth images alone are in
// bench/kernels/bench_depth_images.cpp.
#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <utility>

#include "support/cities.h"
#include "vantage/spheres.h"

namespace vantage::bench {
namespace {

using benchmark::State;

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
  for (std::size_t target = 0; target < 3; ++target) {
    for (const int range : {100, 300}) {
      for (const int size : {40, 200}) {
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
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
