// What the zone of a radio link costs, once the scene is prepared: compute_visibility of a point over the roofs, with a
// link and without. Name: link/<scene>/<range>/<limit>. Of the time with a link, `grow_ms` is for growing what is seen,
// `prepare_ms` for preparing that, and `engine_ms` for the rest. `query_us`: a point asked of PointQuery.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "support/cities.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;
using Clock = std::chrono::steady_clock;

/// Seconds by the names of the stages.
class StageClock {
 public:
  bool tell(std::string_view stage) {
    const Clock::time_point now = Clock::now();
    seconds_[stage_] += std::chrono::duration<double>(now - since_).count();
    stage_ = stage;
    since_ = now;
    return true;
  }
  double of(const std::string& stage) { return seconds_[stage]; }
  double all() const {
    double sum = 0;
    for (const auto& [stage, seconds] : seconds_) sum += seconds;
    return sum;
  }

 private:
  std::map<std::string, double> seconds_;
  std::string stage_ = "start";
  Clock::time_point since_ = Clock::now();
};

/// 3 m over the highest roof within 30 m of the first street target.
Target antenna_over(const PreparedCity& city) {
  const Vec3 street = city.targets.front().target.parts[0][0];
  double top = street.z();
  for (const Vec3& v : city.scene.mesh.vertices) {
    if ((v - street).head<2>().norm() < 30) top = std::max(top, v.z());
  }
  return Target::point({street.x(), street.y(), top + 3});
}

double query_us(const PreparedTarget& target) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<> shift(-1, 1);
  std::vector<Vec3> points;
  const double range = target.sensor().max_range_m;
  for (int i = 0; i < 4000; ++i) {
    points.push_back(target.frame().origin + range * Vec3(shift(random), shift(random), 0.3 * shift(random)));
  }
  PointQuery query(target);
  const Clock::time_point start = Clock::now();
  benchmark::DoNotOptimize(query.answer(points));
  return 1e6 * std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(points.size());
}

void link_zone(State& state, const City& city, double range, const std::optional<RadioLink>& link) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.empty()) return state.SkipWithError("no street target was found");
  Sensor sensor{.max_range_m = range};
  sensor.link = link;
  const PreparedTarget target(ready->prepared, antenna_over(*ready), sensor);
  Volume volume;
  double grow = 0, prepare = 0, rest = 0;
  for (auto _ : state) {
    StageClock clock;
    volume = compute_visibility(target, {}, [&](std::string_view stage, double) { return clock.tell(stage); });
    clock.tell("end");
    grow += clock.of("growing the scene");
    prepare += clock.of("preparing the grown scene");
    rest += clock.all() - clock.of("growing the scene") - clock.of("preparing the grown scene");
  }
  const auto mean_ms = [](double seconds) {
    return benchmark::Counter(1000 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["grow_ms"] = mean_ms(grow);
  state.counters["prepare_ms"] = mean_ms(prepare);
  state.counters["engine_ms"] = mean_ms(rest);
  state.counters["blockers"] = static_cast<double>(volume.counts.visible_blockers);
  state.counters["facets"] = static_cast<double>(volume.mesh.triangles.size());
  state.counters["volume_m3"] = enclosed_volume(volume.mesh);
  state.counters["query_us"] = query_us(target);
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence}) {
    for (const double range : {300.0, 1000.0}) {
      const auto add = [&](const std::string& name, const std::optional<RadioLink>& link) {
        const std::string full =
            std::string("link/") + city->name + "/" + std::to_string(static_cast<int>(range)) + "m/" + name;
        benchmark::RegisterBenchmark(full.c_str(), [=](State& state) { link_zone(state, *city, range, link); })
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
      };
      add("none", std::nullopt);
      add("5.8GHz", RadioLink{5.8, 0.6});
      add("2.4GHz", RadioLink{2.4, 0.6});
      add("0.9GHz", RadioLink{0.9, 0.6});
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
