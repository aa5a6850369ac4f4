// The volumes of a mission's targets, computed for commands that look for something in them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::cli {

struct TargetVolume {
  std::string name;
  Mission mission;                  ///< of this volume alone
  Volume volume;                    ///< empty where there is an error
  std::optional<Error> error = {};  ///< why there is no volume: the target cannot be seen as it lies
};

struct TargetVolumes {
  PreparedScene scene;
  std::vector<TargetVolume> targets;  ///< one or more
};

/// Resolves the mission, prepares its scene and computes each of its volumes, or that of the target `name` alone. An
/// error of one of several targets is kept, that of a single one thrown. `threads` as in RunOptions.
TargetVolumes compute_targets(const MissionFile& file, const std::string& name, int threads, const Progress& progress);

inline constexpr const char* kClearanceHelp =
    "How far from the scene at least, but for its ground; default: tour.clearance, else navigation.clearance";

/// Volumes keep so far from the scene: `typed`, where it is not empty; else what MissionFile::tour says, unless
/// `navigation` keeps farther away. Throws Error(input) for what is no length of at least 0.
void keep_clearance(MissionFile& file, const std::string& typed);

/// What is to be known of a volume, before what is to be known of what was found in it.
void tell_of_volume(const Volume& volume, std::vector<std::string>& notes);

}  // namespace vantage::cli
