// How long it takes to find out how much 10,000 points see of a target, once the scene is prepared; the index is made
// within the time. The points are uniform in the range of the gallery's target in Munich (docs/gallery/munich.yaml).
// Names: fraction/munich_gallery/<measure>/<threads>. Counters: how many see none, a part and all of it, and the median
// and the worst of the points, asked one by one on one thread when the index is there.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/places.h"
#include "support/shared_data.h"
#include "vantage/fraction.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/query.h"
#include "vantage/result.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr std::size_t kFractionPoints = 10000;
constexpr unsigned kFractionSeed = 20261122;

/// The gallery's target, prepared once; nothing where its scene is absent.
const PreparedTarget* gallery_target() {
  static const std::unique_ptr<const PreparedTarget> target = []() -> std::unique_ptr<const PreparedTarget> {
    if (!std::filesystem::exists(testing::shared_data("mesh/munich_merged.ply"))) return nullptr;
    const Mission mission = resolve_mission(read_mission(testing::source_folder() / "docs/gallery/munich.yaml"));
    return std::make_unique<PreparedTarget>(prepare_target(mission, PreparedScene(mission.scene())));
  }();
  return target.get();
}

/// In front of the target, and within its range of all corners.
std::vector<Vec3> points_in_range(const PreparedTarget& target) {
  const TargetFrame& frame = target.frame();
  const double range = target.sensor().max_range_m;
  std::mt19937_64 random(kFractionSeed);
  std::uniform_real_distribution<double> side(-range, range), up(0, range);
  std::vector<Vec3> points;
  while (points.size() < kFractionPoints) {
    const double x = side(random), y = side(random);
    const Vec3 local(x, y, up(random));
    const bool is_in_range = std::all_of(frame.polygon.begin(), frame.polygon.end(), [&](const auto& corner) {
      return (local - Vec3(corner.x(), corner.y(), 0)).norm() <= range;
    });
    if (is_in_range) points.push_back(frame.to_scene(local));
  }
  return points;
}

void fraction(State& state, FractionMeasure measure, bool with_polygons, int threads) {
  const PreparedTarget* const target = gallery_target();
  if (!target) return state.SkipWithError("the shared data is absent: set VANTAGE_SHARED");
  const std::vector<Vec3> points = points_in_range(*target);
  const FractionOptions options{measure, with_polygons};
  std::optional<PointQuery> asked;
  std::vector<PointFraction> answers;
  for (auto _ : state) {
    with_threads(threads, [&] {
      asked.emplace(*target);
      answers = asked->fractions(points, options);
    });
  }
  std::vector<double> seconds;
  with_threads(1, [&] {
    for (const Vec3& point : points) {
      const auto start = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(asked->fractions({&point, 1}, options));
      seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  });
  std::sort(seconds.begin(), seconds.end());
  const auto count = [&](const auto& is_one) {
    return static_cast<double>(std::count_if(answers.begin(), answers.end(), is_one));
  };
  state.counters["none"] = count([](const PointFraction& answer) { return answer.fraction == 0; });
  state.counters["part"] =
      count([](const PointFraction& answer) { return answer.fraction > 0 && answer.fraction < 1; });
  state.counters["all"] = count([](const PointFraction& answer) { return answer.fraction == 1; });
  state.counters["median_us"] = 1e6 * seconds[seconds.size() / 2];
  state.counters["worst_us"] = 1e6 * seconds.back();
}

const bool fraction_registered = [] {
  for (const auto measure : {FractionMeasure::area, FractionMeasure::solid_angle, FractionMeasure::pixels}) {
    for (const bool with_polygons : {false, true}) {
      for (const int threads : {1, 2}) {
        if (with_polygons && (measure != FractionMeasure::area || threads == 1)) continue;
        const std::string name = std::string("fraction/munich_gallery/") + name_of(measure) +
                                 (with_polygons ? "_polygons/" : "/") + std::to_string(threads);
        benchmark::RegisterBenchmark(name.c_str(),
                                     [=](State& state) { fraction(state, measure, with_polygons, threads); })
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime();
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
