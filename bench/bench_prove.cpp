// The proof of volumes, beside the time of the engine: prove/<scene>/<target>/<range>, with maximality prove_maximal/.
// The scene's preparation counts for neither.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "support/cities.h"
#include "vantage/prove.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;
using Clock = std::chrono::steady_clock;

constexpr double kRange = 300;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

void prove(State& state, const City& city, std::size_t number, bool maximal) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.size() <= number) return state.SkipWithError("no such street target was found");
  if (ready->scene.mesh.empty()) return state.SkipWithError("the scene is not kept");
  const Target& asked = ready->targets[number].target;
  const Sensor sensor{.max_range_m = kRange};
  const PreparedTarget target(ready->prepared, asked, sensor);
  double engine_s = 0, proof_s = 0;
  ProofReport report;
  for (auto _ : state) {
    auto begin = Clock::now();
    const Volume volume = compute_visibility(target);
    engine_s += seconds_since(begin);
    begin = Clock::now();
    report = prove_volume(ready->scene, asked, sensor, {}, volume.mesh, {.lift_m = volume.lift_m, .maximal = maximal});
    const double seconds = seconds_since(begin);
    proof_s += seconds;
    state.SetIterationTime(seconds);
  }
  state.counters["times_engine"] = proof_s / engine_s;
  state.counters["facets"] = static_cast<double>(report.facets);
  state.counters["unproved"] = static_cast<double>(report.unproved.size());
  if (!report.maximal) return;
  state.counters["maximal_percent"] = 100 * report.maximal->proved_share;
  state.counters["open"] = static_cast<double>(report.maximal->open.size());
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence, &kOpenfoam}) {
    for (std::size_t number = 0; number < static_cast<std::size_t>(std::min(city->targets, 5)); ++number) {
      for (const bool maximal : {false, true}) {
        const std::string name = std::string(maximal ? "prove_maximal/" : "prove/") + city->name + "/T" +
                                 std::to_string(number + 1) + "/300m";
        benchmark::RegisterBenchmark(name.c_str(),
                                     [city, number, maximal](State& state) { prove(state, *city, number, maximal); })
            ->Unit(benchmark::kMillisecond)
            ->UseManualTime();
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
