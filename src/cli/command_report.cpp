#include <memory>

#include "cli/command.h"
#include "cli/page_file.h"
#include "cli/progress_line.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/output.h"
#include "live/report_page.h"
#include "live/session.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::cli {
namespace {

constexpr const char* kReportExamples =
    "EXAMPLES\n"
    "  vantage report mission.yaml -o report.html\n"
    "  vantage report mission.yaml --volume volume.ply -o report.html    # of a volume that is there already\n"
    "  vantage report mission.yaml --no-proof -o report.html\n"
    "\n"
    "The report is one file: scene, volume, numbers, what bounds the volume, and the verdict of the proof. It opens "
    "in\n"
    "any browser with WebGL and asks no other host for anything: docs/view.md. It is written whatever the proof "
    "says.\n"
    "Exit code 0: all is proved, or no proof was asked for, or there is none. 1: something is wrong. 4: neither.\n";

struct ReportArguments {
  CommonOptions common;
  std::string mission, volume, page, output;
  bool no_proof = false;
};

/// Says what the proof says, where that is not that all is proved. Returns the exit code.
int judge(live::Session& session, const Progress& progress) {
  if (const Volume& volume = session.result()->volume; volume.outcome != Outcome::computed) {
    note("there is no volume: " + volume.reason + "; " + volume.hint);
    return kSuccess;
  }
  try {
    session.prove(progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    note("there is no proof: " + error.problem());
    return kSuccess;
  }
  const ProofReport& report = *session.proof();
  if (report.verdict() == ProofVerdict::proved) return kSuccess;
  for (const ClaimProof& claim : report.claims) {
    if (claim.verdict != ProofVerdict::proved) note(claim.name + ": " + name_of(claim.verdict) + ": " + claim.text);
  }
  return report.verdict() == ProofVerdict::wrong ? kCheckFailed : kUndecided;
}

int run_report(const ReportArguments& options) {
  if (options.mission == "-") {
    throw Error(ErrorCode::stdin_not_possible, "the mission must be a file: the report holds its text", "command line",
                "write it to a file first");
  }
  check_can_write(options.output);
  std::vector<std::filesystem::path> inputs = input_files(read_mission(options.mission));
  if (!options.volume.empty()) {
    check_readable(options.volume, "the volume");
    inputs.emplace_back(options.volume);
  }
  if (!options.page.empty()) inputs.emplace_back(options.page);
  check_not_an_input(options.output, inputs);
  const std::string page = read_page("report.html", options.page);
  int verdict = kSuccess;
  {
    ProgressLine progress(options.common);
    live::Session session;
    session.open_file(options.mission, progress.callback());
    if (options.volume.empty()) {
      session.run(progress.callback());
    } else {
      session.show_volume(options.volume, progress.callback());
    }
    if (!options.common.quiet) notes(session.result()->volume.notes);
    if (!options.no_proof) verdict = judge(session, progress.callback());
    write_whole_file(options.output, live::report_page(session, page, !options.no_proof, progress.callback()));
  }
  if (!options.common.quiet) print("wrote " + options.output + "\n");
  return verdict;
}

}  // namespace

void add_report(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("report", "Write a page with the scene and the volume, to look at anywhere");
  auto options = std::make_shared<ReportArguments>();
  command->add_option("mission", options->mission, "The mission file")->required()->option_text("MISSION");
  command->add_option("-o,--output", options->output, "The page to write")->required()->option_text("FILE (required)");
  command->add_option("--volume", options->volume, "Show this volume of the mission, instead of computing it")
      ->option_text("FILE");
  command->add_flag("--no-proof", options->no_proof, "Do not prove the volume, which takes longer than computing it");
  command->add_option("--page", options->page, "The empty page, where it is not installed: web/dist/report.html")
      ->option_text("FILE");
  finish(*command, options, kReportExamples, chosen, run_report);
}

}  // namespace vantage::cli
