// compute_mission, and what else the program wants to know of the run.
#pragma once

#include <optional>
#include <string>

#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::app {

struct MissionRun {
  Volume volume;
  LoadedScene loaded;
  SceneStatistics scene;                 ///< what preparing found
  std::optional<SpheresReport> spheres;  ///< what the spheres method did, where it was used
};

/// As compute_mission, and places the mission as read_mission_scene does. `stages` are those of the spheres method.
MissionRun run_mission(Mission& mission, const Progress& progress, const StageSink& stages = {});

/// Calls `action` and returns what it returns. An Error(input) from it is thrown on with `place` (of the mission file)
/// put in front of its own `where`: the engine knows the objects, but not the file that named the target.
template <typename Action>
auto with_place(const std::string& place, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input || place.empty()) throw;
    throw Error(error.kind(), error.problem(), error.where().empty() ? place : place + ", " + error.where(),
                error.fix());
  }
}

}  // namespace vantage::app
