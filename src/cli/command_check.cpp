#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/flight_picture.h"
#include "cli/located_plan.h"
#include "cli/picture_options.h"
#include "cli/plan_output.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/mission.h"

namespace vantage::cli {
namespace {

constexpr const char* kCheckExamples =
    "PLAN\n"
    "  A plan of QGroundControl (.plan), .waypoints, KML or KMZ (of DJI, too), GPX, GeoJSON, or a table (CSV) with\n"
    "  lon, lat and a height, or x, y, z. Heights are told apart: above sea level (alt), above ground (agl), above "
    "the\n"
    "  home, above the ellipsoid. What a plan does not say has to be given.\n"
    "\n"
    "FOUND\n"
    "  For each target from where on the flight all of it is seen, within the limits of the sensor, exactly; what\n"
    "  hides it elsewhere; where the links of the mission hold, and what is in their way; which limits of navigation\n"
    "  are broken, where and by how much; how near the flight comes to the scene, but for its ground. The exit code\n"
    "  is 1 where a target is not seen, or not for the dwell, a link is lost anywhere, a limit is broken, the\n"
    "  clearance is not kept, the camera would have to turn too fast, or the flight meets an object, lies inside a\n"
    "  solid or is below the ground. It is 4 where the plan has commands that move the vehicle and cannot be followed\n"
    "  here: they are named. Dwell, clearance, speed and gimbal are those of the mission's 'tour', unless they are\n"
    "  given here.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage check mission.yaml flight.plan\n"
    "  vantage check mission.yaml flight.plan --tube 3 --clearance 8\n"
    "  vantage check mission.yaml track.gpx --undulation 46.5 --json | jq '.targets[].longest'\n"
    "  vantage check mission.yaml flight.kml --speed 8 --dwell 5 -o check.csv --picture check.png\n";

struct CheckArguments : PlanArguments {
  CommonOptions common;
  std::string mission_file, output_file, picture_file;
  std::string tube = "0";
  std::optional<double> speed, dwell, gimbal;
  std::string clearance;  // as typed
  bool json = false;
};

std::string seconds_text(double seconds) { return std::isnan(seconds) ? "?" : fixed(seconds, 1); }

std::string span_text(const FlightSpan& span) {
  std::string text = fixed(span.begin_m, 2) + " to " + fixed(span.end_m, 2) + " m";
  if (!std::isnan(span.end_s)) text += ", " + seconds_text(span.begin_s) + " to " + seconds_text(span.end_s) + " s";
  return text;
}

/// "12 to 20 m, 30 to 34 m and 3 others".
std::string spans_text(const std::vector<FlightSpan>& spans) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, spans.size()); ++i) {
    text += (text.empty() ? "" : "; ") + fixed(spans[i].begin_m, 2) + " to " + fixed(spans[i].end_m, 2) + " m";
  }
  if (spans.size() > kMost) text += "; and " + count(spans.size() - kMost) + " more";
  return text;
}

void add_reasons(TextTable& table, const std::vector<NotSeen>& reasons) {
  for (const NotSeen& reason : reasons) {
    std::string name = name_of(reason.kind);
    std::replace(name.begin(), name.end(), '_', ' ');
    table.row(name, fixed(reason.length_m(), 2) + " m",
              (reason.name.empty() ? "" : reason.name + ": ") + spans_text(reason.spans));
  }
}

void add_target(TextTable& table, const TargetCheck& target) {
  table.heading(target.name);
  const char* const inside = target.is_volume ? "inside" : "seen whole";
  if (target.seen.empty()) table.row(inside, "nowhere", "");
  for (std::size_t i = 0; i < target.seen.size(); ++i) {
    const FlightSpan& span = target.seen[i];
    const bool is_longest = target.longest == i && target.seen.size() > 1;
    table.row(inside, std::isnan(span.end_s) ? fixed(span.length_m(), 2) + " m" : fixed(span.duration_s(), 1) + " s",
              span_text(span) + (is_longest ? ", the longest" : ""));
  }
  if (target.gimbal) {
    table.row("gimbal", fixed(target.gimbal->min_pitch_deg, 1) + " to " + fixed(target.gimbal->max_pitch_deg, 1),
              "degrees of pitch; yaw " + fixed(target.gimbal->begin_yaw_deg, 1) + " to " +
                  fixed(target.gimbal->end_yaw_deg, 1) +
                  (std::isfinite(target.gimbal->rate_deg_s)
                       ? "; turns by up to " + fixed(target.gimbal->rate_deg_s, 1) + " degrees per second"
                       : ""));
  }
  add_reasons(table, target.not_seen);
}

void add_link(TextTable& table, const LinkCheck& link) {
  table.heading("link to " + link.name);
  if (link.holds()) {
    table.row("linked", "everywhere", "");
  } else if (link.linked.empty()) {
    table.row("linked", "nowhere", "");
  } else {
    double length = 0;
    for (const FlightSpan& span : link.linked) length += span.length_m();
    table.row("linked", fixed(length, 2) + " m", spans_text(link.linked));
  }
  table.row("farthest", fixed(link.farthest_m, 2) + " m",
            "at " + fixed(link.farthest_at_m, 2) + " m along the flight" +
                (link.max_range_m ? "; its range is " + fixed(*link.max_range_m, 2) + " m" : ""));
  add_reasons(table, link.reasons);
}

const char* verdict(const FlightCheck& check) {
  if (!check.not_judged.empty()) return "is NOT judged as a whole";
  return check.passes() ? "keeps what is asked" : "does NOT keep what is asked";
}

std::string table_text(const FlightCheck& check, const std::string& plan) {
  TextTable table;
  table.heading(plan);
  table.row("length", fixed(check.length_m, 1), "m");
  table.row("duration", seconds_text(check.duration_s),
            std::isnan(check.duration_s) ? "the plan does not say how fast it is flown: give --speed"
                                         : "s, at full speed also round corners");
  if (check.tube_radius_m > 0) {
    table.row("tube", fixed(check.tube_radius_m, 2), "m: all holds for every position so near to the flight");
  }
  for (const TargetCheck& target : check.targets) add_target(table, target);
  for (const LinkCheck& link : check.links) add_link(table, link);
  table.heading("limits");
  if (check.broken.empty()) table.row("broken", "none", "");
  for (const BrokenLimit& limit : check.broken) {
    table.row(limit.name, std::isfinite(limit.worst) ? fixed(limit.worst, 2) + " " + limit.unit : "broken",
              "at " + fixed(limit.worst_at_m, 2) + " m; " + spans_text(limit.spans));
  }
  if (std::isfinite(check.nearest.distance_m)) {
    table.row("nearest", fixed(check.nearest.distance_m, 2) + " m",
              (check.nearest.object.empty() ? "the scene" : check.nearest.object) + ", at " +
                  fixed(check.nearest.at_m, 2) + " m along the flight, " + vector(check.nearest.position));
  }
  table.heading("the flight " + std::string(verdict(check)));
  for (const std::string& what : check.not_judged) table.row("not judged", "", what);
  for (const std::string& failure : check.failures) table.row("fails", "", failure);
  return table.text();
}

FlightCheckOptions check_options(const CheckArguments& options) {
  FlightCheckOptions result;
  result.tube_radius_m = length_option("--tube", options.tube);
  result.speed_m_s = options.speed;
  result.dwell_s = options.dwell;
  result.gimbal_rate_deg_s = options.gimbal;
  if (!options.clearance.empty()) result.clearance_m = length_option("--clearance", options.clearance);
  return result;
}

std::string plan_name(const CheckArguments& options) {
  return options.plan_file == "-" ? "flight" : std::filesystem::path(options.plan_file).filename().string();
}

bool is_json_file(const std::string& file) { return file.ends_with(".json"); }

void check_output(const CheckArguments& options, const MissionFile& mission) {
  if (!options.picture_file.empty()) {
    check_picture_file(options.picture_file);
    check_not_an_input(options.picture_file, input_files(mission));
    check_not_an_input(options.picture_file, {options.plan_file});
  }
  if (options.output_file.empty()) return;
  if (!is_json_file(options.output_file) && !options.output_file.ends_with(".csv")) {
    throw Error(ErrorCode::output_format_unknown, "a check is written as .json or .csv", options.output_file,
                "give a name that ends so");
  }
  check_can_write_like(options.output_file, "check.json");
  check_not_an_input(options.output_file, input_files(mission));
  check_not_an_input(options.output_file, {options.plan_file});
}

int run_check(const CheckArguments& options) {
  const FlightCheckOptions asked = check_options(options);
  MissionFile file = read_mission_argument(options.mission_file);
  check_output(options, file);
  if (file.lists_targets()) file.combine = Combine::each;
  ProgressLine progress(options.common);
  const FlightPlan plan = read_plan_argument(options, progress.callback());
  const Mission mission = resolve_mission(file, progress.callback());
  const LocatedPlan located = locate_plan_argument(options, plan, mission, progress.callback());
  FlightCheck check = check_flight(mission, located.flight, asked, progress.callback());
  for (const auto* of_plan : {&plan.notes, &located.notes}) {
    for (const Warning& one : *of_plan) check.notes.push_back(one.text);
  }
  if (!options.common.quiet) {
    for (const std::string& text : check.notes) note(text);
  }
  const Georeference* georeference = mission.scene().georeference ? &*mission.scene().georeference : nullptr;
  if (!options.output_file.empty()) {
    AtomicFile written(options.output_file);
    written.write(is_json_file(options.output_file) ? json_text(check, georeference) : csv_text(check));
    written.commit();
  }
  if (options.json) {
    print(json_text(check, georeference));
  } else if (!options.common.quiet) {
    print(table_text(check, options.plan_file));
  }
  if (!options.picture_file.empty()) {
    const FlightPicture picture{&mission, &located.flight, &check, {}, plan_name(options), verdict(check)};
    write_flight_picture(picture, options.picture_file, progress.callback());
  }
  if (!check.not_judged.empty()) return kUndecided;
  return check.passes() ? kSuccess : kCheckFailed;
}

}  // namespace

void add_check(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "check", "Judge any plan of a flight: when is what seen, which limits are broken, how near is what");
  auto options = std::make_shared<CheckArguments>();
  command->add_option("mission", options->mission_file, "The mission; - for standard input")
      ->required()
      ->option_text("MISSION");
  add_plan_options(*command, *options);
  command->add_option("--tube", options->tube, "All must hold for every position within this distance of the flight")
      ->option_text("METRES");
  command->add_option("--speed", options->speed, "Of legs for which the plan states none, metres per second")
      ->option_text("M/S");
  command->add_option("--dwell", options->dwell, "Each target must be seen for so long without a break")
      ->option_text("SECONDS");
  command->add_option("--clearance", options->clearance, "Smallest distance from the scene, but for its ground")
      ->option_text("METRES");
  command->add_option("--gimbal-rate", options->gimbal, "The camera turns at most so fast, degrees per second")
      ->option_text("DEG/S");
  command->add_option("-o,--output", options->output_file, "Write what was found as .json or .csv")
      ->option_text("FILE");
  command
      ->add_option("--picture", options->picture_file,
                   "Draw the flight in the scene, its profile, and when which target is seen: .png")
      ->option_text("FILE");
  command->add_flag("--json", options->json, "Print what was found as JSON");
  finish<CheckArguments>(*command, options, kCheckExamples, chosen, run_check);
}

}  // namespace vantage::cli
