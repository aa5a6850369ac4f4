#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/chosen_target.h"
#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/target_volumes.h"
#include "cli/text_table.h"
#include "cli/view_rows.h"
#include "vantage/error.h"
#include "vantage/standpoints.h"

namespace vantage::cli {
namespace {

constexpr const char* kStandExamples =
    "STANDPOINTS\n"
    "  Of each volume of the mission:\n"
    "    deepest         farthest from the volume's boundary\n"
    "    nearest         nearest to the target's centre\n"
    "    finest_pixel    the largest pixel on the target is the smallest; for a mission with a camera\n"
    "    best_incidence  most face-on\n"
    "    farthest        farthest from obstacles: all objects of the scene but the ground\n"
    "  Each is the best of all positions that keep the margin, to 0.1 m, 0.5 % of a pixel or 0.1 degrees. With --json\n"
    "  'bound' says how good any other position can be at most. Yaw is clockwise from north, +y of the scene. Yaw and\n"
    "  pitch centre the target.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage stand mission.yaml\n"
    "  vantage stand mission.yaml --margin 3\n"
    "  vantage stand mission.yaml --target roof --json | jq '.targets[].standpoints[].position'\n"
    "\n"
    "The exit code is 1 if a target has no standpoint.\n";

struct StandArguments {
  CommonOptions common;
  std::string mission_file, target;
  std::string margin, clearance;  // as typed; empty: not given
  bool json = false;
};

/// What the value of a standpoint says, and how good others can be.
void add_value(TextTable& table, const Standpoint& point) {
  const char* const name = name_of(point.kind);
  switch (point.kind) {
    case StandpointKind::deepest:
      return table.row(name, fixed(point.value, 2),
                       "metres inside the volume; none is deeper than " + fixed(point.bound, 2));
    case StandpointKind::nearest:
      return table.row(name, fixed(point.value, 2),
                       "metres to the target's centre; none is nearer than " + fixed(point.bound, 2));
    case StandpointKind::finest_pixel:
      return table.row(name, pixel_text(point.value), "on the target; none has less than " + pixel_text(point.bound));
    case StandpointKind::best_incidence:
      return table.row(name, fixed(point.value, 2), "degrees; none has less than " + fixed(point.bound, 2));
    case StandpointKind::farthest:
      return table.row(name, fixed(point.value, 2),
                       "metres to the nearest obstacle; none has more than " + fixed(point.bound, 2));
  }
}

std::string text_of(const std::vector<NamedStandpoints>& targets) {
  TextTable table;
  for (const NamedStandpoints& target : targets) {
    const Standpoints& points = target.standpoints;
    if (points.found.empty()) {
      table.heading("target '" + target.target + "': no standpoint: " + points.reason);
      continue;
    }
    table.heading("target '" + target.target + "': " + count(points.found.size()) + " standpoints, at least " +
                  fixed(points.margin_m, 2) + " m inside the volume");
    for (const Standpoint& point : points.found) {
      add_value(table, point);
      add_place(table, point.view);
      add_sight(table, point.view);
      if (point.kind != StandpointKind::deepest) table.row("  margin", fixed(point.margin_m, 2), "metres inside");
    }
  }
  return table.text();
}

std::vector<NamedStandpoints> standpoints_of(const TargetVolumes& volumes, const StandpointOptions& options,
                                             const Progress& progress) {
  std::vector<NamedStandpoints> result;
  std::optional<ViewDescriber> describer;  // what it made of the scene serves all targets
  for (const TargetVolume& target : volumes.targets) {
    NamedStandpoints& one = result.emplace_back();
    one.target = target.name;
    if (target.error) {
      one.standpoints.reason = target.error->problem();
      continue;
    }
    describer = describer ? ViewDescriber(target.mission, *describer) : ViewDescriber(target.mission);
    one.standpoints = find_standpoints(target.mission, target.volume, volumes.scene, *describer, options, progress);
    tell_of_volume(target.volume, one.standpoints.notes);
  }
  return result;
}

int run_stand(const StandArguments& arguments) {
  MissionFile file = read_mission_argument(arguments.mission_file);
  keep_clearance(file, arguments.clearance);
  StandpointOptions options;
  if (file.tour) options.margin_m = file.tour->margin_m;
  options.threads = arguments.common.threads;
  if (!arguments.margin.empty()) options.margin_m = length_option("--margin", arguments.margin);
  std::vector<NamedStandpoints> found;
  {
    ProgressLine progress(arguments.common);
    const TargetVolumes volumes =
        compute_targets(file, arguments.target, arguments.common.threads, progress.callback());
    found = standpoints_of(volumes, options, progress.callback());
  }
  print(arguments.json ? json_text(found) : text_of(found));
  bool has_all = true;
  for (const NamedStandpoints& one : found) {
    has_all = has_all && !one.standpoints.found.empty();
    if (arguments.common.quiet) continue;
    for (const std::string& text : one.standpoints.notes) note((found.size() > 1 ? one.target + ": " : "") + text);
  }
  return has_all ? kSuccess : kCheckFailed;
}

}  // namespace

void add_stand(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("stand", "Find the best places to hover at and look at the target");
  auto options = std::make_shared<StandArguments>();
  command->add_option("mission", options->mission_file, "The mission file; - for standard input")
      ->required()
      ->option_text("MISSION");
  command->add_option("--target", options->target, kTargetHelp)->option_text("NAME");
  command
      ->add_option("--margin", options->margin,
                   "How far from the volume's boundary at least; default: tour.view.margin, else 1 m, less in small "
                   "volumes")
      ->option_text("METRES");
  command->add_option("--clearance", options->clearance, kClearanceHelp)->option_text("METRES");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<StandArguments>(*command, options, kStandExamples, chosen, run_stand);
}

}  // namespace vantage::cli
