// How long one target takes once the scene is prepared, against a plain union of blockers; and preparing a large city.
// Names: engine/<scene>/<target>/<range>/<threads>. Times are of compute_visibility alone; a summary with the ratios is
// made by bench/run.sh. sheets/<shape>/<count> is not a city: open triangles over the target that share an axis or a
// point.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "support/cities.h"
#include "support/memory.h"
#include "support/plain_union.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr int kRepetitions = 5;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPlainTime(120);  ///< the plain union is given up after this

std::string describe(const StreetTarget& target) {
  char text[96];
  const Vec3& c = target.centre;
  const int length = std::snprintf(text, sizeof text, "centre (%.1f %.1f %.1f)", c.x(), c.y(), c.z());
  if (target.enclosed > 0) {  // not known of the baseline's
    std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length), ", enclosed %.0f %%",
                  100 * target.enclosed);
  }
  return text;
}

void engine(State& state, const City& city, std::size_t index, double range, int threads) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (index >= ready->targets.size()) return state.SkipWithError("so many street targets were not found");
  const StreetTarget& street = ready->targets[index];
  std::optional<Volume> volume;
  for (auto _ : state) {
    volume = compute_visibility(PreparedTarget(ready->prepared, street.target, {range}),
                                {ExactOptions().tolerance_m, threads});
  }
  if (volume->outcome != Outcome::computed) return state.SkipWithError(volume->reason.c_str());
  state.counters["facets"] = static_cast<double>(volume->mesh.triangles.size());
  state.counters["visible_blockers"] = static_cast<double>(volume->counts.visible_blockers);
  state.counters["volume_m3"] = enclosed_volume(volume->mesh);
  state.SetLabel(describe(street));
}

void plain(State& state, const City& city, std::size_t index, double range, int threads) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  const StreetTarget& street = ready->targets.at(index);
  const TargetFrame frame = make_target_frame(street.target);
  Volume open = compute_visibility(PreparedTarget(PreparedScene{Scene{}}, street.target, {range}));
  for (Vec3& v : open.mesh.vertices) v = frame.to_local(v);
  PlainVolume result;
  for (auto _ : state) {
    const auto begin = Clock::now();
    const auto is_in_time = [&] { return Clock::now() - begin < kPlainTime; };
    result = plain_visibility(ready->scene, frame, open.mesh, range, threads, is_in_time);
    if (!result.is_finished) return state.SkipWithError("given up: it took too long");
  }
  state.counters["facets"] = static_cast<double>(result.facets);
  state.counters["volume_m3"] = result.volume_m3;
  state.SetLabel(describe(street));
}

void prepare(State& state, const City& city) {
  if (!is_there(city)) return state.SkipWithError(absence(city).c_str());
  const Scene scene = read_city(city);
  reset_peak_memory();
  for (auto _ : state) {
    const PreparedScene ready(scene);
    benchmark::DoNotOptimize(ready.statistics().polygons);
  }
  state.counters["triangles"] = static_cast<double>(scene.mesh.triangles.size());
  state.counters["peak_MB"] = peak_memory() / 1e6;  // the scene as read included
}

/// Each has the corner `foot`; those of a fan share the axis up to `tip` too.
Scene sheets(int count, bool fan) {
  const Vec3 foot(0.1, 0.2, 4), tip(5, 1, 8);
  Scene scene;
  scene.objects = {{"sheets"}};
  for (int k = 0; k < count; ++k) {
    // The golden ratio spreads numbers evenly, in no order.
    const double angle = 2 * std::numbers::pi * k / count, rise = std::fmod(0.6180339887 * k, 1), reach = 1 + 3 * rise;
    const Vec3 out(reach * std::cos(angle), reach * std::sin(angle), 5 * std::fmod(0.7548776662 * k, 1));
    const Vec3 beside(-std::sin(angle), std::cos(angle), 0.3);
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    scene.mesh.vertices.insert(scene.mesh.vertices.end(),
                               {foot, fan ? tip : Vec3(foot + 4 * out + 0.1 * beside), foot + (fan ? 1 : 4) * out});
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  return scene;
}

void many_sheets(State& state, int count, bool fan) {
  const PreparedScene scene(sheets(count, fan));
  Target target;
  target.parts[0] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  reset_peak_memory();
  std::optional<Volume> volume;
  for (auto _ : state) volume = compute_visibility(PreparedTarget(scene, target, {40}), {0.02, 1});
  if (volume->outcome != Outcome::computed) return state.SkipWithError(volume->reason.c_str());
  state.counters["visible_blockers"] = static_cast<double>(volume->counts.visible_blockers);
  state.counters["peak_MB"] = peak_memory() / 1e6;
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

/// CPU time is of all threads of the process: it does not grow when others use the machine.
void add(const std::string& name, const std::function<void(State&)>& body, int iterations = 0) {
  auto* entry = benchmark::RegisterBenchmark(name.c_str(), body);
  entry->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
  entry->Repetitions(kRepetitions)->ReportAggregatesOnly(true)->ComputeStatistics("min", least);
  if (iterations) {
    entry->Iterations(iterations)->Repetitions(3);
  } else {
    entry->MinTime(0.1);
  }
}

std::string case_name(const char* method, const City& city, std::size_t target, int range, int threads) {
  return std::string(method) + "/" + city.name + "/T" + std::to_string(target + 1) + "/" + std::to_string(range) +
         "m/" + (threads == 1 ? "one" : "all");
}

void add_engine(const City& city, const std::vector<int>& ranges) {
  for (int target = 0; target < city.targets; ++target) {
    for (const int range : ranges) {
      for (const int threads : {1, 0}) {
        add(case_name("engine", city, target, range, threads),
            [&city, target, range, threads](State& state) { engine(state, city, target, range, threads); });
      }
    }
  }
}

const bool registered = [] {
  for (const City* city : {&kMunich, &kMunichRepeated}) {
    add(
        std::string("prepare/") + city->name, [city](State& state) { prepare(state, *city); }, 1);
  }
  add_engine(kCharlotte, {100, 300, 600});
  add_engine(kMunich, {300, 600});
  add_engine(kFlorence, {300, 600});
  add_engine(kMunichRepeated, {300});
  add_engine(kOpenfoam, {200});
  for (const bool fan : {true, false}) {
    for (const int count : {1000, 3482}) {
      add(
          std::string("sheets/") + (fan ? "fan/" : "star/") + std::to_string(count),
          [count, fan](State& state) { many_sheets(state, count, fan); }, 1);
    }
  }
  for (int target = 0; target < kCharlotte.targets; ++target) {
    for (const int threads : {1, 0}) {
      add(
          case_name("plain", kCharlotte, target, 100, threads),
          [target, threads](State& state) { plain(state, kCharlotte, target, 100, threads); }, 1);
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
