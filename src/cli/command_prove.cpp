#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/judged_volume.h"
#include "cli/picture_options.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/picture.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr const char* kProveExamples =
    "EXAMPLES\n"
    "  vantage prove mission.yaml volume.ply\n"
    "  vantage prove mission.yaml edited.glb --shrink 1e-5 --json\n"
    "  vantage prove mission.yaml volume.ply --maximal\n"
    "  vantage prove mission.yaml decimated.ply --picture open.png --view 'oblique 330,35'\n"
    "  vantage prove mission.yaml volume.ply --certificate volume.cert && python3 tools/check_certificate.py "
    "volume.cert\n"
    "\n"
    "What is proved, and of what: docs/proof.md. 'Not proved' is not 'wrong': wrong has a viewpoint inside the volume\n"
    "and a point of the target between which the scene lies, or a place that breaks a limit. Limits without a proof\n"
    "are named; 'vantage verify' tries points for them. Exit code 0: all is proved. 1: something is wrong. 4:\n"
    "neither. What --maximal finds does not change it: a volume that is too small is right.\n";

struct ProveArguments : JudgeArguments {
  double shrink = ProveOptions{}.shrink;
  bool maximal = false;
  std::string certificate, picture;  ///< files; empty: not wanted
  std::string view, size;            ///< of the picture; empty: the usual ones
};

const char* meaning_of(WitnessKind kind) {
  switch (kind) {
    case WitnessKind::none:
      return "no witness was found";
    case WitnessKind::navigation:
      return "the limit is broken beyond";
    case WitnessKind::sensor:
      return "the limit is broken beyond, to what docs/proof.md allows";
    case WitnessKind::range:
      return "a corner of the target is out of range";
    case WitnessKind::hidden:
      return "one flat piece of the scene hides something from all of the facet";
    case WitnessKind::hidden_in_pieces:
      return "different pieces of the scene do from its parts";
    case WitnessKind::edge_on:
      return "lines from the target's centre do not pass through";
    case WitnessKind::target_plane:
      return "in the target's plane: nothing is beyond";
  }
  return "";
}

/// What is proved is rounded down, and what is open up: 100 % is all, and 0 % nothing.
std::string proved_percent(double share) { return fixed(std::floor(1e6 * share) / 1e4, 4) + " %"; }
std::string open_percent(double share) { return fixed(std::ceil(1e6 * share) / 1e4, 4) + " %"; }

const char* meaning_of_share(const MaximalProof& proof) {
  if (!proof.conditions_hold()) return "of the surface; a piece that is missing as a whole is not noticed";
  if (!proof.open.empty()) return "of the surface; beyond the open facets something may be missing";
  return "of the surface: nothing is missing";
}

void add_maximal(const MaximalProof& proof, TextTable& table) {
  table.heading("is anything missing beyond the surface?");
  for (const MaximalProof::Row& row : proof.rows) {
    const std::string name = row.limit.empty() ? std::string(name_of(row.kind)) : row.limit;
    const bool is_open = row.kind == WitnessKind::none;
    table.row(name, is_open ? open_percent(row.area_share) : proved_percent(row.area_share), meaning_of(row.kind));
  }
  for (const MaximalCondition& condition : proof.conditions) {
    table.row("condition", condition.holds ? "holds" : "does not hold", condition.text);
  }
  for (const std::string& name : proof.sampled) {
    table.row(name, "sampled", "no facet can have it as a witness: 'vantage verify' tries points");
  }
  table.row("moved out by", fixed(1e6 * proof.grow, 3), "millionths of the distance");
  table.row("range", fixed(proof.range_m, 3), "metres: less the tolerance, " + fixed(proof.tolerance_m, 4));
  if (proof.point_radius_m > 0) {
    table.row("ball", fixed(1e3 * proof.point_radius_m, 3), "millimetres about the point that must be seen");
  }
  if (!proof.open.empty()) table.row("open facets", count(proof.open.size()), "--json lists them");
  table.row("time", fixed(proof.seconds, 3), "seconds of those below");
  table.row("maximal", proved_percent(proof.proved_share), meaning_of_share(proof));
}

std::string table_text(const ProofReport& report, const std::string& file, bool asks_maximal) {
  TextTable table;
  table.heading(file);
  for (const ClaimProof& claim : report.claims) table.row(claim.name, name_of(claim.verdict), claim.text);
  table.row("facets", count(report.tested_facets), "that a line of sight can leave the volume by, all looked at");
  if (!report.unproved.empty()) {
    table.row("open facets", count(report.unproved.size()),
              open_percent(report.unproved_area_share) + " of the surface");
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
  if (report.layer_m > 0) {
    table.row("layer", fixed(report.layer_m, 9), "metres below the surface are left out, for what is rounded");
  }
  if (report.claims.size() > 3) {
    table.row("tolerance", fixed(1e6 * report.limit_tolerance_m, 3), "micrometres that a limit may be broken by");
  }
  if (report.maximal) add_maximal(*report.maximal, table);
  if (asks_maximal && !report.maximal) table.row("maximal", "none", "not of a volume for both sides of a target");
  table.row("time", fixed(report.seconds, 3), "seconds");
  const ProofVerdict verdict = report.verdict();
  if (!report.scene_incomplete.empty()) table.heading(report.scene_incomplete);
  table.heading(verdict == ProofVerdict::proved  ? "proved for the scene as built"
                : verdict == ProofVerdict::wrong ? "WRONG: the volume over-claims"
                                                 : "not all is proved, and nothing wrong was found");
  return table.text();
}

/// What is wrong with the mesh is told of its file.
ProofReport prove(const JudgedVolume& judged, const ProveArguments& options, const Progress& progress) {
  const VerifyOptions known = verify_options(judged.read, judged.mission);
  const ProveOptions asked{.shrink = options.shrink,
                           .rounding_m = known.rounding_m,
                           .lift_m = known.lift_m,
                           .maximal = options.maximal,
                           .tolerance_m = known.tolerance_m,
                           .certificate = !options.certificate.empty()};
  try {
    return prove_volume(judged.mission, judged.read.volume.mesh, asked, progress);
  } catch (const Error& error) {
    if (error.where() != "volume") throw;
    throw error.with_where(options.volume_file);
  }
}

/// Whether there is one. Where there is none that is told, whoever reads the rest.
bool save_certificate(const JudgedVolume& judged, const ProofReport& report, const std::string& file) {
  if (report.certificate) {
    write_certificate(*report.certificate, judged.mission, judged.read, file);
    return true;
  }
  note("no certificate is written: sight, range and front must be proved, and nothing may be wrong");
  std::error_code error;
  if (std::filesystem::exists(file, error)) note(file + " is of an earlier run and was left as it was");
  return false;
}

/// The view and the size, as they were asked for.
PictureRequest picture_request(const ProveArguments& options) {
  const char* const unused = !options.view.empty() ? "--view" : !options.size.empty() ? "--size" : nullptr;
  if (options.picture.empty() && unused) {
    throw Error(ErrorCode::not_applicable, std::string(unused) + " is for a picture, and none is asked for",
                "command line, " + std::string(unused), "add --picture FILE.png, or leave it out");
  }
  PictureRequest request;
  if (!options.view.empty()) request.view = parse_view({options.view});
  if (!options.size.empty()) {
    const std::array<int, 2> size = parse_size(options.size);
    request.width = size[0];
    request.height = size[1];
  }
  if (!options.picture.empty()) check_picture_file(options.picture);
  return request;
}

/// The volume with its open facets.
void draw(PictureRequest request, const JudgedVolume& judged, const ProofReport& report, const std::string& file,
          const Progress& progress) {
  const Mission& mission = judged.mission;
  request.target = &mission.target;
  request.volume = &judged.read.volume;
  request.navigation = mission.navigation;
  request.marks = {{"not proved to see the target", report.unproved}};
  if (report.maximal) request.marks.push_back({"more may be seen beyond", report.maximal->open});
  request.title = mission.target.name;
  request.subtitle =
      std::string(name_of(report.verdict())) + ", of all but a part of " + shortest(report.shrink) + " of the distance";
  write_png(render_picture(mission.scene(), request, progress), file, progress);
}

void check_outputs(const JudgedVolume& judged, const ProveArguments& options) {
  std::vector<std::filesystem::path> inputs = input_files(judged.mission.as_written);
  inputs.emplace_back(options.volume_file);
  if (!options.certificate.empty()) {
    check_certifiable(judged.mission);
    check_certificate_files(options.certificate, options.volume_file, inputs);
  }
  if (!options.picture.empty()) check_not_an_input(options.picture, inputs);
}

int run_prove(const ProveArguments& options) {
  PictureRequest request = picture_request(options);
  ProgressLine progress(options.common);
  const JudgedVolume judged = read_judged(options, progress);
  check_outputs(judged, options);
  const ProofReport report = prove(judged, options, progress.callback());
  const bool is_certified = !options.certificate.empty() && save_certificate(judged, report, options.certificate);
  std::string saved;
  if (is_certified) {
    saved = "wrote " + options.certificate + "\nwrote " + certificate_scene_file(options.certificate).string() + "\n";
  }
  if (!options.picture.empty()) {
    draw(std::move(request), judged, report, options.picture, progress.callback());
    saved += "wrote " + options.picture + "\n";
  }
  if (options.json) {
    print(json_text(report, is_certified ? options.certificate : ""));
  } else if (!options.common.quiet) {
    print(table_text(report, options.volume_file, options.maximal) + saved);
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
  command->add_flag("--maximal", options->maximal, "Tell also by what part of the surface nothing can be missing");
  command
      ->add_option("--certificate", options->certificate,
                   "Write what tools/check_certificate.py needs to check the proof, and FILE's scene beside it")
      ->option_text("FILE");
  command
      ->add_option("--picture", options->picture,
                   "Draw the volume as a PNG: facets that are not proved are red, those without a witness yellow")
      ->option_text("FILE");
  command
      ->add_option("--view", options->view,
                   "Of the --picture: 'top', 'oblique A,E' or 'from X,Y,Z', as of vantage render; in one word")
      ->option_text("VIEW");
  command->add_option("--size", options->size, "Of the --picture, in pixels (1600x1200)")->option_text("WxH");
  finish<ProveArguments>(*command, options, kProveExamples, chosen, run_prove);
}

}  // namespace vantage::cli
