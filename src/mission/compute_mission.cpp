#include <chrono>

#include "mission/run_mission.h"
#include "parallel/parallel.h"
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

namespace mission_io {

namespace {

MissionRun run_stages(const Mission& mission, const Progress& progress) {
  MissionRun run;
  Seconds seconds;
  Stopwatch stopwatch;
  const Scene scene = read_scene(mission.scene_file, mission.scene_options, progress);
  run.scene_up = scene.up;
  run.scene_scale = scene.scale;
  seconds.read = stopwatch.lap();

  const PreparedScene prepared(scene, progress);
  run.scene = prepared.statistics();
  seconds.prepare = stopwatch.lap();

  run.volume = with_place(mission.target_place, [&] {
    return compute_visibility(prepared, mission.target, mission.sensor, mission.exact, progress);
  });
  seconds.engine = stopwatch.lap();

  if (run.volume.outcome == Outcome::computed && !mission.navigation.empty()) {
    run.volume =
        with_place(mission.file.string(), [&] { return cut_to_navigation(run.volume, mission.navigation, progress); });
    seconds.navigation = stopwatch.lap();
  }
  seconds.total = seconds.read + seconds.prepare + seconds.engine + seconds.navigation;
  run.volume.seconds = seconds;
  return run;
}

}  // namespace

MissionRun run_mission(const Mission& mission, const Progress& progress) {
  MissionRun run;
  parallel::with_threads(mission.exact.threads, [&] { run = run_stages(mission, progress); });
  return run;
}

}  // namespace mission_io

Volume compute_mission(const Mission& mission, const Progress& progress) {
  return mission_io::run_mission(mission, progress).volume;
}

}  // namespace vantage
