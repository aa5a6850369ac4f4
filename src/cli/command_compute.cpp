#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "cli/command.h"
#include "cli/output_check.h"
#include "cli/progress_line.h"
#include "cli/stage_folder.h"
#include "cli/text_table.h"
#include "mission/run_mission.h"
#include "solid/names.h"
#include "solid/result_files.h"
#include "solid/writers.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;
using mission_io::MissionRun;

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage compute mission.yaml -o volume.ply\n"
    "  vantage compute mission.yaml -o volume.ply -o volume.glb -o volume.obj\n"
    "  vantage compute mission.yaml -o volume.stl --json | jq .volume_m3\n"
    "  vantage compute mission.yaml --method spheres -o volume.ply --stages stages/\n"
    "\n"
    "The format follows the extension: .ply (scene frame, double precision, causes), .obj (axes and unit of the\n"
    "scene file, a group per cause), .stl (scene frame), .glb (y up, a material per kind of cause). Beside each\n"
    "output goes a report, volume.report.json. Where there is no volume, the report says why, no mesh is written,\n"
    "and the exit code is 0.\n"
    "\n"
    "--stages writes each step of the spheres method as a mesh (PLY, scene frame), and stages.json. The folder is put\n"
    "in place as a whole when the run is over; an older one of the same kind is replaced.\n";

constexpr std::size_t kCausesShown = 10;

struct Options {
  CommonOptions common;
  std::string mission_file;
  std::vector<std::string> outputs;
  std::string method, device;  // empty: as the mission says
  std::string stages;          // empty: none are wanted
  bool json = false;
};

/// All that can be known to go wrong with the outputs before anything is computed.
void check_outputs(const Options& options) {
  std::set<fs::path> seen;
  for (const std::string& output : options.outputs) {
    check_volume_output(output);
    check_can_write(solid::report_file(output));
    if (!seen.insert(fs::path(output).lexically_normal()).second) {
      throw Error(ErrorKind::input, "an output is named twice", output, "give each -o a name of its own");
    }
  }
}

/// What the command line says goes before what the mission says.
Mission with_options(const Mission& read, const Options& options) {
  Mission mission = read;
  mission.exact.threads = options.common.threads;
  if (!options.method.empty()) mission.method = options.method == "spheres" ? Method::spheres : Method::exact;
  if (!options.device.empty()) mission.spheres.device = parse_device_choice(options.device);
  if (mission.method == Method::spheres) return mission;
  const char* const unused = !options.stages.empty() ? "--stages" : !options.device.empty() ? "--device" : nullptr;
  if (unused) {
    throw Error(ErrorKind::input, std::string(unused) + " is for the method of spheres, and this mission's is exact",
                "command line, " + std::string(unused), "add --method spheres, or leave it out");
  }
  return mission;
}

solid::WrittenResults write(const Options& options, const Mission& mission, MissionRun& run, const Progress& progress) {
  solid::ResultRequest request;
  request.volumes.assign(options.outputs.begin(), options.outputs.end());
  request.obj_up = run.loaded.scene.up;
  request.obj_scale = run.loaded.scene.scale;
  request.source.mission = mission.file.string();
  request.source.scene = mission.scene.file.string();
  request.source.target = mission.target.name;
  if (run.spheres) request.source.spheres = solid::SpheresRun{mission.spheres, *run.spheres};
  return solid::write_results(run.volume, request, progress);
}

/// The largest causes, and how many more there are.
void add_causes(TextTable& table, const Volume& volume) {
  std::vector<const Cause*> causes;
  double total = 0;
  for (const Cause& cause : volume.causes) {
    causes.push_back(&cause);
    total += cause.area_m2;
  }
  std::stable_sort(causes.begin(), causes.end(),
                   [](const Cause* a, const Cause* b) { return a->area_m2 > b->area_m2; });
  table.heading("what bounds it, by area in square metres");
  const std::size_t shown = std::min(causes.size(), kCausesShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string share = total > 0 ? fixed(100 * causes[i]->area_m2 / total, 1) + " %, " : "";
    table.row(causes[i]->name, fixed(causes[i]->area_m2, 1), share + solid::name_of(causes[i]->kind));
  }
  if (shown < causes.size()) table.row("and " + count(causes.size() - shown) + " more", "", "all are in the report");
}

void add_spheres(TextTable& table, const SpheresReport& report) {
  table.heading("visibility spheres, " + report.device.name);
  if (!report.device_note.empty()) table.heading("  " + report.device_note);
  table.row("spheres", count(report.spheres), "of the target's vertices, and of midpoints of its edges");
  table.row("pairs", count(report.pairs), report.pairs == 0 ? "not looked at: no edge was to be halved by them" : "");
  table.row("splits", count(report.splits), "edges halved");
  table.row("unresolved", count(report.unresolved_pairs), "pairs still no topological sphere where halving had to end");
}

std::string summary(const Mission& mission, const MissionRun& run, const MeshMeasures& measures) {
  const Volume& volume = run.volume;
  const Seconds& seconds = volume.seconds;
  TextTable table;
  table.heading("target '" + mission.target.name + "', range " + fixed(mission.sensor.max_range_m, 1) + " m");
  if (volume.outcome == Outcome::computed) {
    table.row("volume", fixed(measures.volume_m3, 1), "cubic metres");
    table.row("area", fixed(measures.area_m2, 1), "square metres");
    table.row("pieces", count(measures.pieces), "");
    table.row("facets", count(measures.facets), count(measures.vertices) + " vertices");
    table.row("tolerance", fixed(volume.tolerance_m, 4), "metres that range facets may lie inside the true sphere");
    add_causes(table, volume);
  } else {
    table.heading("no volume: " + volume.reason);
    if (!volume.hint.empty()) table.heading("what to try: " + volume.hint);
  }
  if (run.spheres) add_spheres(table, *run.spheres);
  table.heading("time");
  table.row("read", duration(seconds.read), "");
  table.row("prepare", duration(seconds.prepare), count(run.scene.polygons) + " convex polygons");
  if (run.spheres) {
    table.row("engine", duration(seconds.engine),
              duration(run.spheres->render_seconds) + " for spheres, " + duration(run.spheres->boolean_seconds) +
                  " for intersections");
  } else {
    table.row("engine", duration(seconds.engine), count(volume.counts.visible_blockers) + " blockers in sight");
  }
  table.row("navigation", duration(seconds.navigation), "");
  table.row("write", duration(seconds.write), "");
  table.row("total", duration(seconds.total), "");
  return table.text();
}

/// STL has single precision only: with map coordinates that may be far less than what was computed.
void warn_of_coarse_stl(const Options& options, const Volume& volume) {
  const double rounding = solid::single_precision_rounding(volume.mesh);
  if (options.common.quiet || volume.outcome != Outcome::computed || rounding <= volume.tolerance_m) return;
  for (const std::string& output : options.outputs) {
    if (format_extension(output) != ".stl") continue;
    note(output + ": STL holds coordinates as large as these to " + fixed(rounding, 3) +
         " m only, less than the tolerance of " + fixed(volume.tolerance_m, 3) +
         " m; write .ply, .obj or .glb for more");
  }
}

int run(const Options& options) {
  check_outputs(options);
  const Mission read = read_mission(options.mission_file);
  for (const std::string& output : options.outputs) {
    check_not_an_input(output, input_files(read));
    check_not_an_input(solid::report_file(output), input_files(read));
  }
  Mission mission = with_options(read, options);
  std::optional<StageFolder> stages;
  if (!options.stages.empty()) stages.emplace(options.stages);

  MissionRun run;
  solid::WrittenResults written;
  {
    ProgressLine progress(options.common);
    run = mission_io::run_mission(mission, progress.callback(), stages ? stages->sink() : StageSink());
    if (stages) stages->write_story(mission, run.volume, *run.spheres);
    written = write(options, mission, run, progress.callback());
    if (stages) stages->commit();
  }
  if (options.json) {
    print(written.report);
  } else if (!options.common.quiet) {
    std::string text = summary(mission, run, written.measures);
    if (run.volume.outcome == Outcome::computed) {
      for (const std::string& output : options.outputs) text += "wrote " + output + "\n";
    }
    for (const fs::path& report : written.reports) text += "wrote " + report.string() + "\n";
    if (stages) text += "wrote " + (fs::path(options.stages) / "stages.json").string() + " and its meshes\n";
    print(text);
  }
  if (!options.common.quiet) std::for_each(run.volume.notes.begin(), run.volume.notes.end(), note);
  warn_of_coarse_stl(options, run.volume);
  if (run.volume.outcome != Outcome::computed) {
    note("no volume: " + run.volume.reason);
    for (const std::string& output : options.outputs) {
      std::error_code error;
      note(fs::exists(output, error) ? output + " is of an earlier run and was left as it was"
                                     : output + " was not written");
    }
  }
  return kSuccess;
}

}  // namespace

void add_compute(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("compute", "Compute the visibility volume of a mission and write it");
  auto options = std::make_shared<Options>();
  command->add_option("mission", options->mission_file, "The mission file")->required()->option_text("MISSION");
  command->add_option("-o,--output", options->outputs, "Where to write: .ply, .obj, .stl or .glb; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE");
  command->add_option("--method", options->method, "exact or spheres; default: as the mission says")
      ->check(CLI::IsMember({"exact", "spheres"}))
      ->option_text("METHOD");
  command
      ->add_option("--device", options->device,
                   "Of the method of spheres: auto, cpu, opengl, gpu or a number of 'vantage devices'")
      ->option_text("DEVICE");
  command->add_option("--stages", options->stages, "Of the method of spheres: write its steps to this folder")
      ->option_text("FOLDER");
  command->add_flag("--json", options->json, "Print the report instead of a summary");
  finish<Options>(*command, options, kExamples, chosen, run);
}

}  // namespace vantage::cli
