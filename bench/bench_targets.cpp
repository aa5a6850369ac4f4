// Many targets in one scene, on two threads: a hundred at once, and each of them alone. Preparing the scene is not
// counted. Name: targets/<scene>/<range>/<how many>. `times_one`: how many times as long all of them take as one alone
// on one thread, in the mean; `one_on_both_ms`: one alone on two threads.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "support/cities.h"
#include "vantage/mission.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kRange = 100;
constexpr int kThreads = 2;
constexpr std::size_t kMany = 100;

City many_targets() {
  City city = kMunich;
  city.name = "munich, 100 targets";
  city.targets = kMany;
  return city;
}

Mission mission_of(const PreparedCity& city) {
  Mission mission;
  mission.loaded = std::make_shared<const LoadedScene>(LoadedScene{city.scene});
  mission.sensor.max_range_m = kRange;
  mission.as_written.combine = Combine::each;
  for (std::size_t i = 0; i < kMany; ++i) {
    mission.views.push_back({city.targets[i].target});
    mission.views.back().front().name = "target " + std::to_string(i + 1);
  }
  mission.target = mission.views.front().front();
  return mission;
}

double seconds_of(const Mission& mission, int threads) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Result> results = run_missions(mission, {threads, {}});
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
  return all.count() - results.front().volume.seconds.prepare;
}

void many_at_once(State& state) {
  static const City city = many_targets();
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.size() < kMany) return state.SkipWithError("too few street targets were found");
  const Mission mission = mission_of(*ready);
  double many = 0, one = 0, one_on_both = 0;
  for (auto _ : state) {
    const double seconds = seconds_of(mission, kThreads);
    state.SetIterationTime(seconds);
    many += seconds;
    for (std::size_t i = 0; i < kMany; ++i) {
      const Mission alone = one_volume(mission, i);
      one += seconds_of(alone, 1) / kMany;
      one_on_both += seconds_of(alone, kThreads) / kMany;
    }
  }
  state.counters["one_ms"] = benchmark::Counter(1000 * one, benchmark::Counter::kAvgIterations);
  state.counters["one_on_both_ms"] = benchmark::Counter(1000 * one_on_both, benchmark::Counter::kAvgIterations);
  state.counters["times_one"] = many / one;
}

const bool registered = [] {
  benchmark::RegisterBenchmark("targets/munich/100m/100", many_at_once)->Unit(benchmark::kMillisecond)->UseManualTime();
  return true;
}();

}  // namespace
}  // namespace vantage::bench
