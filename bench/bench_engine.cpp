// How long one target takes once the scene is prepared, against a plain union of blockers; and preparing a large city.
// Names: engine/<scene>/<target>/<range>/<threads>. Times are of compute_visibility alone; a summary with the ratios is
// made by bench/run.sh.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parallel/parallel.h"
#include "support/memory.h"
#include "support/plain_union.h"
#include "support/shared_data.h"
#include "support/street_targets.h"
#include "vantage/error.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;
using testing::shared_data;

constexpr std::uint64_t kSeed = 1;
constexpr int kStreetTargets = 5, kRepetitions = 5, kTiles = 5;
constexpr double kPlainSeconds = 120;  ///< the plain union is given up after this

struct City {
  const char* name;
  const char* file;
  UpAxis up;
  StreetSearch search;
  int targets;
  int tiles = 1;  ///< repeated so often along x and along y
};
const City kCharlotte{"charlotte", "charlotte/uptownCharlotte.obj", UpAxis::y, {}, 3};
const City kMunich{"munich", "mesh/munich_merged.ply", UpAxis::z, {kSeed}, kStreetTargets};
const City kMunichRepeated{"munich_5x5", "mesh/munich_merged.ply", UpAxis::z, {kSeed}, kStreetTargets, kTiles};
const City kFlorence{"florence", "mesh/florence_merged.ply", UpAxis::z, {kSeed}, kStreetTargets};
const City kOpenfoam{"openfoam", "mesh/openfoam-buildings.obj.gz", UpAxis::z, {}, 1};

/// Copies side by side, the one in the middle where the scene was.
Scene repeat(const Scene& scene, int tiles) {
  Scene repeated;
  repeated.objects = scene.objects;
  const Box bounds = bounding_box(scene.mesh);
  const Vec3 size = bounds.max - bounds.min;
  const int middle = tiles / 2;
  for (int i = 0; i < tiles; ++i)
    for (int j = 0; j < tiles; ++j) {
      const Vec3 shift((i - middle) * size.x(), (j - middle) * size.y(), 0);
      const auto first = std::uint32_t(repeated.mesh.vertices.size());
      for (const Vec3& v : scene.mesh.vertices) repeated.mesh.vertices.push_back(v + shift);
      for (const Triangle& t : scene.mesh.triangles)
        repeated.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      repeated.object_of.insert(repeated.object_of.end(), scene.object_of.begin(), scene.object_of.end());
    }
  return repeated;
}

Scene read_city(const City& city) { return read_scene(shared_data(city.file), {city.up, 1.0}); }

/// Of charlotte/baseline.json, which keeps the axes of the OBJ (y up).
std::vector<StreetTarget> baseline_targets() {
  std::ifstream stream(shared_data("charlotte/baseline.json"));
  const auto baseline = nlohmann::json::parse(stream);
  std::vector<StreetTarget> targets;
  for (const auto& entry : baseline.at("targets")) {
    StreetTarget found{{}, Vec3::Zero(), 0};
    for (const auto& v : entry.at("vertices")) found.target.vertices.emplace_back(v[0], -v[2].get<double>(), v[1]);
    for (const Vec3& v : found.target.vertices) found.centre += v / double(found.target.vertices.size());
    targets.push_back(found);
  }
  return targets;
}

/// Its streets hold no 20 m target: one just over a roof 30 m up, among towers of up to 76 m.
std::vector<StreetTarget> roof_target() {
  const Vec3 centre(120, 90, 30.01);
  StreetTarget found{{}, centre, 0};
  found.target.vertices = {centre + Vec3(11.547, 0, 0), centre + Vec3(-5.7735, 10, 0), centre + Vec3(-5.7735, -10, 0)};
  return {found};
}

struct Prepared {
  Scene scene;
  PreparedScene prepared;
  std::vector<StreetTarget> targets;
};

/// Read, prepared and searched for targets once. Nothing when the file is absent.
const Prepared* prepared(const City& city) {
  static std::map<std::string, Prepared> cities;
  if (!std::filesystem::exists(shared_data(city.file))) return nullptr;
  if (const auto known = cities.find(city.name); known != cities.end()) return &known->second;
  const auto keep = [&](Prepared made) { return &cities.emplace(city.name, std::move(made)).first->second; };
  if (city.tiles > 1) {
    const Prepared* single = prepared(kMunich);
    return keep({{}, PreparedScene(repeat(single->scene, city.tiles)), single->targets});
  }
  Scene scene = read_city(city);
  PreparedScene ready(scene);
  auto targets = &city == &kCharlotte  ? baseline_targets()
                 : &city == &kOpenfoam ? roof_target()
                                       : find_street_targets(scene, ready, city.search, std::size_t(city.targets));
  return keep({std::move(scene), std::move(ready), std::move(targets)});
}

void skip(State& state, const City& city) {
  state.SkipWithError(
      (std::string(city.file) + " is absent: set VANTAGE_SHARED to the folder that holds data/").c_str());
}

std::string describe(const StreetTarget& target) {
  char text[96];
  const Vec3& c = target.centre;
  const int length = std::snprintf(text, sizeof text, "centre (%.1f %.1f %.1f)", c.x(), c.y(), c.z());
  if (target.enclosed > 0)  // not known of the baseline's
    std::snprintf(text + length, sizeof text - std::size_t(length), ", enclosed %.0f %%", 100 * target.enclosed);
  return text;
}

void engine(State& state, const City& city, std::size_t index, double range, int threads) {
  const Prepared* const ready = prepared(city);
  if (!ready) return skip(state, city);
  if (index >= ready->targets.size()) return state.SkipWithError("so many street targets were not found");
  const StreetTarget& street = ready->targets[index];
  std::optional<Volume> volume;
  for (auto _ : state) {
    volume = compute_visibility(ready->prepared, street.target, {range}, {ExactOptions().tolerance_m, threads});
  }
  if (volume->outcome != Outcome::computed) return state.SkipWithError(volume->reason.c_str());
  state.counters["facets"] = double(volume->mesh.triangles.size());
  state.counters["visible_blockers"] = double(volume->counts.visible_blockers);
  state.counters["volume_m3"] = enclosed_volume(volume->mesh);
  state.SetLabel(describe(street));
}

void plain(State& state, const City& city, std::size_t index, double range, int threads) {
  const Prepared* const ready = prepared(city);
  if (!ready) return skip(state, city);
  const StreetTarget& street = ready->targets.at(index);
  const TargetFrame frame = make_target_frame(street.target);
  Volume open = compute_visibility(PreparedScene{Scene{}}, street.target, {range});
  for (Vec3& v : open.mesh.vertices) v = frame.to_local(v);
  const solid::Solid region({open.mesh, open.cause_of}, "range region");
  solid::Solid result;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const auto watch = [&](double) {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < kPlainSeconds;
    };
    try {
      parallel::with_threads(threads, [&] {
        result = plain_visibility(ready->scene, frame, region, range, watch);
        benchmark::DoNotOptimize(result.facets());
      });
    } catch (const Error& error) {
      return state.SkipWithError(error.kind() == ErrorKind::cancelled ? "given up: it took too long" : error.what());
    }
  }
  state.counters["facets"] = double(result.facets());
  state.counters["volume_m3"] = result.volume();
  state.SetLabel(describe(street));
}

void prepare(State& state, const City& city) {
  if (!std::filesystem::exists(shared_data(city.file))) return skip(state, city);
  const Scene single = read_city(city), scene = city.tiles > 1 ? repeat(single, city.tiles) : single;
  reset_peak_memory();
  for (auto _ : state) {
    const PreparedScene ready(scene);
    benchmark::DoNotOptimize(ready.statistics().polygons);
  }
  state.counters["triangles"] = double(scene.mesh.triangles.size());
  state.counters["peak_MB"] = peak_memory() / 1e6;  // the scene as read included
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

/// CPU time is of all threads of the process: it does not grow when others use the machine.
void add(const std::string& name, const std::function<void(State&)>& body, int iterations = 0) {
  auto* entry = benchmark::RegisterBenchmark(name.c_str(), body);
  entry->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
  entry->Repetitions(kRepetitions)->ReportAggregatesOnly(true)->ComputeStatistics("min", least);
  if (iterations)
    entry->Iterations(iterations)->Repetitions(3);
  else
    entry->MinTime(0.1);
}

std::string case_name(const char* method, const City& city, std::size_t target, int range, int threads) {
  return std::string(method) + "/" + city.name + "/T" + std::to_string(target + 1) + "/" + std::to_string(range) +
         "m/" + (threads == 1 ? "one" : "all");
}

void add_engine(const City& city, const std::vector<int>& ranges) {
  for (int target = 0; target < city.targets; ++target)
    for (const int range : ranges)
      for (const int threads : {1, 0})
        add(case_name("engine", city, target, range, threads),
            [&city, target, range, threads](State& state) { engine(state, city, target, range, threads); });
}

const bool registered = [] {
  for (const City* city : {&kMunich, &kMunichRepeated})
    add(
        std::string("prepare/") + city->name, [city](State& state) { prepare(state, *city); }, 1);
  add_engine(kCharlotte, {100, 300, 600});
  add_engine(kMunich, {300, 600});
  add_engine(kFlorence, {300, 600});
  add_engine(kMunichRepeated, {300});
  add_engine(kOpenfoam, {200});
  for (int target = 0; target < kCharlotte.targets; ++target)
    for (const int threads : {1, 0})
      add(
          case_name("plain", kCharlotte, target, 100, threads),
          [target, threads](State& state) { plain(state, kCharlotte, target, 100, threads); }, 1);
  return true;
}();

}  // namespace
}  // namespace vantage::bench
