#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/judged_volume.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr const char* kVerifyExamples =
    "EXAMPLES\n"
    "  vantage verify mission.yaml volume.ply\n"
    "  vantage verify mission.yaml volume.glb --points 200000 --seed 7\n"
    "  vantage verify mission.yaml edited.obj --json    # .obj in the axes and unit of the scene file\n"
    "\n"
    "First of all the volume is proved, where it can be (docs/proof.md); 'vantage prove' tells more of it. Then "
    "points\n"
    "are tried at random: also for what has no proof, and for what is missing of the volume. The exit code is 1 where\n"
    "one of the two finds something wrong. What the rays forgive is forgiven the proof, too: what lies lower than 1 "
    "mm\n"
    "over the target, and a limit that is broken by less than a millionth of the distance.\n"
    "\n"
    "DEPTHS\n"
    "  The depth of a point is its distance to the volume's surface: how far inside the volume an over-claimed point\n"
    "  lies, how far outside of it an under-claimed one. The worst depth is the greatest that was met, not a bound.\n";

struct VerifyArguments : JudgeArguments {
  std::size_t points = VerifyOptions{}.points;
  std::uint64_t seed = VerifyOptions{}.seed;
  double lift_m = -1;  // below zero: as the report says
};

constexpr double kMostLift = 0.01;  // metres; compute raises a target by no more than 2 mm

/// What comes first, less what the rays forgive; or why there is none.
struct Proof {
  std::optional<ProofReport> report;
  std::string why_not;

  bool is_wrong() const { return report && report->verdict() == ProofVerdict::wrong; }
};

Proof prove_first(const JudgedVolume& judged, const VerifyOptions& options, const Progress& progress) {
  const ProveOptions asked{.rounding_m = options.rounding_m, .lift_m = options.lift_m};
  try {
    const ProofReport report = prove_volume(judged.mission, judged.read.volume.mesh, asked, progress);
    return {with_verify_tolerances(report, judged.mission, options), ""};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    return {std::nullopt, error.problem()};
  }
}

void add_proof(TextTable& table, const Proof& proof) {
  if (!proof.report) {
    table.row("proof", "none", proof.why_not);
    return;
  }
  table.heading("proof, of all but a part of " + shortest(proof.report->shrink) + " of the distance");
  for (const ClaimProof& claim : proof.report->claims) table.row(claim.name, name_of(claim.verdict), claim.text);
}

const char* conclusion_of(const VerifyReport& report, const Proof& proof) {
  if (!report.is_solid()) return "WRONG: the mesh is not a closed solid";
  if (proof.is_wrong() || report.over_claimed > 0) return "WRONG: the volume over-claims";
  return report.is_right() ? "nothing wrong was found" : "NOT CHECKED: no point that was tried lies inside the volume";
}

std::string table_text(const VerifyReport& report, const Proof& proof, const std::string& file) {
  const OpenEdges& holes = report.open_edges;
  TextTable table;
  table.heading(file);
  table.row("closed", report.closed ? "yes" : "NO",
            holes.count == 0 ? "every edge has two triangles"
                             : count(holes.count) + " open edges, one of them at " + vector(holes.middle_of_first));
  if (report.closed) table.row("oriented", report.oriented ? "yes" : "NO", "which run it in opposite directions");
  table.row("Euler number", std::to_string(report.euler), "2 for one piece without holes");
  if (report.flat_facets > 0) {
    table.row("flat facets", count(report.flat_facets),
              "without area, which is not wrong: programs that join vertices find holes there");
  }
  if (report.lift_m > 0) {
    table.row("lift", fixed(report.lift_m, 6), "metres that the target was raised to clear its surface");
  }
  if (report.rounding_m > 0) {
    table.row("rounding", fixed(report.rounding_m, 6),
              "metres that the file says its numbers moved the surface: allowed");
  }
  add_proof(table, proof);
  if (report.points > 0) {
    table.heading("rays from random points, seed " + std::to_string(report.seed));
    table.row("points tried", count(report.points), "half of them near the volume's surface");
    table.row("inside", count(report.inside), "claimed by the volume");
    table.row("rays", count(report.rays), "");
    if (report.undecided > 0) {
      table.row("undecided", count(report.undecided), "so close to the edge of the picture that no search tells");
    }
    table.row("over-claimed", count(report.over_claimed),
              "claimed, but part of the target is hidden or a limit is broken");
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
    if (report.share_unclaimed) {
      table.row("share unclaimed", count(*report.share_unclaimed),
                "not claimed, though enough of the target is seen: lost to its cells");
    }
    table.row("bound", fixed(100 * report.over_claim_bound, 4) + " %",
              "at most this share of the volume is over-claimed, with 95 % confidence");
    table.row("bound's points", count(report.bound_points),
              "spread evenly over the volume: the bound counts these alone, not those near the surface");
  }
  table.heading(conclusion_of(report, proof));
  return table.text();
}

/// What must be seen of several targets.
std::string needed_text(const std::vector<std::vector<Target>>& views) {
  std::size_t targets = 0;
  for (const std::vector<Target>& list : views) targets += list.size();
  if (views.size() == 1) return "one of " + std::to_string(targets) + " targets or sides must be seen";
  return std::to_string(views.size()) + " targets must be seen, each from one of its sides or more";
}

int run_verify(const VerifyArguments& options) {
  ProgressLine progress(options.common);
  const JudgedVolume judged = read_judged(options, progress);
  const auto& [mission, read] = judged;
  VerifyOptions verify_options = vantage::verify_options(read, mission);
  verify_options.points = options.points;
  verify_options.seed = options.seed;
  if (options.lift_m >= 0) verify_options.lift_m.assign(verify_options.lift_m.size(), options.lift_m);
  const Proof proof = prove_first(judged, verify_options, progress.callback());
  const VerifyReport report = verify_volume(mission, read.volume.mesh, verify_options, progress.callback());
  if (options.json) {
    print(json_text(report, proof.report ? &*proof.report : nullptr));
  } else if (!options.common.quiet) {
    const std::size_t parts = mission.target.parts.size();
    if (!mission.views.empty()) {
      note(needed_text(mission.views));
    } else if (parts > 1) {
      note("the target has " + std::to_string(parts) + " convex parts: all must be seen");
    }
    print(table_text(report, proof, options.volume_file));
  }
  return report.is_right() && !proof.is_wrong() ? kSuccess : kCheckFailed;
}

}  // namespace

void add_verify(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("verify", "Check a volume by a proof and by ray casting, independently of how it was made");
  auto options = std::make_shared<VerifyArguments>();
  add_judge_options(*command, *options);
  command->add_option("--points", options->points, "Viewpoints to try (default 20000)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{10000000}))
      ->option_text("N");
  command->add_option("--seed", options->seed, "Seed of the random points (default 1)")->option_text("S");
  command
      ->add_option(
          "--lift", options->lift_m,
          "How far compute raised the target (default: as the volume's file or the report beside it says, or 0)")
      ->check(CLI::Range(0.0, kMostLift))
      ->transform(to_metres("--lift"))
      ->option_text("METRES");
  finish<VerifyArguments>(*command, options, kVerifyExamples, chosen, run_verify);
}

}  // namespace vantage::cli
