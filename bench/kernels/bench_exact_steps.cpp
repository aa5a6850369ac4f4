// The steps of the exact method while a corner of the target moves, on one thread: what of a volume's time could be
// saved by keeping something of the last one. Names: steps/<scene>. Counters are milliseconds of a processor.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <string>

#include "core/parallel.h"
#include "exact/collect.h"
#include "exact/envelope.h"
#include "exact/triangulation.h"
#include "support/dragged.h"
#include "support/internals.h"
#include "target/lengths.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

/// Adds up the time between calls, by name.
class Laps {
 public:
  void begin() { last_ = std::clock(); }
  void end(const char* name) {
    const std::clock_t now = std::clock();
    ms_[name] += 1e3 * static_cast<double>(now - last_) / CLOCKS_PER_SEC;
    last_ = std::clock();
  }
  void count(State& state) const {
    for (const auto& [name, ms] : ms_) state.counters[name] = {ms, benchmark::Counter::kAvgIterations};
  }

 private:
  std::clock_t last_ = 0;
  std::map<std::string, double> ms_;
};

/// As compute_half_space.
void run_steps(const PreparedScene& scene, const TargetFrame& frame, const ExactOptions& options, Laps& laps) {
  const core::ProgressReporter progress{Progress()};
  laps.begin();
  const target::RangeRegion range(frame.polygon, kDragRange);
  const target::Lengths lengths = target::lengths_of(scene.data(), frame, range.radius());
  const target::LocalTarget local = target::make_local_target(frame.polygon, lengths.slack, lengths.rounding);
  exact::OctahedralGrid grid(range, options.tolerance_m);
  laps.end("grid_ms");
  exact::BlockerSet blockers;
  exact::DirectionTree tree(blockers, range);
  exact::collect_blockers(scene.data(), frame, local, range, blockers, tree, progress);
  laps.end("blockers_ms");
  const double widest = 0.1 * range.inner_radius() * std::numbers::pi / 2 / grid.size();
  const exact::CurveSampling sampling{std::min(options.tolerance_m * 0.5, widest),
                                      std::sqrt(8 * range.radius() * options.tolerance_m)};
  const exact::Skeleton skeleton = exact::trace_envelope(blockers, tree, range, sampling, grid, progress);
  laps.end("envelope_ms");
  benchmark::DoNotOptimize(*exact::triangulate_boundary(
      {skeleton, nullptr}, {blockers, tree, range, nullptr, options.tolerance_m, progress}, grid));
  laps.end("triangulation_ms");
}

void steps(State& state, const City& city) {
  if (!is_there(city)) return state.SkipWithError(absence(city).c_str());
  const PreparedScene scene(read_city(city));
  const ExactOptions options;
  Laps laps;
  internal::parallel::with_threads(1, [&] {
    int step = 0;
    for (auto _ : state) {
      Target target = dragged_target(city);
      drag_corner(step++, target);
      laps.begin();
      const PreparedTarget prepared(scene, target, {kDragRange});
      laps.end("target_ms");
      benchmark::DoNotOptimize(compute_visibility(prepared, options));
      laps.end("all_ms");
      run_steps(scene, prepared.frame(), options, laps);
    }
  });
  laps.count(state);
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich}) {
    benchmark::RegisterBenchmark((std::string("steps/") + city->name).c_str(),
                                 [city](State& state) { steps(state, *city); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MinTime(1)
        ->Repetitions(5)
        ->ReportAggregatesOnly(true);
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
