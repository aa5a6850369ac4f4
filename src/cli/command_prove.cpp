#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/judged_volume.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "vantage/error.h"
#include "vantage/input.h"
#include "vantage/json.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr const char* kProveExamples =
    "EXAMPLES\n"
    "  vantage prove mission.yaml volume.ply\n"
    "  vantage prove mission.yaml edited.glb --shrink 1e-5 --json\n"
    "\n"
    "What is proved, and of what: docs/proof.md. 'Not proved' is not 'wrong': wrong has a viewpoint inside the volume\n"
    "and a point of the target between which the scene lies, and both are printed. Limits without a proof are named;\n"
    "'vantage verify' tries points for them. Exit code 0: all is proved. 1: something is wrong. 4: neither.\n";

struct ProveArguments : JudgeArguments {
  double shrink = ProveOptions{}.shrink;
};

std::string table_text(const ProofReport& report, const std::string& file) {
  TextTable table;
  table.heading(file);
  for (const ClaimProof& claim : report.claims) table.row(claim.name, name_of(claim.verdict), claim.text);
  table.row("facets", count(report.far_facets), "facing away from a part of the target, all looked at");
  if (!report.unproved.empty()) {
    table.row("open facets", count(report.unproved.size()),
              fixed(100 * report.unproved_area_share, 4) + " % of the surface");
  }
  table.row("planes", count(report.separations),
            "each with the scene on one side and views of the target on the other");
  if (report.witness) {
    const HiddenView& hidden = *report.witness;
    table.row("hidden from", vector(hidden.viewpoint), "of facet " + count(hidden.facet));
    table.row("hidden point", vector(hidden.target_point), "of the target, behind " + hidden.object);
    table.row("depth", fixed(hidden.depth_m, 6), "metres towards the target it stays so");
  }
  table.row("shrunk by", fixed(1e6 * report.shrink, 3),
            "millionths of the distance: so much smaller is what is proved");
  table.row("margin", fixed(1e9 * report.margin_m, 3), "nanometres: a strip along the target's outline is left out");
  if (report.lift_m > 0) table.row("lift", fixed(report.lift_m, 6), "metres that the target was raised");
  if (report.rounding_m > 0) {
    table.row("rounding", fixed(report.rounding_m, 6), "metres that the file's numbers moved the surface: allowed");
  }
  table.row("time", fixed(report.seconds, 3), "seconds");
  const ProofVerdict verdict = report.verdict();
  table.heading(verdict == ProofVerdict::proved  ? "proved"
                : verdict == ProofVerdict::wrong ? "WRONG: the volume over-claims"
                                                 : "not all is proved, and nothing wrong was found");
  return table.text();
}

/// The targets that must be seen, each whole; of several, all.
std::vector<Target> targets_of(const Mission& mission) {
  if (mission.views.empty()) return {mission.target};
  std::vector<Target> targets;
  for (const std::vector<Target>& list : mission.views) {
    if (list.size() != 1) {
      throw Error(ErrorCode::not_applicable,
                  "the volume is for one of several targets or sides, and only the sight of all can be proved",
                  "targets", "check it with 'vantage verify', or compute one volume for each with 'combine: each'");
    }
    targets.push_back(list[0]);
  }
  return targets;
}

/// What is wrong with the sight of one target is wrong with all.
void join(ProofReport& all, const ProofReport& one) {
  for (std::size_t i = 0; i < all.claims.size(); ++i) {
    if (one.claims[i].verdict > all.claims[i].verdict) all.claims[i] = one.claims[i];
  }
  all.far_facets += one.far_facets;
  all.separations += one.separations;
  all.seconds += one.seconds;
  all.margin_m = std::max(all.margin_m, one.margin_m);
  all.lift_m = std::max(all.lift_m, one.lift_m);
  if (one.unproved_area_share > all.unproved_area_share) {
    all.unproved = one.unproved;
    all.unproved_area_share = one.unproved_area_share;
  }
  if (one.witness && (!all.witness || one.witness->depth_m > all.witness->depth_m)) all.witness = one.witness;
}

ProofReport prove(const Mission& mission, const VolumeFile& read, const ProveArguments& options,
                  const Progress& progress) {
  const VerifyOptions known = verify_options(read, mission);
  std::optional<ProofReport> all;
  std::size_t first = 0;
  for (const Target& target : targets_of(mission)) {
    ProveOptions prove_options{.shrink = options.shrink, .rounding_m = known.rounding_m};
    for (std::size_t i = 0; i < target.parts.size(); ++i) prove_options.lift_m.push_back(known.lift_m[first + i]);
    first += target.parts.size();
    const ProofReport one = prove_volume(mission.loaded.scene, target, mission.sensor, mission.navigation,
                                         read.volume.mesh, prove_options, progress);
    if (all) {
      join(*all, one);
    } else {
      all = one;
    }
  }
  return *all;
}

int run_prove(const ProveArguments& options) {
  ProgressLine progress(options.common);
  const auto [mission, read] = read_judged(options, progress);
  const ProofReport report = prove(mission, read, options, progress.callback());
  if (options.json) {
    print(json_text(report));
  } else if (!options.common.quiet) {
    print(table_text(report, options.volume_file));
  }
  switch (report.verdict()) {
    case ProofVerdict::proved:
      return kSuccess;
    case ProofVerdict::wrong:
      return kCheckFailed;
    case ProofVerdict::not_proved:
      return kUndecided;
  }
  return kUndecided;
}

}  // namespace

void add_prove(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("prove", "Prove that every position of a volume sees the target, or refute it");
  auto options = std::make_shared<ProveArguments>();
  add_judge_options(*command, *options);
  command
      ->add_option("--shrink", options->shrink,
                   "The proof is of the volume smaller by this part of the distance (default 1e-6)")
      ->check(CLI::Range(0.0, 0.1))
      ->option_text("PART");
  finish<ProveArguments>(*command, options, kProveExamples, chosen, run_prove);
}

}  // namespace vantage::cli
