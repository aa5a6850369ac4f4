#include "cli/target_volumes.h"

#include <cstddef>
#include <utility>

#include "cli/chosen_target.h"
#include "cli/command.h"
#include "common/input.h"
#include "vantage/error.h"

namespace vantage::cli {

void keep_clearance(MissionFile& file, const std::string& typed) {
  std::optional<Clearance>& clearance = file.navigation.clearance;
  if (!typed.empty()) {
    const double asked = length_option("--clearance", typed);
    if (asked < 0) {
      throw Error(ErrorCode::value_out_of_range, "--clearance must be at least 0, not " + in_quotes(typed),
                  "command line, --clearance", "write a length");
    }
    clearance.reset();
    if (asked > 0) clearance.emplace().distance_m = asked;
    return;
  }
  const double asked = file.tour ? file.tour->clearance_m : 0;
  if (asked > 0 && (!clearance || clearance->distance_m < asked)) clearance.emplace().distance_m = asked;
}

TargetVolumes compute_targets(const MissionFile& file, const std::string& name, int threads, const Progress& progress) {
  Mission mission = resolve_mission(file, progress);
  if (!name.empty()) mission = of_target(mission, name);
  TargetVolumes result{PreparedScene(mission.scene(), progress), {}};
  RunOptions options;
  options.threads = threads;
  options.prepared = result.scene;
  if (volume_count(mission) == 1) {
    Volume volume = run_mission(mission, options, progress).volume;
    result.targets.push_back({mission.target.name, std::move(mission), std::move(volume)});
    return result;
  }
  const std::vector<std::string> names = target_names(mission);
  std::vector<Attempt> attempts = try_missions(mission, options, progress);
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    Volume volume = attempts[i].result ? std::move(attempts[i].result->volume) : Volume();
    result.targets.push_back({names[i], one_volume(mission, i), std::move(volume), std::move(attempts[i].error)});
  }
  return result;
}

void tell_of_volume(const Volume& volume, std::vector<std::string>& notes) {
  std::vector<std::string> texts;
  for (const Warning& warning : volume.notes) texts.push_back(warning.text);
  notes.insert(notes.begin(), texts.begin(), texts.end());
}

}  // namespace vantage::cli
