// Volumes of positions that see 80 % of a target in a real city, by the number of cells.
// Names: share/<scene>/<target>/<range>/<cells>; "whole" is all of the target.
#include <benchmark/benchmark.h>

#include <string>

#include "support/cities.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kRange = 200, kShare = 0.8;

/// `cells`: 0 for the whole target.
void visible_share(State& state, const City& city, std::size_t cells) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.empty()) return state.SkipWithError("no street target was found");
  Sensor sensor{.max_range_m = kRange};
  if (cells > 0) sensor.visible = VisibleShare{kShare, cells};
  const PreparedTarget target(ready->prepared, ready->targets.front().target, sensor);
  Volume volume;
  for (auto _ : state) volume = compute_volume(target);
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
  state.counters["volume_m3"] = measure(volume.mesh).volume_m3;
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence}) {
    for (const std::size_t cells : {0, 4, 8, 16}) {
      const std::string name =
          std::string("share/") + city->name + "/T1/200m/" + (cells > 0 ? std::to_string(cells) : "whole");
      benchmark::RegisterBenchmark(name.c_str(), [city, cells](State& state) { visible_share(state, *city, cells); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
