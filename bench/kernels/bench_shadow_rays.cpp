// How many shadow rays a second the check casts over real scenes.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "support/internals.h"
#include "support/open_views.h"
#include "support/shared_data.h"
#include "vantage/scene.h"
#include "verify/occluders.h"
#include "verify/random.h"
#include "verify/target_view.h"

namespace vantage::bench {
namespace {

/// One thread; rays from the half ball to the target. `hidden`: the share of rays that are blocked, which end sooner.
void shadow_rays(benchmark::State& state, const OpenView& open) {
  const auto file = testing::shared_data(open.file);
  if (!std::filesystem::exists(file)) return state.SkipWithError("the scene is absent: set VANTAGE_SHARED");
  const Scene scene = read_scene(file, {open.up, 1.0});
  const verify::TargetView view(square_at(open.target));
  const verify::Occluders occluders(scene, view, open.range);
  verify::Random random(1, 0);
  std::vector<std::pair<Vec3, Vec3>> rays;
  while (rays.size() < 100000) {
    const Vec3 cube(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform());
    if (cube.norm() > 0.9) continue;
    rays.emplace_back(view.centre() + open.range * cube, view.interior(random.uniform(), random.uniform()));
  }
  std::size_t hidden = 0, next = 0;
  for (auto _ : state) {
    hidden += occluders.hide(rays[next].first, rays[next].second);
    next = (next + 1) % rays.size();
  }
  state.counters["rays/s"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["hidden"] = static_cast<double>(hidden) / static_cast<double>(state.iterations());
  state.counters["triangles"] = static_cast<double>(scene.mesh.triangles.size());
}
BENCHMARK_CAPTURE(shadow_rays, charlotte, kStreetCrossing);
BENCHMARK_CAPTURE(shadow_rays, openfoam, kAboveRoofs);

}  // namespace
}  // namespace vantage::bench
