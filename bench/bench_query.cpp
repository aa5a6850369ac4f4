// How many points a second are answered about, once the scene is prepared; the index is made within the time.
// Names: query/<scene>/<target>/<range>/<threads>. `vantage query` adds the reading and the writing of the table.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "support/cities.h"
#include "vantage/progress.h"
#include "vantage/query.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr std::size_t kPoints = 100000;

/// Uniform over a box twice the range wide and one high about the target: half are out of range, most of the rest are
/// blocked.
std::vector<Vec3> points_about(const Vec3& centre, double range) {
  std::vector<Vec3> points;
  double u = 0.5, v = 0.5, w = 0.5;  // Roberts' R3 sequence
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto next = [](double& x, double step) { x = x + step < 1 ? x + step : x + step - 1; };
    next(u, 0.8191725133961645);
    next(v, 0.6710436067037893);
    next(w, 0.5497004779019703);
    points.emplace_back(centre + range * Vec3(2 * u - 1, 2 * v - 1, w));
  }
  return points;
}

void query(State& state, const City& city, double range, int threads) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.empty()) return state.SkipWithError("no street target was found");
  const StreetTarget& street = ready->targets.front();
  const std::vector<Vec3> points = points_about(street.centre, range);
  std::size_t inside = 0;
  for (auto _ : state) {
    with_threads(threads, [&] {
      PointQuery asked(PreparedTarget(ready->prepared, street.target, {range}));
      inside = 0;
      for (const PointAnswer& answer : asked.answer(points)) inside += answer.inside;
    });
  }
  state.counters["inside"] = static_cast<double>(inside);
  state.counters["points_per_second"] = benchmark::Counter(
      static_cast<double>(kPoints) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence, &kMunichRepeated, &kOpenfoam}) {
    for (const int threads : {1, 0}) {
      const std::string name = std::string("query/") + city->name + "/T1/300m/" + (threads == 1 ? "one" : "all");
      benchmark::RegisterBenchmark(name.c_str(), [city, threads](State& state) { query(state, *city, 300, threads); })
          ->Unit(benchmark::kMillisecond)
          ->MeasureProcessCPUTime()
          ->UseRealTime();
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
