#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCompareExamples =
    "FRAMES\n"
    "  PLY and STL files are in the scene frame: metres, z up. glTF is y up. An OBJ that vantage wrote says its axes\n"
    "  and unit itself; of any other say them with --up and --scale. --only-a and --only-b write likewise.\n"
    "  Where both say where on the earth they lie, B is moved into the frame of A, and so is all that is told of it.\n"
    "\n"
    "EXAMPLES\n"
    "  vantage compare spheres.ply exact.ply\n"
    "  vantage compare edited.obj new.ply --up y         # edited.obj has y up, and does not say so\n"
    "  vantage compare spheres.ply exact.ply --only-a over_claimed.ply --only-b missed.ply\n"
    "  vantage compare a.ply b.glb --json | jq .only_a_percent\n"
    "\n"
    "The worst distance of A is the largest distance from a point of A to the nearest point of B (one-sided Hausdorff\n"
    "distance): that of a point that was found, and a bound that no point exceeds.\n"
    "Where one of them claims nothing alone no mesh is written, and an older file stays. The exit code does not\n"
    "depend on how much they differ.\n";

struct CompareArguments {
  CommonOptions common;
  std::string file_a, file_b, only_a, only_b;
  std::string up, scale;  // empty: not given
  bool json = false;
};

/// How OBJ files are read and written.
SceneReadOptions obj_options(const CompareArguments& options) {
  const std::array<const std::string*, 4> files = {&options.file_a, &options.file_b, &options.only_a, &options.only_b};
  const bool has_obj = std::any_of(files.begin(), files.end(), [](const auto* f) { return is_obj(*f); });
  if (!has_obj && !(options.up.empty() && options.scale.empty())) {
    throw Error(ErrorCode::not_applicable, "--up and --scale are for OBJ files, and none is named", "command line",
                "leave them out: " + scene_frame_names_text() + " are in the scene frame, and glTF is y up");
  }
  SceneReadOptions result;
  if (options.up == "y") result.up = UpAxis::y;
  if (!options.scale.empty()) result.scale = positive_length_option("--scale", options.scale);
  return result;
}

std::vector<fs::path> asked_outputs(const CompareArguments& options) {
  std::vector<fs::path> outputs;
  for (const std::string& output : {options.only_a, options.only_b}) {
    if (!output.empty()) outputs.emplace_back(output);
  }
  return outputs;
}

void check_compare_outputs(const CompareArguments& options) {
  for (const fs::path& output : asked_outputs(options)) {
    check_volume_output(output);
    check_not_an_input(output, {options.file_a, options.file_b});
  }
  if (!options.only_a.empty() &&
      fs::path(options.only_a).lexically_normal() == fs::path(options.only_b).lexically_normal()) {
    throw Error(ErrorCode::output_named_twice, "an output is named twice", options.only_a,
                "give --only-a and --only-b two names");
  }
}

/// Both or none; returns the files that were written.
std::vector<std::string> write(const CompareArguments& options, Comparison& comparison,
                               const std::optional<Georeference>& place, const SceneReadOptions& obj) {
  std::vector<StagedVolume> volumes;
  std::vector<std::string> written;
  const auto stage = [&](const std::string& output, Mesh& mesh, const std::string& input) {
    if (output.empty() || mesh.empty()) return;
    Volume volume = volume_of_mesh(std::move(mesh), "only in " + fs::path(input).filename().string());
    volume.georeference = place;
    volumes.push_back(stage_volume(volume, output, obj.up, obj.scale));
    written.push_back(output);
  };
  stage(options.only_a, comparison.only_a, options.file_a);
  stage(options.only_b, comparison.only_b, options.file_b);
  commit_volumes(std::move(volumes));
  return written;
}

double percent(double part, double whole) { return 100 * part / whole; }

std::string share_text(double part, double whole, const char* of) {
  return "m3, " + fixed(percent(part, whole), 4) + " % of " + of;
}

void add_difference(TextTable& table, const char* name, double volume, double whole, double worst, double bound,
                    const Vec3& at) {
  const std::string of = std::string(name).substr(std::string(name).size() - 1);
  table.row(name, fixed(volume, 3), share_text(volume, whole, of.c_str()));
  if (worst > 0) {
    table.row("worst distance", fixed(worst, 6),
              "m from the other, at " + vector(at) + "; none is over " + fixed(bound, 6));
  }
}

std::string table_text(const CompareArguments& options, const Comparison& c, const std::vector<std::string>& written,
                       bool is_turn_doubtful) {
  TextTable table;
  table.heading("A: " + options.file_a);
  table.heading("B: " + options.file_b);
  table.row("volume of A", fixed(c.volume_a_m3, 3), "m3");
  table.row("volume of B", fixed(c.volume_b_m3, 3), "m3");
  table.row("in both", fixed(c.intersection_m3, 3),
            "m3, " + fixed(percent(c.intersection_m3, c.volume_a_m3), 4) + " % of A, " +
                fixed(percent(c.intersection_m3, c.volume_b_m3), 4) + " % of B");
  add_difference(table, "only in A", c.only_a_m3, c.volume_a_m3, c.worst_only_a_m, c.worst_only_a_bound_m,
                 c.worst_only_a_point);
  add_difference(table, "only in B", c.only_b_m3, c.volume_b_m3, c.worst_only_b_m, c.worst_only_b_bound_m,
                 c.worst_only_b_point);
  if (is_turn_doubtful) table.heading("they share little: is an OBJ file y up, or not in metres? --up y, --scale S");
  for (const std::string& file : written) table.heading("wrote " + file);
  for (const auto& [output, name] : {std::pair(options.only_a, "A"), std::pair(options.only_b, "B")}) {
    if (output.empty() || std::find(written.begin(), written.end(), output) != written.end()) continue;
    table.heading("not written: " + output + ", as " + name + " claims nothing alone");
  }
  return table.text();
}

int run_compare(const CompareArguments& options) {
  check_readable(options.file_a, "the first mesh", "");
  check_readable(options.file_b, "the second mesh", "");
  const SceneReadOptions obj = obj_options(options);
  check_compare_outputs(options);
  ProgressLine progress(options.common);
  const VolumeFile a = read_volume(options.file_a, obj, {}, progress.callback());
  const VolumeFile b = read_volume(options.file_b, obj, a.volume.georeference, progress.callback());
  const auto& place = a.volume.georeference ? a.volume.georeference : b.volume.georeference;
  check_volume_place(asked_outputs(options), place, {});
  if (!options.common.quiet) {
    notes(a.notes);
    notes(b.notes);
  }
  Comparison comparison =
      compare_volumes(a.volume.mesh, b.volume.mesh, options.file_a, options.file_b, progress.callback());
  stop_if_interrupted();
  const std::vector<std::string> written = write(options, comparison, place, obj);
  const bool is_turn_doubtful =
      (is_obj(options.file_a) || is_obj(options.file_b)) && options.up.empty() &&
      comparison.intersection_m3 < 0.5 * std::min(comparison.volume_a_m3, comparison.volume_b_m3);
  if (options.json) {
    print(json_text(comparison, options.file_a, options.file_b, written));
  } else if (!options.common.quiet) {
    print(table_text(options, comparison, written, is_turn_doubtful));
  }
  return kSuccess;
}

}  // namespace

void add_compare(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("compare", "Measure the difference between two closed volumes");
  auto options = std::make_shared<CompareArguments>();
  command->add_option("a", options->file_a, "A closed mesh: PLY, OBJ, STL, glTF or GLB; may be compressed with gzip")
      ->required()
      ->option_text("A");
  command->add_option("b", options->file_b, "Another")->required()->option_text("B");
  command->add_option("--only-a", options->only_a, "Write what only A claims: " + volume_extensions_text())
      ->option_text("FILE");
  command->add_option("--only-b", options->only_b, "Write what only B claims")->option_text("FILE");
  command->add_option("--up", options->up, "Axis of the OBJ files that points up: y or z (default)")
      ->check(CLI::IsMember({"y", "z"}))
      ->option_text("AXIS");
  command->add_option("--scale", options->scale, "Metres in one unit of the OBJ files (default 1)")->option_text("S");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<CompareArguments>(*command, options, kCompareExamples, chosen, run_compare);
}

}  // namespace vantage::cli
