#include "cli/judged_volume.h"

#include <utility>
#include <vector>

#include "cli/chosen_target.h"
#include "cli/standard_streams.h"
#include "common/input.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::cli {
namespace {

/// There is nothing to judge of a target that is flown through.
void refuse_volumes(const Mission& mission) {
  const auto refuse = [&](const Target& target) {
    if (!target.is_volume()) return;
    try {
      make_target_frame(target);
    } catch (const Error& error) {
      throw error.with_where(mission.as_written.places.target + ", " + error.where());
    }
  };
  refuse(mission.target);
  for (const std::vector<Target>& view : mission.views) {
    for (const Target& target : view) refuse(target);
  }
}

}  // namespace

void add_judge_options(CLI::App& command, JudgeArguments& arguments) {
  command
      .add_option("mission", arguments.mission_file,
                  "The mission that the volume was computed for; - for standard input")
      ->required()
      ->option_text("MISSION");
  command
      .add_option("volume", arguments.volume_file,
                  "The volume: PLY, OBJ, STL, glTF or GLB; may be compressed with gzip")
      ->required()
      ->option_text("FILE");
  command.add_option("--target", arguments.target, kTargetHelp)->option_text("NAME");
  command.add_flag("--json", arguments.json, "Print JSON instead of a table");
}

JudgedVolume read_judged(const JudgeArguments& arguments, ProgressLine& progress) {
  check_readable(arguments.volume_file, "the volume");
  const MissionFile file = read_mission_argument(arguments.mission_file);
  const Mission resolved = resolve_mission(file, progress.callback());
  VolumeFile read = read_volume(arguments.volume_file, resolved.scene(), progress.callback());
  Mission mission = of_volume(resolved, arguments.target, read);
  refuse_volumes(mission);
  if (!arguments.common.quiet) {
    notes(mission_warnings(mission));
    notes(read.notes);
    notes(volume_warnings(read, mission));
  }
  return {std::move(mission), std::move(read)};
}

}  // namespace vantage::cli
