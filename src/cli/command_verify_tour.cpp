#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "vantage/mission_tour.h"

namespace vantage::cli {
namespace {

constexpr const char* kVerifyTourExamples =
    "VERDICT\n"
    "  Whether the certificate of a tour proves its bound: that no flight that visits all of its regions is shorter.\n"
    "  Reads the certificate and the meshes beside it that it names, and nothing else; believes no number of what "
    "found\n"
    "  the bound, and rounds nothing. tools/check_tour.py is a second program for the same. Exit code 0: accepted. 1:\n"
    "  refused, and why.\n"
    "\n"
    "  The certificate does not say how long the tour is: --length tells the gap between it and the bound.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage verify-tour tour.cert\n"
    "  vantage verify-tour tour.cert --length 412.5\n"
    "  vantage verify-tour tour.cert --json | jq .bound_m\n";

struct VerifyTourArguments {
  CommonOptions common;
  std::string certificate, length;  // as typed; empty: not given
  bool json = false;
};

constexpr double kInPercent = 100;

void add_regions(TextTable& table, const TourCertificateCheck& check) {
  for (const TourCertificateRegion& region : check.regions) {
    table.row(name_of(region.kind), region.name,
              region.dwell_m > 0 ? fixed(region.dwell_m, 1) + " m in it, for it alone" : "");
  }
}

std::string table_text(const TourCertificateCheck& check, const VerifyTourArguments& options,
                       const std::optional<double>& length) {
  TextTable table;
  if (!check.is_accepted) {
    table.heading(options.certificate + ": refused: " + check.reason);
    if (check.proved_m) table.row("proved", fixed(*check.proved_m, 3), "m");
    return table.text();
  }
  table.heading(options.certificate + ": accepted");
  if (!check.scene_incomplete.empty()) table.heading(check.scene_incomplete);
  table.row("bound", fixed(check.bound_m, 3),
            std::string("m: no ") + (check.closed ? "closed" : "open") + " tour of these regions is shorter");
  if (check.turn_radius_m > 0) {
    table.row("turns", fixed(check.turn_radius_m, 1), "m: the radius of the track over ground, or more");
  }
  table.row("proof", check.kind, count(check.nodes) + " nodes");
  if (length) {
    table.row("tour", fixed(*length, 3), "m, as --length says");
    if (*length < check.bound_m) {
      table.row("gap", "none", "no tour of these regions is so short");
    } else {
      table.row("gap", fixed(kInPercent * (*length - check.bound_m) / *length, 2) + " %", "of it, at most");
    }
  }
  table.heading("regions");
  add_regions(table, check);
  table.heading("it ignores");
  for (const char* ignored : {"obstacles, and zones to stay out of",
                              check.turn_radius_m > 0 ? "climbing and speed" : "turning, climbing and speed",
                              "a margin inside the regions"}) {
    table.row("", "", ignored);
  }
  return table.text();
}

int run_verify_tour(const VerifyTourArguments& options) {
  std::optional<double> length;
  if (!options.length.empty()) length = positive_length_option("--length", options.length);
  ProgressLine progress(options.common);
  const TourCertificateCheck check = verify_tour_certificate(options.certificate, progress.callback());
  if (options.json) {
    print(json_text(check));
  } else if (!options.common.quiet) {
    print(table_text(check, options, length));
  }
  return check.is_accepted ? kSuccess : kCheckFailed;
}

}  // namespace

void add_verify_tour(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("verify-tour", "Judge the bound of a tour by its certificate alone");
  auto options = std::make_shared<VerifyTourArguments>();
  command->add_option("certificate", options->certificate, "What vantage tour --certificate wrote")
      ->required()
      ->option_text("CERTIFICATE");
  command->add_option("--length", options->length, "Of a tour: tells the gap between it and the bound")
      ->option_text("METRES");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<VerifyTourArguments>(*command, options, kVerifyTourExamples, chosen, run_verify_tour);
}

}  // namespace vantage::cli
