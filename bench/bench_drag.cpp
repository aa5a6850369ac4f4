// A mission that is edited step by step, from scratch and with what is kept of the last run (RunOptions::kept), beside
// each other. Names: drag/<scene>/<what is dragged>/<scratch or kept>. Range 300 m, all threads; the scene is prepared.
// `taken`: volumes that a step did not compute, on average.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/dragged.h"
#include "vantage/mission.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr int kRepetitions = 5;

struct Place {
  std::shared_ptr<const LoadedScene> loaded;
  PreparedScene prepared;
  std::string hash;

  explicit Place(const City& city)
      : loaded(std::make_shared<const LoadedScene>(LoadedScene{.scene = read_city(city)})),
        prepared(loaded->scene),
        hash(scene_hash(loaded->scene)) {}
};

/// Read once. Null when the file is absent.
const Place* place_of(const City& city) {
  static std::vector<std::pair<const City*, std::unique_ptr<Place>>> places;
  if (!is_there(city)) return nullptr;
  for (const auto& [of, place] : places) {
    if (of == &city) return place.get();
  }
  return places.emplace_back(&city, std::make_unique<Place>(city)).second.get();
}

using Edit = std::function<void(int step, MissionFile& file)>;

void drag_target(int step, MissionFile& file) { drag_corner(step, file.targets.front().target); }

void drag_altitude(int step, MissionFile& file) {
  file.navigation.altitude = Navigation::Altitude{2, 60 + kDragStep * (step % kDragSteps)};
}

/// Two thirds of the target in cells must be seen.
void drag_altitude_of_share(int step, MissionFile& file) {
  file.sensor.visible = VisibleShare{0.66, 4};
  drag_altitude(step, file);
}

/// One of two: the second is the first, moved aside.
void drag_one_of_two(int step, MissionFile& file) {
  const Target first = file.targets.front().target;
  Target other = first;
  const Vec3 aside = 0.3 * (first.parts[0][1] - first.parts[0][0]);
  for (Vec3& vertex : other.parts[0]) vertex += aside;
  drag_corner(step, other);
  other.name = "other";
  file.combine = Combine::each;
  file.targets = {{first}, {other}};
}

void drag(State& state, const City& city, const Edit& edit, bool keep) {
  const Place* const place = place_of(city);
  if (!place) return state.SkipWithError(absence(city).c_str());
  MissionFile file;
  file.targets = {{dragged_target(city)}};
  file.sensor.max_range_m = kDragRange;
  RunOptions options{.prepared = place->prepared, .scene_hash = place->hash};
  const auto kept = std::make_shared<KeptVolumes>();
  if (keep) options.kept = kept;
  int step = 0;
  std::vector<Result> results;
  const auto run_next = [&] {
    MissionFile edited = file;
    edit(step++, edited);
    results = run_missions(resolve_mission(edited, place->loaded), options);
  };
  run_next();
  for (auto _ : state) run_next();
  for (const Result& result : results) {
    if (result.volume.outcome != Outcome::computed) return state.SkipWithError(result.volume.reason.c_str());
  }
  state.counters["facets"] = static_cast<double>(results.front().volume.mesh.triangles.size());
  state.counters["taken"] = static_cast<double>(kept->taken()) / (step - 1);
}

const bool registered = [] {
  const std::pair<const char*, Edit> edits[] = {
      {"corner", drag_target},
      {"one-of-two", drag_one_of_two},
      {"altitude", drag_altitude},
      {"altitude-of-share", drag_altitude_of_share},
  };
  for (const City* city : {&kCharlotte, &kMunich}) {
    for (const auto& [what, edit] : edits) {
      for (const bool keep : {false, true}) {
        const std::string name = std::string("drag/") + city->name + "/" + what + (keep ? "/kept" : "/scratch");
        const Edit body = edit;
        benchmark::RegisterBenchmark(name.c_str(), [city, body, keep](State& state) { drag(state, *city, body, keep); })
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime()
            ->MinTime(0.2)
            ->Repetitions(kRepetitions)
            ->ReportAggregatesOnly(true);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
