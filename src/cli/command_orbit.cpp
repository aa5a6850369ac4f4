#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/chosen_target.h"
#include "cli/command.h"
#include "cli/plan_output.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/target_volumes.h"
#include "cli/text_table.h"
#include "cli/view_rows.h"
#include "common/input.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/standpoints.h"

namespace vantage::cli {
namespace {

constexpr const char* kOrbitExamples =
    "ORBITS\n"
    "  Circles at one height, wholly inside the volume, with the target within:\n"
    "    widest        the largest radius\n"
    "    deepest       farthest from the volume's boundary all round\n"
    "    finest_pixel  the largest pixel on the target, all round, is the smallest; for a mission with a camera\n"
    "  Each is the best of all heights, centres and radii that keep the margin, to 1 m or 2 % of a pixel; 'bound' of\n"
    "  --json says how good any other one can be at most. Where no circle fits, a racetrack is looked for: two half\n"
    "  circles and two straights.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage orbit mission.yaml --radius 60\n"
    "  vantage orbit mission.yaml --centre over --margin 5\n"
    "  vantage orbit mission.yaml --target roof -o orbit.plan\n"
    "  vantage orbit mission.yaml --centre anywhere --json | jq '.targets[].orbits[0]'\n"
    "\n"
    "The exit code is 1 if a target has no orbit.\n";

struct OrbitArguments {
  CommonOptions common;
  std::string mission_file, target;
  std::string radius, most_radius, margin, clearance;  // as typed; empty: not given
  std::string output_file;
  PlanOutput plan;
  std::string centre = "around";
  bool counterclockwise = false, circles = false, json = false;
};

OrbitOptions orbit_options(const OrbitArguments& arguments, const MissionFile& file) {
  OrbitOptions options;
  if (file.tour && file.tour->vehicle.kind == TourVehicle::Kind::fixed_wing) {
    options.least_radius_m = file.tour->vehicle.turn_radius_m;
  }
  if (file.tour) options.margin_m = file.tour->margin_m;
  if (!arguments.radius.empty()) options.least_radius_m = positive_length_option("--radius", arguments.radius);
  if (!arguments.most_radius.empty()) {
    options.most_radius_m = positive_length_option("--max-radius", arguments.most_radius);
  }
  if (!arguments.margin.empty()) options.margin_m = length_option("--margin", arguments.margin);
  options.centre = arguments.centre == "over"       ? OrbitCentre::over_target
                   : arguments.centre == "anywhere" ? OrbitCentre::anywhere
                                                    : OrbitCentre::around_target;
  options.clockwise = !arguments.counterclockwise;
  options.racetracks = !arguments.circles;
  options.threads = arguments.common.threads;
  return options;
}

void add_aim(TextTable& table, const Orbit& orbit) {
  table.row("  pitch", fixed(orbit.min_pitch_deg, 1) + " to " + fixed(orbit.max_pitch_deg, 1),
            "degrees; -90 is straight down");
  table.row("  distance", fixed(orbit.min_distance_m, 2) + " to " + fixed(orbit.max_distance_m, 2),
            "metres to the target's centre");
  if (orbit.pixel_m) table.row("  pixel", pixel_text(*orbit.pixel_m), "on the target, at most");
  if (orbit.incidence_deg) table.row("  incidence", fixed(*orbit.incidence_deg, 1), "degrees, at most");
  if (orbit.obstacle_distance_m) {
    table.row("  clear by", fixed(*orbit.obstacle_distance_m, 2),
              "metres" + (orbit.obstacle.empty() ? "" : ": " + orbit.obstacle + " is nearest"));
  }
}

std::string bound_text(const Orbit& orbit) {
  if (orbit.straight_m > 0) return "none that was looked for is deeper than " + fixed(orbit.bound, 2);
  switch (orbit.kind) {
    case OrbitKind::widest:
      return "none is wider than " + fixed(orbit.bound, 2);
    case OrbitKind::deepest:
      return "none is deeper than " + fixed(orbit.bound, 2);
    case OrbitKind::finest_pixel:
      return "no pixel is finer than " + pixel_text(orbit.bound);
  }
  return "";
}

void add_orbit_rows(TextTable& table, const Orbit& orbit) {
  table.row(name_of(orbit.kind), fixed(orbit.radius_m, 2),
            std::string("metres radius, ") + (orbit.clockwise ? "clockwise" : "counter-clockwise"));
  if (orbit.straight_m > 0) {
    table.row("  straights", fixed(orbit.straight_m, 2),
              "metres each, heading " + fixed(orbit.heading_deg, 1) + " degrees and back: a racetrack");
  }
  table.row("  margin", fixed(orbit.margin_m, 2), "metres inside the volume; " + bound_text(orbit));
  table.row("  length", fixed(orbit.length_m, 1), "metres once round");
  add_place(table, orbit.place);
  add_aim(table, orbit);
}

std::string text_of_orbits(const std::vector<NamedOrbits>& targets) {
  TextTable table;
  for (const NamedOrbits& target : targets) {
    const Orbits& orbits = target.orbits;
    if (orbits.found.empty()) {
      table.heading("target '" + target.target + "': no orbit: " + orbits.reason);
      continue;
    }
    table.heading("target '" + target.target + "': " + count(orbits.found.size()) +
                  (orbits.found.size() == 1 ? " orbit" : " orbits") + ", at least " + fixed(orbits.margin_m, 2) +
                  " m inside the volume");
    if (!orbits.reason.empty()) table.heading("  " + orbits.reason);
    for (const Orbit& orbit : orbits.found) add_orbit_rows(table, orbit);
  }
  return table.text();
}

std::vector<NamedOrbits> orbits_of(const TargetVolumes& volumes, const OrbitOptions& options,
                                   const Progress& progress) {
  std::vector<NamedOrbits> result;
  std::optional<ViewDescriber> describer;  // what it made of the scene serves all targets
  for (const TargetVolume& target : volumes.targets) {
    NamedOrbits& one = result.emplace_back();
    one.target = target.name;
    if (target.error) {
      one.orbits.reason = target.error->problem();
      continue;
    }
    describer = describer ? ViewDescriber(target.mission, *describer) : ViewDescriber(target.mission);
    one.orbits = find_orbits(target.mission, target.volume, volumes.scene, *describer, options, progress);
    tell_of_volume(target.volume, one.orbits.notes);
  }
  return result;
}

/// An orbit of one target is written.
void check_orbit_output(const OrbitArguments& arguments, const MissionFile& file) {
  if (arguments.output_file.empty()) return;
  check_can_write_like(arguments.output_file, "orbit.plan");
  check_not_an_input(arguments.output_file, input_files(file));
  plan_format_of(arguments.output_file);
  if (file.targets.size() < 2 || file.combine != Combine::each || !arguments.target.empty()) return;
  throw Error(ErrorCode::missing_key, "the mission has several targets, and a plan has the orbit of one",
              "command line, -o", "say which with --target NAME");
}

/// The deepest one: it stays in view wherever the wind pushes, as far as any does.
void write_orbit(const Orbits& orbits, const Mission& mission, const OrbitArguments& arguments) {
  if (orbits.found.empty()) return;
  const auto is_deepest = [](const Orbit& orbit) { return orbit.kind == OrbitKind::deepest; };
  const auto deepest = std::find_if(orbits.found.begin(), orbits.found.end(), is_deepest);
  const Orbit& chosen = deepest == orbits.found.end() ? orbits.found.front() : *deepest;
  const std::string& file = arguments.output_file;
  const PlanFormat format = plan_format_of(file);
  const FlightOut plan = with_output(plan_of_orbit(chosen, mission, format), arguments.plan);
  write_flight_plan(plan, file);
  if (arguments.common.quiet) return;
  for (const std::string& text : plan_notes(plan, format)) note(text);
}

/// Whether the format can state an orbit of the mission: before any is looked for.
void check_orbit_can_be_stated(const Mission& mission, const OrbitArguments& arguments) {
  Orbit any;
  any.centre = mission.home.value_or(Vec3::Zero());
  any.radius_m = 1;
  const PlanFormat format = plan_format_of(arguments.output_file);
  flight_plan_bytes(with_output(plan_of_orbit(any, mission, format), arguments.plan), format);
}

int run_orbit(const OrbitArguments& arguments) {
  MissionFile file = read_mission_argument(arguments.mission_file);
  const OrbitOptions options = orbit_options(arguments, file);
  check_orbit_output(arguments, file);
  keep_clearance(file, arguments.clearance);
  std::vector<NamedOrbits> found;
  {
    ProgressLine progress(arguments.common);
    const TargetVolumes volumes =
        compute_targets(file, arguments.target, arguments.common.threads, progress.callback());
    if (!arguments.output_file.empty()) check_orbit_can_be_stated(volumes.targets.front().mission, arguments);
    found = orbits_of(volumes, options, progress.callback());
    if (!arguments.output_file.empty()) {
      write_orbit(found.front().orbits, volumes.targets.front().mission, arguments);
    }
  }
  print(arguments.json ? json_text(found) : text_of_orbits(found));
  bool has_all = true;
  for (const NamedOrbits& one : found) {
    has_all = has_all && !one.orbits.found.empty();
    if (arguments.common.quiet) continue;
    for (const std::string& text : one.orbits.notes) note((found.size() > 1 ? one.target + ": " : "") + text);
  }
  return has_all ? kSuccess : kCheckFailed;
}

}  // namespace

void add_orbit(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("orbit", "Find where to circle while the target stays in view");
  auto options = std::make_shared<OrbitArguments>();
  command->add_option("mission", options->mission_file, "The mission file; - for standard input")
      ->required()
      ->option_text("MISSION");
  command->add_option("--target", options->target, kTargetHelp)->option_text("NAME");
  command
      ->add_option("--radius", options->radius,
                   "The smallest radius that the vehicle can turn with; default: "
                   "tour.vehicle.turn_radius of a fixed wing, else 40")
      ->option_text("METRES");
  command->add_option("--max-radius", options->most_radius, "The largest radius to look for; default: any")
      ->option_text("METRES");
  command
      ->add_option("--margin", options->margin,
                   "How far from the volume's boundary at least; default: tour.view.margin, else 1 m, less in small "
                   "volumes")
      ->option_text("METRES");
  command->add_option("--clearance", options->clearance, kClearanceHelp)->option_text("METRES");
  command
      ->add_option(
          "-o,--output", options->output_file,
          "Write the deepest orbit as a plan: .plan, .waypoints, .kml, .kmz (DJI), .gpx, .geojson, .csv or .czml")
      ->option_text("FILE");
  add_plan_output(*command, options->plan);
  command
      ->add_option("--centre", options->centre,
                   "around: the target is within the orbit; over: the centre is over the target; anywhere")
      ->check(CLI::IsMember({"around", "over", "anywhere"}))
      ->option_text("WHERE");
  command->add_flag("--counterclockwise", options->counterclockwise, "Circle the other way round, seen from above");
  command->add_flag("--circles", options->circles, "Look for no racetrack where no circle fits");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<OrbitArguments>(*command, options, kOrbitExamples, chosen, run_orbit);
}

}  // namespace vantage::cli
