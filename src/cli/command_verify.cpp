#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "vantage/hash.h"
#include "vantage/input.h"
#include "vantage/json.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage verify mission.yaml volume.ply\n"
    "  vantage verify mission.yaml volume.glb --points 200000 --seed 7\n"
    "  vantage verify mission.yaml edited.obj --json    # .obj in the axes and unit of the scene file\n"
    "\n"
    "DEPTHS\n"
    "  The depth of a point is its distance to the volume's surface: how far inside the volume an over-claimed point\n"
    "  lies, how far outside of it an under-claimed one. The worst depth is the greatest that was met, not a bound.\n";

struct Options {
  CommonOptions common;
  std::string mission_file, volume_file;
  std::size_t points = VerifyOptions{}.points;
  std::uint64_t seed = VerifyOptions{}.seed;
  double lift_m = -1;  // below zero: as the report says
  bool json = false;
};

constexpr double kMostLift = 0.01;  // metres; compute raises a target by no more than 2 mm

/// What is known of the volume besides its mesh.
struct Given {
  double lift_m = 0, rounding_m = 0;
};

std::string table_text(const VerifyReport& report, const Given& given, const OpenEdges& holes,
                       const std::string& file) {
  TextTable table;
  table.heading(file);
  table.row("closed", report.closed ? "yes" : "NO",
            holes.count == 0 ? "every edge has two triangles"
                             : count(holes.count) + " open edges, one of them at " + vector(holes.middle_of_first));
  if (report.closed) table.row("oriented", report.oriented ? "yes" : "NO", "which run it in opposite directions");
  table.row("Euler number", std::to_string(report.euler), "2 for one piece without holes");
  if (report.flat_facets > 0) {
    table.row("flat facets", count(report.flat_facets), "without area: programs that join vertices find holes there");
  }
  if (given.lift_m > 0) {
    table.row("lift", fixed(given.lift_m, 6), "metres that the target was raised to clear its surface");
  }
  if (given.rounding_m > 0) {
    table.row("rounding", fixed(given.rounding_m, 6),
              "metres that the file says its numbers moved the surface: allowed");
  }
  if (report.points > 0) {
    table.heading("rays from random points, seed " + std::to_string(report.seed));
    table.row("points tried", count(report.points), "half of them near the volume's surface");
    table.row("inside", count(report.inside), "claimed by the volume");
    table.row("rays", count(report.rays), "");
    table.row("over-claimed", count(report.over_claimed), "claimed, but part of the target is hidden or out of range");
    if (report.over_claimed > 0) {
      table.row("worst depth", fixed(report.worst_over_depth_m, 6),
                "metres inside: from the deepest of them to the volume's surface, at " +
                    vector(report.worst_over_point) + ", because of " + report.worst_over_cause);
    }
    table.row("under-claimed", count(report.under_claimed), "not claimed, though all that was sampled was visible");
    if (report.under_claimed > 0) {
      table.row(
          "worst depth", fixed(report.worst_under_depth_m, 6),
          "metres outside: from the farthest of them to the volume's surface, at " + vector(report.worst_under_point));
    }
    table.row("bound", fixed(100 * report.over_claim_bound, 4) + " %",
              "at most this share of the volume is over-claimed, with 95 % confidence");
    table.row("bound's points", count(report.bound_points),
              "uniform over the volume; the count of over-claims also has points near the surface, which this leaves "
              "out");
  }
  table.heading(report.is_right()
                    ? "nothing wrong was found"
                    : (report.is_solid() ? "WRONG: the volume over-claims" : "WRONG: the mesh is not a closed solid"));
  return table.text();
}

/// How far the target was raised: what the command line says, or else the file, or else the report beside it.
std::vector<double> lifts(const Options& options, const VolumeFile& read, const Mission& mission) {
  const std::size_t parts = mission.target.parts.size();
  if (options.lift_m >= 0) return std::vector(parts, options.lift_m);
  if (read.volume.lift_m.size() == parts) return read.volume.lift_m;
  return std::vector(parts, reported_lift_m(options.volume_file).value_or(0));
}

/// That the file is of another scene or mission, or was changed since.
std::vector<std::string> doubts(const VolumeFile& read, const Mission& mission) {
  std::vector<std::string> sentences;
  if (!read.volume.provenance) return sentences;
  const VolumeProvenance& made = *read.volume.provenance;
  if (!made.scene_hash.empty() && made.scene_hash != scene_hash(mission.loaded.scene)) {
    sentences.emplace_back("the file says that the volume was computed in another scene than the mission's");
  } else if (!made.mission_hash.empty() && made.mission_hash != mission_hash(mission)) {
    sentences.emplace_back("the file says that the volume was computed for another mission");
  }
  return sentences;
}

int run(const Options& options) {
  check_readable(options.volume_file, "the volume");
  const MissionFile file = read_mission_argument(options.mission_file);
  ProgressLine progress(options.common);
  const Mission mission = resolve_mission(file, progress.callback());
  const std::vector<Warning> warnings = mission_warnings(mission);
  const VolumeFile read = read_volume(options.volume_file, mission.loaded.scene, progress.callback());
  if (!options.common.quiet) {
    notes(warnings);
    std::for_each(read.notes.begin(), read.notes.end(), note);
    const std::vector<std::string> other = doubts(read, mission);
    std::for_each(other.begin(), other.end(), note);
  }
  const Mesh& volume = read.volume.mesh;
  const OpenEdges holes = find_open_edges(volume);
  VerifyOptions verify_options;
  verify_options.points = options.points;
  verify_options.seed = options.seed;
  verify_options.tolerance_m = file.exact.tolerance_m;
  verify_options.rounding_m = read.rounding_m;
  verify_options.lift_m = lifts(options, read, mission);
  const Given given{*std::max_element(verify_options.lift_m.begin(), verify_options.lift_m.end()), read.rounding_m};

  VerifyReport report;
  if (holes.count == 0) {
    report = verify_volume(mission.loaded.scene, mission.target, mission.sensor, mission.navigation, volume,
                           verify_options, progress.callback());
  } else {  // a mesh with holes has no inside to try points in
    report.euler = measure(volume).euler;
    report.seed = options.seed;
  }
  if (options.json) {
    print(json_text(report, holes, given.lift_m, given.rounding_m));
  } else if (!options.common.quiet) {
    const std::size_t parts = mission.target.parts.size();
    if (parts > 1) note("the target has " + std::to_string(parts) + " convex parts: all must be seen");
    print(table_text(report, given, holes, options.volume_file));
  }
  return report.is_right() ? kSuccess : kCheckFailed;
}

}  // namespace

void add_verify(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("verify", "Check a volume by ray casting, independently of how it was made");
  auto options = std::make_shared<Options>();
  command
      ->add_option("mission", options->mission_file,
                   "The mission that the volume was computed for; - for standard input")
      ->required()
      ->option_text("MISSION");
  command->add_option("volume", options->volume_file, "The volume: PLY, OBJ, STL or GLB")
      ->required()
      ->option_text("FILE");
  command->add_option("--points", options->points, "Viewpoints to try (default 20000)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{10000000}))
      ->option_text("N");
  command->add_option("--seed", options->seed, "Seed of the random points (default 1)")->option_text("S");
  command
      ->add_option(
          "--lift", options->lift_m,
          "How far compute raised the target (default: as the volume's file or the report beside it says, or 0)")
      ->check(CLI::Range(0.0, kMostLift))
      ->option_text("METRES");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<Options>(*command, options, kExamples, chosen, run);
}

}  // namespace vantage::cli
