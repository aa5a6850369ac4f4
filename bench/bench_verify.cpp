// How fast the check is: shadow rays a second over real scenes, and whole checks of a plain hemisphere.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/shared_data.h"
#include "support/solids.h"
#include "vantage/scene.h"
#include "vantage/verify.h"
#include "verify/occluders.h"
#include "verify/random.h"
#include "verify/target_view.h"

namespace {

using vantage::Scene;
using vantage::Target;
using vantage::UpAxis;
using vantage::Vec3;

struct City {
  const char* file;
  UpAxis up;
  Vec3 target;  ///< centre of a 20 m square that looks up
  double range;
};

// Charlotte: an open street crossing. openfoam-buildings: the sky over the tallest roof, from which all of it is seen.
const City kCharlotte{"charlotte/uptownCharlotte.obj", UpAxis::y, {-350, -60, 1}, 300};
const City kOpenfoam{"mesh/openfoam-buildings.obj.gz", UpAxis::z, {120, 90, 1}, 200};

Target square(const Vec3& centre) {
  Target target;
  for (const auto& [x, y] : {std::pair{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}) {
    target.parts[0].push_back(centre + Vec3(x, y, 0));
  }
  return target;
}

/// One thread; rays from the half ball to the target. `hidden`: the share of rays that are blocked, which end sooner.
void shadow_rays(benchmark::State& state, const City& city) {
  const auto file = vantage::testing::shared_data(city.file);
  if (!std::filesystem::exists(file)) return state.SkipWithError("the scene is absent: set VANTAGE_SHARED");
  const Scene scene = vantage::read_scene(file, {city.up, 1.0});
  const vantage::internal::verify::TargetView view(square(city.target));
  const vantage::internal::verify::Occluders occluders(scene, view, city.range);
  vantage::internal::verify::Random random(1, 0);
  std::vector<std::pair<Vec3, Vec3>> rays;
  while (rays.size() < 100000) {
    const Vec3 cube(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform());
    if (cube.norm() > 0.9) continue;
    rays.emplace_back(view.centre() + city.range * cube, view.interior(random.uniform(), random.uniform()));
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
BENCHMARK_CAPTURE(shadow_rays, charlotte, kCharlotte);
BENCHMARK_CAPTURE(shadow_rays, openfoam, kOpenfoam);

/// All threads; the default check of the half ball, indexing included.
void whole_check(benchmark::State& state, const City& city) {
  const auto file = vantage::testing::shared_data(city.file);
  if (!std::filesystem::exists(file)) return state.SkipWithError("the scene is absent: set VANTAGE_SHARED");
  const Scene scene = vantage::read_scene(file, {city.up, 1.0});
  const vantage::Mesh volume = vantage::testing::make_hemisphere(city.target, 0.9 * city.range, 48, 24).mesh;
  vantage::VerifyReport report;
  for (auto _ : state) {
    report = vantage::verify_volume(scene, square(city.target), {city.range}, {}, volume);
  }
  state.counters["rays"] = static_cast<double>(report.rays);
  state.counters["points"] = static_cast<double>(report.points);
  state.counters["over_claimed"] = static_cast<double>(report.over_claimed);
}
BENCHMARK_CAPTURE(whole_check, charlotte, kCharlotte)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(whole_check, openfoam, kOpenfoam)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
