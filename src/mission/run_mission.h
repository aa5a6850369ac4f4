// compute_mission, and what else the program wants to know of the run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::mission_io {

struct MissionRun {
  Volume volume;
  LoadedScene loaded;
  SceneStatistics scene;                 ///< what preparing found
  std::optional<SpheresReport> spheres;  ///< what the spheres method did, where it was used
};

/// As compute_mission, and places the mission as read_mission_scene does. `stages` are those of the spheres method.
MissionRun run_mission(Mission& mission, const Progress& progress, const StageSink& stages = {});

/// Axes and unit of the mission's results in OBJ, told before the scene is read: those of the scene's mesh file, so
/// that they load on top of it; z up and metres where it is no mesh.
SceneReadOptions result_axes(const SceneSource& scene);

/// How a result, or any mesh that goes with it, is read into the frame of `scene`: OBJ in the axes and the unit of the
/// scene's file; one that says where on the earth it lies is moved there, any other is taken to be in the frame.
SceneReadOptions result_options(const std::filesystem::path& file, const Scene& scene);

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

}  // namespace vantage::mission_io
