#include <chrono>

#include "app/caveats.h"
#include "app/pierced_advice.h"
#include "app/run_mission.h"
#include "core/parallel.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

class Stopwatch {
 public:
  /// Seconds since the last call, or since the stopwatch was made.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace

namespace app {

namespace {

Volume compute_part(const Mission& mission, const Target& target, const PreparedScene& scene, const Progress& progress,
                    const StageSink& stages, std::optional<SpheresReport>& report) {
  if (mission.method == Method::exact) {
    return compute_visibility(scene, target, mission.sensor, mission.exact, progress);
  }
  SpheresOptions options = mission.spheres;
  options.threads = 0;  // those of the arena that the mission runs in
  return compute_visibility_spheres(scene, target, mission.sensor, options, &report.emplace(), stages, progress);
}

Volume compute(const Mission& mission, const PreparedScene& scene, const Progress& progress, const StageSink& stages,
               std::optional<SpheresReport>& report) {
  if (mission.other_parts.empty()) return compute_part(mission, mission.target, scene, progress, stages, report);
  std::vector<Volume> volumes{compute_part(mission, mission.target, scene, progress, stages, report)};
  for (const Target& part : mission.other_parts) {
    volumes.push_back(compute_part(mission, part, scene, progress, stages, report));
  }
  return intersect_volumes(volumes, progress);
}

/// Errors about devices are of no place in the mission's target.
bool is_about_target(const Error& error) { return error.where().starts_with("target"); }

MissionRun run_stages(Mission& mission, const Progress& progress, const StageSink& stages) {
  MissionRun run;
  Seconds seconds;
  Stopwatch stopwatch;
  const std::string target_object = mission.ground_target ? mission.ground_target->osm : "";
  run.loaded = read_mission_scene(mission, progress);
  seconds.read = stopwatch.lap();

  const PreparedScene prepared(run.loaded.scene, progress);
  run.scene = prepared.statistics();
  seconds.prepare = stopwatch.lap();

  const auto placed = [&](const SphereStage& stage) {
    SphereStage copy = stage;
    copy.georeference = run.loaded.scene.georeference;
    stages(copy);
  };
  try {
    run.volume = compute(mission, prepared, progress, stages ? StageSink(placed) : StageSink(), run.spheres);
  } catch (const target::PiercedTarget& error) {
    with_place(mission.target_place, [&]() -> int { throw explained(error, run.loaded, target_object); });
  } catch (const Error& error) {
    if (mission.method == Method::spheres && !is_about_target(error)) throw;
    with_place(mission.target_place, [&]() -> int { throw error; });
  }
  seconds.engine = stopwatch.lap();

  if (run.volume.outcome == Outcome::computed && !mission.navigation.empty()) {
    run.volume =
        with_place(mission.file.string(), [&] { return cut_to_navigation(run.volume, mission.navigation, progress); });
    seconds.navigation = stopwatch.lap();
  }
  seconds.total = seconds.read + seconds.prepare + seconds.engine + seconds.navigation;
  run.volume.seconds = seconds;
  run.volume.georeference = run.loaded.scene.georeference;
  std::vector<std::string> notes = caveats(mission, run.loaded, &run.volume);
  run.volume.notes.insert(run.volume.notes.end(), notes.begin(), notes.end());
  return run;
}

}  // namespace

MissionRun run_mission(Mission& mission, const Progress& progress, const StageSink& stages) {
  MissionRun run;
  parallel::with_threads(mission.exact.threads, [&] { run = run_stages(mission, progress, stages); });
  return run;
}

}  // namespace app

Volume compute_mission(const Mission& mission, const Progress& progress) {
  Mission placed = mission;
  return app::run_mission(placed, progress).volume;
}

}  // namespace vantage
