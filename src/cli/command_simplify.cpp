#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/simplify.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

constexpr const char* kSimplifyExamples =
    "EXAMPLES\n"
    "  vantage simplify volume.ply --facets 500 -o small.ply\n"
    "  vantage simplify volume.ply --error 0.5 -o small.glb      # nothing that is lost is farther than 0.5 m off\n"
    "  vantage simplify volume.ply --facets 500 --error 2 -o small.ply && vantage prove mission.yaml small.ply\n"
    "\n"
    "The result is a subset of the volume, exactly, in numbers of double precision (PLY, OBJ): what was proved of a\n"
    "volume that does not pass through itself holds of it. Formats of single precision round, and state by how much:\n"
    "'vantage compute --help' lists them. The file says what it is for, as the volume's does, so that it can be\n"
    "proved, verified and compared.\n"
    "With both --facets and --error it ends where one of them is reached. How it works: docs/simplify.md.\n"
    "\n"
    "Where more facets are left than --facets asks for, the file is written all the same, and the exit code is 1.\n";

struct SimplifyArguments {
  CommonOptions common;
  std::string input, output;
  std::optional<std::size_t> facets;
  std::optional<double> error_m;
  std::string up, scale;  // empty: not given
  bool json = false;
};

SceneReadOptions obj_options(const SimplifyArguments& options) {
  if (!is_obj(options.input) && !is_obj(options.output) && !(options.up.empty() && options.scale.empty())) {
    throw Error(ErrorCode::not_applicable, "--up and --scale are for OBJ files, and none is named", "command line",
                "leave them out: " + scene_frame_names_text() + " are in the scene frame, and glTF is y up");
  }
  SceneReadOptions result;
  if (options.up == "y") result.up = UpAxis::y;
  if (!options.scale.empty()) result.scale = positive_length_option("--scale", options.scale);
  return result;
}

void check_asked(const SimplifyArguments& options) {
  if (options.facets || options.error_m) return;
  throw Error(ErrorCode::nothing_given, "it is not said how far to simplify", "command line",
              "give --facets N, --error METRES, or both");
}

/// What is wrong with the mesh is told of its file.
SimplifiedVolume simplify(const Mesh& mesh, const SimplifyArguments& options, const Progress& progress) {
  try {
    return simplify_volume(mesh, {.facets = options.facets, .error_m = options.error_m}, progress);
  } catch (const Error& error) {
    if (error.where() != "volume") throw;
    throw error.with_where(options.input);
  }
}

std::string table_text(const SimplifyArguments& options, const SimplifiedVolume& s, const WrittenVolume& written) {
  TextTable table;
  table.heading(options.input);
  table.row("facets", count(written.facets), "of " + count(s.facets_before));
  table.row("volume", fixed(s.volume_after_m3, 3),
            "m3, " + fixed(100 * s.volume_after_m3 / s.volume_before_m3, 4) + " % of " + fixed(s.volume_before_m3, 3));
  table.row("lost", fixed(s.lost_measured_m, 6),
            "m at most, between the result and the vertices of the given volume; " + fixed(s.lost_bound_m, 6) +
                " m is the bound for all of its points");
  if (s.pieces > 1 || s.pieces_dropped > 0) {
    table.row("pieces", count(s.pieces), count(s.pieces_dropped) + " small ones were left out");
  }
  if (written.rounding_m > 0) {
    table.row("rounding", fixed(written.rounding_m, 6), "metres that the file's numbers moved the surface");
  }
  if (!s.reached) table.heading("no more facets can go: " + count(*options.facets) + " were asked for");
  table.heading("wrote " + options.output);
  return table.text();
}

int run_simplify(const SimplifyArguments& options) {
  check_asked(options);
  check_readable(options.input, "the volume", "");
  const SceneReadOptions obj = obj_options(options);
  check_volume_output(options.output);
  check_not_an_input(options.output, {options.input});
  ProgressLine progress(options.common);
  VolumeFile read = read_volume(options.input, obj, {}, progress.callback());
  check_volume_place({options.output}, read.volume.georeference, {});
  if (!options.common.quiet) notes(read.notes);
  SimplifiedVolume simplified = simplify(read.volume.mesh, options, progress.callback());
  stop_if_interrupted();
  Volume volume = with_mesh(std::move(read.volume), simplified);
  volume.read_rounding_m = read.rounding_m;
  std::vector<StagedVolume> staged;
  staged.push_back(stage_volume(volume, options.output, obj.up, obj.scale));
  const WrittenVolume written = staged.front().report;
  commit_volumes(std::move(staged));
  if (options.json) {
    print(json_text(simplified, options.input, options.output, written));
  } else if (!options.common.quiet) {
    print(table_text(options, simplified, written));
  }
  return simplified.reached ? kSuccess : kCheckFailed;
}

}  // namespace

void add_simplify(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("simplify", "Give a volume fewer facets, without a point that it did not have");
  auto options = std::make_shared<SimplifyArguments>();
  command
      ->add_option("volume", options->input, "A closed mesh: PLY, OBJ, STL, glTF or GLB; may be compressed with gzip")
      ->required()
      ->option_text("VOLUME");
  command->add_option("-o,--output", options->output, "The result: " + volume_extensions_text())
      ->required()
      ->option_text("FILE");
  command->add_option("--facets", options->facets, "Stop at so many facets; at least 4")->option_text("N");
  command
      ->add_option("--error", options->error_m,
                   "No point of the volume may be farther than this from the result: metres")
      ->transform(to_metres("--error"))
      ->option_text("METRES");
  command->add_option("--up", options->up, "Axis of the OBJ files that points up: y or z (default)")
      ->check(CLI::IsMember({"y", "z"}))
      ->option_text("AXIS");
  command->add_option("--scale", options->scale, "Metres in one unit of the OBJ files (default 1)")->option_text("S");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<SimplifyArguments>(*command, options, kSimplifyExamples, chosen, run_simplify);
}

}  // namespace vantage::cli
