#include "cli/judged_volume.h"

#include <utility>

#include "cli/chosen_target.h"
#include "cli/standard_streams.h"
#include "vantage/input.h"

namespace vantage::cli {

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
  if (!arguments.common.quiet) {
    notes(mission_warnings(mission));
    notes(read.notes);
    notes(volume_warnings(read, mission));
  }
  return {std::move(mission), std::move(read)};
}

}  // namespace vantage::cli
