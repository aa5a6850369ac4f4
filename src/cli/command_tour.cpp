#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flight_picture.h"
#include "cli/picture_options.h"
#include "cli/plan_output.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/mission.h"
#include "vantage/mission_tour.h"

namespace vantage::cli {
namespace {

constexpr const char* kTourExamples =
    "TOUR\n"
    "  The shortest flight that is found through the volumes of all targets, by what 'tour' in the mission says of "
    "the\n"
    "  vehicle, its home, how long and how deep inside it stays, and what distance it keeps from the scene. And a\n"
    "  bound: no flight that sees all targets is shorter. The bound is over outer volumes, which hold every position\n"
    "  from which a target is seen. docs/flight.md says more.\n"
    "\n"
    "  A target may also be a volume to fly through: 'targets: [{volume: region.ply}]', any closed mesh.\n"
    "\n"
    "  With --fewest the flight hovers at as few positions as possible, so that each target is seen whole from one of\n"
    "  them, as deep in its volume as the margin. It says how many positions are necessary, wherever they are, and "
    "which\n"
    "  targets show it: their outer volumes do not meet.\n"
    "\n"
    "  The exit code is 1 where a target is left out. Where the mission has 'tour.gap', it is 4 where the gap between "
    "the\n"
    "  flight and the bound stays larger or, with --fewest, where fewer positions may do. The plan is written all the "
    "same.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage tour mission.yaml\n"
    "  vantage tour mission.yaml -o tour.plan --picture tour.png\n"
    "  vantage tour mission.yaml --fewest -o tour.plan\n"
    "  vantage tour mission.yaml -o tour.kmz --aircraft 77,0,66 --no-bound\n"
    "  vantage tour mission.yaml -o tour.czml --undulation 45.7 --start 2026-06-21T16:00Z\n"
    "  vantage tour mission.yaml -o tour.csv --certificate tour.cert --json > tour.json\n";

struct TourArguments {
  CommonOptions common;
  std::string mission_file, output_file, certificate_file, picture_file;
  PlanOutput plan;
  bool no_bound = false, fewest = false, json = false;
};

constexpr double kPercent = 100;

void add_problems(TextTable& table, const MissionTour& tour) {
  for (const TourProblem& problem : tour.tour.problems) {
    const std::string& name = tour.targets[problem.target].name;
    const std::string in_the_way = problem.obstacle.empty() ? "" : "; in the way: " + problem.obstacle;
    if (problem.kind == TourProblem::Kind::no_place) {
      table.row("left out", name, "no position of its volume may be flown to" + in_the_way);
      continue;
    }
    const std::string from = problem.neighbour ? tour.targets[*problem.neighbour].name : "home";
    table.row("left out", name, std::string("no way was found between it and ").append(from).append(in_the_way));
  }
}

std::string names_of(const MissionTour& tour, const std::vector<std::size_t>& targets) {
  std::string names;
  for (const std::size_t target : targets) names += (names.empty() ? "" : ", ") + tour.targets[target].name;
  return names;
}

std::string why_necessary(const MissionTour& tour) {
  const FewestPositions& found = *tour.fewest;
  switch (found.reason) {
    case FewestPositions::Reason::one:
      return "";
    case FewestPositions::Reason::apart:
      return "no position sees two of these: " + names_of(tour, found.apart);
    case FewestPositions::Reason::groups:
      return count(found.necessary - 1) + " would have to see targets together that no position does";
  }
  return "";
}

void add_positions(TextTable& table, const MissionTour& tour, bool with_bound) {
  const FewestPositions& found = *tour.fewest;
  const std::size_t number = found.positions.size();
  if (with_bound) {
    table.row("necessary", count(found.necessary), why_necessary(tour));
    if (!found.is_proved()) table.row("", "", "fewer than " + count(number) + " may do");
  }
  table.heading("hovers at " + count(number) + (number == 1 ? " position" : " positions"));
  for (std::size_t i = 0; i < number; ++i) {
    const HoverPosition& one = found.positions[i];
    table.row(count(i + 1), fixed(one.depth_m, 1) + " m", "inside, at " + vector(one.position));
    table.row("", "views", names_of(tour, one.assigned));
    if (one.sees.size() > one.assigned.size()) table.row("", "sees", names_of(tour, one.sees));
  }
}

std::string table_text(const MissionTour& tour, bool with_bound) {
  TextTable table;
  table.heading(std::string("tour of a ") +
                (tour.settings.vehicle.kind == TourVehicle::Kind::multirotor ? "multirotor" : "fixed-wing aircraft") +
                ", " + count(tour.tour.order.size()) + " of " + count(tour.targets.size()) + " targets");
  table.row("length", fixed(tour.tour.length_m, 1), "m");
  table.row("time", fixed(tour.tour.time_s, 1), "s");
  if (tour.bound) {
    table.row("bound", fixed(tour.bound->length_m, 1), "m: no tour is shorter; by " + tour.bound->kind);
    table.row("", fixed(tour.bound->time_s, 1), "s: none takes less time");
    if (const auto height = start_above_home_m(tour)) {
      table.row("", fixed(*height, 1), "m above the home: both are of tours that begin there");
    }
    table.row("gap", fixed(kPercent * tour.bound->gap, 2) + " %",
              tour.settings.gap && !tour.reaches_gap()
                  ? "more than the " + fixed(kPercent * *tour.settings.gap, 2) + " % asked for"
                  : "");
    for (const std::string& ignored : tour.bound->ignored) table.row("it ignores", "", ignored);
  }
  if (tour.fewest) add_positions(table, tour, with_bound);
  table.heading("in view");
  for (const TourVisit& visit : tour.tour.visits) {
    table.row(tour.targets[visit.target].name, fixed(visit.dwell_s, 1) + " s",
              fixed(visit.begin_m, 1) + " to " + fixed(visit.end_m, 1) + " m along the flight, " +
                  vector(tour.tour.flight.points[visit.first_point].position));
  }
  add_problems(table, tour);
  return table.text();
}

void check_outputs(const TourArguments& options, const MissionFile& mission) {
  std::vector<std::string> outputs;
  const std::vector<std::pair<std::string, std::string>> named = {
      {options.output_file, "tour.plan"}, {options.certificate_file, "tour.cert"}, {options.picture_file, "tour.png"}};
  for (const auto& [file, example] : named) {
    if (file.empty()) continue;
    check_can_write_like(file, example);
    check_not_an_input(file, input_files(mission));
    const std::string place = std::filesystem::weakly_canonical(file).string();
    if (std::find(outputs.begin(), outputs.end(), place) != outputs.end()) {
      throw Error(ErrorCode::output_named_twice, "an output is named twice", file, "give each a name");
    }
    outputs.push_back(place);
  }
  if (!options.picture_file.empty()) check_picture_file(options.picture_file);
  if (!options.output_file.empty()) plan_format_of(options.output_file);
  if (options.no_bound && !options.certificate_file.empty()) {
    throw Error(ErrorCode::conflicting_keys, "a certificate is of the bound, and --no-bound asks for none",
                "command line, --certificate", "leave out one of them");
  }
  if (options.fewest && !options.certificate_file.empty()) {
    throw Error(ErrorCode::conflicting_keys,
                "a certificate is of the bound of the shortest flight, and --fewest asks for another one",
                "command line, --certificate", "leave out one of them");
  }
}

FlightOut plan_in(const MissionTour& tour, const Mission& mission, const TourArguments& options) {
  return with_output(plan_of_tour(tour, mission, plan_format_of(options.output_file)), options.plan);
}

/// Before anything is computed: whether the format can state a flight of this mission. One straight up shows it.
void check_can_state(const Mission& mission, const TourArguments& options) {
  if (options.output_file.empty()) return;
  MissionTour tour;
  tour.settings = mission.as_written.tour.value_or(TourSettings());
  tour.home = mission.home;
  tour.tour.flight.points.assign(2, {mission.home.value_or(Vec3::Zero())});
  tour.tour.flight.points[1].position.z() += 1;
  flight_plan_bytes(plan_in(tour, mission, options), plan_format_of(options.output_file));
}

/// The flight in the scene, with the volumes of all targets, and its profile: what is seen is as `check` finds it.
void draw_tour(const MissionTour& tour, const Mission& mission, const std::string& file, const Progress& progress) {
  const FlightCheck check = check_flight(mission, tour.tour.flight, {}, progress);
  FlightPicture picture{
      &mission, &tour.tour.flight, &check, {}, "tour of " + count(tour.tour.order.size()) + " targets", ""};
  for (const MissionTourTarget& target : tour.targets) picture.volumes.push_back(&target.volume);
  picture.subtitle = fixed(tour.tour.length_m, 0) + " m, " + fixed(tour.tour.time_s, 0) + " s";
  if (tour.bound) picture.subtitle += "; no tour is shorter than " + fixed(tour.bound->length_m, 0) + " m";
  write_flight_picture(picture, file, progress);
}

int run_tour(const TourArguments& options) {
  MissionFile file = read_mission_argument(options.mission_file);
  check_outputs(options, file);
  if (file.lists_targets()) file.combine = Combine::each;
  ProgressLine progress(options.common);
  const Mission mission = resolve_mission(file, progress.callback());
  check_can_state(mission, options);
  if (!options.picture_file.empty()) check_flight(mission, {{{mission.home.value_or(Vec3::Zero())}}, 0});  // or refuses
  MissionTourOptions asked;
  asked.threads = options.common.threads;
  asked.with_bound = !options.no_bound;
  asked.certificate = options.certificate_file;
  asked.fewest_positions = options.fewest;
  MissionTour tour = plan_mission_tour(mission, asked, progress.callback());
  std::optional<FlightOut> plan;
  if (!options.output_file.empty() && !tour.tour.order.empty()) {
    plan = plan_in(tour, mission, options);
    for (std::string& text : plan_notes(*plan, plan_format_of(options.output_file))) {
      tour.notes.push_back(std::move(text));
    }
  }
  if (!options.common.quiet) {
    notes(mission.notes);
    for (const std::string& text : tour.notes) note(text);
  }
  if (plan) write_flight_plan(*plan, options.output_file);
  if (options.json) {
    print(json_text(tour));
  } else if (!options.common.quiet) {
    print(table_text(tour, !options.no_bound));
  }
  if (!options.picture_file.empty() && !tour.tour.order.empty()) {
    draw_tour(tour, mission, options.picture_file, progress.callback());
  }
  if (!tour.is_complete()) return kCheckFailed;
  const bool is_good = tour.fewest ? tour.fewest->is_proved() : tour.reaches_gap();
  return options.no_bound || !tour.settings.gap || is_good ? kSuccess : kUndecided;
}

}  // namespace

void add_tour(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("tour", "Plan the shortest flight that sees every target, and bound how short one can be");
  auto options = std::make_shared<TourArguments>();
  command->add_option("mission", options->mission_file, "The mission; - for standard input")
      ->required()
      ->option_text("MISSION");
  command
      ->add_option("-o,--output", options->output_file,
                   "Write a plan: .plan, .waypoints, .kml, .kmz (DJI), .gpx, .geojson, .csv or .czml")
      ->option_text("FILE");
  add_plan_output(*command, options->plan);
  command->add_flag("--fewest", options->fewest,
                    "Hover at as few positions as possible, and say how many are necessary; of a multirotor");
  command->add_flag("--no-bound", options->no_bound, "Plan alone: quicker, and no word on how short a flight can be");
  command
      ->add_option("--certificate", options->certificate_file,
                   "Write what proves the bound, for tools/check_tour.py, and the outer volumes beside it")
      ->option_text("FILE");
  command
      ->add_option("--picture", options->picture_file,
                   "Draw the volumes, the flight through them, its profile, and when which target is seen: .png")
      ->option_text("FILE");
  command->add_flag("--json", options->json, "Print the tour as JSON");
  finish<TourArguments>(*command, options, kTourExamples, chosen, run_tour);
}

}  // namespace vantage::cli
