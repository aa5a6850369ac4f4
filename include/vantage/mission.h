// Mission files: docs/mission-file.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/scene.h"
#include "vantage/spheres.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {

/// How the volume is computed.
enum class Method {
  exact,    ///< compute_visibility
  spheres,  ///< compute_visibility_spheres
};

/// A mission file, read and checked. Paths are absolute; navigation meshes are read.
struct Mission {
  std::filesystem::path file;
  std::filesystem::path scene_file;
  SceneReadOptions scene_options;
  Target target;
  Sensor sensor;
  Navigation navigation;
  Method method = Method::exact;
  ExactOptions exact;
  SpheresOptions spheres;  ///< but for the threads: those of `exact` count for both methods
  std::vector<std::filesystem::path> navigation_files;  ///< that navigation.meshes were read from, in the same order
  std::string target_place;  ///< "mission.yaml:9:13": put in front of the place in errors about the target
};

/// Throws Error(input) with file, line and column for: a missing or unreadable file, YAML that does not parse, an
/// unknown key (with the nearest known one), a wrong type, a number that is NaN or infinite, a missing required key,
/// edges that do not describe the vertices' polygon, and all that make_target_frame and the navigation checks refuse.
Mission read_mission(const std::filesystem::path& file);

/// All that `vantage compute` does but writing: reads the scene, prepares it, computes, cuts. Fills Volume::seconds.
/// Uses at most `mission.exact.threads` threads for all of it. Throws as read_scene, the method and
/// cut_to_navigation do, with the place in the mission file put in front of errors about the target. Cost: the sum of
/// theirs; the scene is read and prepared anew each time, so use those functions for many targets of one scene.
Volume compute_mission(const Mission& mission, const Progress& progress = {});

}  // namespace vantage
