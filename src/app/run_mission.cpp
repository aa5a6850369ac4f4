#include <algorithm>
#include <utility>

#include "app/components/solid.h"
#include "app/components/spheres.h"
#include "app/pierced_advice.h"
#include "app/places.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "vantage/error.h"
#include "vantage/hash.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

Volume compute(const Mission& mission, const PreparedTarget& target, const StageSink& stages, Result& result,
               const Progress& progress) {
  if (mission.as_written.method == Method::exact) {
    ExactOptions options = mission.as_written.exact;
    options.threads = 0;  // those of the arena that the mission runs in
    return internal::app::exact_volume(target, options, progress);
  }
  SpheresOptions options = mission.as_written.spheres;
  options.threads = 0;
  const auto georeferenced = [&](const SphereStage& stage) {
    SphereStage copy = stage;
    copy.georeference = mission.loaded.scene.georeference;
    stages(copy);
  };
  const StageSink sink = stages ? StageSink(georeferenced) : StageSink();
  std::vector<Volume> volumes;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    volumes.push_back(internal::app::spheres_volume(target.part(i), options, result.spheres.emplace(), sink, progress));
  }
  return internal::app::joined(std::move(volumes), progress);
}

/// `prepare_seconds`: that preparing the scene took; `stopwatch`: its last lap ended with that.
Result run(const Mission& mission, const PreparedTarget& target, double prepare_seconds,
           internal::core::Stopwatch& stopwatch, const StageSink& stages, const Progress& progress) {
  Result result;
  Seconds seconds;
  const Scene& scene = mission.loaded.scene;
  seconds.read = mission.read_seconds;
  seconds.prepare = prepare_seconds;
  result.scene = target.scene().statistics();
  try {
    result.volume = compute(mission, target, stages, result, progress);
  } catch (const Error& error) {
    // The target itself is checked by now. The exact method may still find it too large for the tolerance; the method
    // of spheres refuses only its options and devices, which the mission names elsewhere.
    if (mission.as_written.method == Method::spheres) throw;
    internal::app::with_place(mission.as_written.places.target, [&]() -> int { throw error; });
  }
  seconds.engine = stopwatch.lap();

  const bool is_limited = !mission.navigation.empty() || target.sensor().limits_view();
  if (result.volume.outcome == Outcome::computed && is_limited) {
    result.volume = internal::app::with_place(mission.as_written.file.string(), [&] {
      return internal::app::within_limits(result.volume, target, mission.navigation, progress);
    });
    seconds.navigation = stopwatch.lap();
  }
  seconds.total = seconds.read + seconds.prepare + seconds.engine + seconds.navigation;
  result.volume.seconds = seconds;
  result.volume.georeference = scene.georeference;
  if (result.volume.provenance) {
    result.volume.provenance->scene_hash = scene_hash(scene);
    result.volume.provenance->mission_hash = mission_hash(mission);
  }
  std::vector<Warning> warnings = mission_warnings(mission, &result.volume);
  result.volume.notes.insert(result.volume.notes.end(), warnings.begin(), warnings.end());
  return result;
}

}  // namespace

const char* name_of(Method method) { return method == Method::spheres ? "spheres" : "exact"; }

PreparedTarget prepare_target(const Mission& mission, const PreparedScene& scene) {
  const auto& ground = mission.as_written.ground_target;
  return internal::app::with_place(mission.as_written.places.target, [&] {
    try {
      return PreparedTarget(scene, mission.target, mission.sensor);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::target_pierced) throw;
      throw internal::app::explained(error, mission.loaded, ground ? ground->osm : "");
    }
  });
}

Result run_mission(const Mission& mission, const RunOptions& options, const Progress& progress) {
  Result result;
  internal::parallel::with_threads(options.threads, [&] {
    internal::core::Stopwatch stopwatch;
    const PreparedScene scene(mission.loaded.scene, progress);
    const double prepare_seconds = stopwatch.lap();
    const PreparedTarget target = prepare_target(mission, scene);
    result = run(mission, target, prepare_seconds, stopwatch, options.stages, progress);
  });
  return result;
}

Result run_mission(const Mission& mission, const PreparedTarget& target, const RunOptions& options,
                   const Progress& progress) {
  Result result;
  internal::parallel::with_threads(options.threads, [&] {
    internal::core::Stopwatch stopwatch;
    result = run(mission, target, 0, stopwatch, options.stages, progress);
  });
  return result;
}

}  // namespace vantage
