// How fast the check of a plain half ball is. Its shadow rays alone are in bench/kernels/bench_shadow_rays.cpp.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "support/open_views.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "vantage/scene.h"
#include "vantage/verify.h"

namespace vantage::bench {
namespace {

/// All threads; the default check of the half ball, indexing included.
void whole_check(benchmark::State& state, const OpenView& view) {
  const auto file = testing::shared_data(view.file);
  if (!std::filesystem::exists(file)) return state.SkipWithError("the scene is absent: set VANTAGE_SHARED");
  const Scene scene = read_scene(file, {view.up, 1.0});
  const Mesh volume = testing::make_hemisphere(view.target, 0.9 * view.range, 48, 24).mesh;
  VerifyReport report;
  for (auto _ : state) {
    report = verify_volume(scene, square_at(view.target), {view.range}, {}, volume);
  }
  state.counters["rays"] = static_cast<double>(report.rays);
  state.counters["points"] = static_cast<double>(report.points);
  state.counters["over_claimed"] = static_cast<double>(report.over_claimed);
}
BENCHMARK_CAPTURE(whole_check, charlotte, kStreetCrossing)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(whole_check, openfoam, kAboveRoofs)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace vantage::bench
