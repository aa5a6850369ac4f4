#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/standard_streams.h"
#include "cli/text_table.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/output.h"
#include "common/stages.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kComputeExamples[] = {
    "EXAMPLES\n"
    "  vantage compute mission.yaml -o volume.ply\n"
    "  vantage compute mission.yaml -o volume.ply -o volume.glb -o volume.obj\n"
    "  vantage compute mission.yaml -o volume.tiles/\n"
    "  vantage compute mission.yaml -o volume.ply --prove\n"
    "  vantage compute mission.yaml -o volume.stl --json | jq .volume_m3\n"
    "  vantage compute mission.yaml -o volume.kml\n"
    "  vantage compute mission.yaml --method spheres -o volume.ply --stages stages/\n"
    "  make_mission | vantage compute - -o - --format ply > volume.ply\n"
    "\n"
    "The format follows the extension:\n",
    "\n"
    "Beside each output goes a report, volume.report.json. Where there is no volume, the report says why, no mesh is\n"
    "written, and the exit code is 1.\n"
    "\n"
    "With -o - the volume goes to standard output, when it is whole, and the summary to standard error; the report of\n"
    "that output is written only with --report.\n"
    "\n"
    "A mission with 'combine: each' writes a volume for each target, NAME.TARGET.ply for -o NAME.ply, and\n"
    "NAME.table.csv beside them with a row for each. A file of such a name that vantage did not write is never\n"
    "replaced, and nor is one in the place of a report.\n"
    "\n"
    "--stages writes each step of the spheres method as a mesh (PLY, scene frame), and stages.json. The folder is put\n"
    "in place as a whole when the run is over; an older one of the same kind is replaced.\n"
    "\n"
    "--prove proves the mesh as it was computed, before it is written. A PLY file keeps its numbers; single "
    "precision,\n"
    "and OBJ in another unit, round them, and a note says by how much: 'vantage prove' judges the file. With\n"
    "'combine: each' all volumes must be proved, or none is written.\n"};

/// With a line for each format.
std::string compute_examples() {
  std::string text = kComputeExamples[0];
  for (const FormatFacts& format : known_formats()) {
    text.append("  ").append(format.extension).append("  ").append(format.is_single ? "single" : "double");
    text.append(" precision, ").append(format.holds).append("\n");
  }
  for (const FormatFacts& format : folder_formats()) {
    text.append("  ").append(format.extension).append("  single precision, ").append(format.holds).append("\n");
  }
  return text + kComputeExamples[1];
}

constexpr std::size_t kCausesListed = 10, kCausesInLine = 3;

struct ComputeArguments {
  CommonOptions common;
  std::string mission_file;
  std::vector<std::string> outputs;
  std::string method, device;  // empty: as the mission says
  std::string stages;          // empty: none are wanted
  std::string format, report;  // of what goes to standard output; empty: not given
  bool json = false, verbose = false, prove = false;

  /// The outputs but for standard output.
  std::vector<fs::path> files() const {
    std::vector<fs::path> files;
    std::copy_if(outputs.begin(), outputs.end(), std::back_inserter(files), std::not_fn(is_standard_stream));
    return files;
  }
  bool is_to_stdout() const { return std::any_of(outputs.begin(), outputs.end(), is_standard_stream); }
};

[[noreturn]] void fail_option(ErrorCode code, const std::string& problem, const std::string& option,
                              const std::string& fix) {
  throw Error(code, problem, "command line, " + option, fix);
}

/// All that can be known to go wrong with the outputs before anything is computed.
void check_compute_outputs(const ComputeArguments& options) {
  check_result_files(options.files(), {});
  if (options.outputs.size() > options.files().size() + 1) {
    fail_option(ErrorCode::output_named_twice, "standard output is named twice", "-o -", "leave one out");
  }
  if (!options.is_to_stdout()) {
    if (!options.format.empty())
      fail_option(ErrorCode::not_applicable, "--format is for -o -", "--format", "name a file with that extension");
    if (!options.report.empty()) {
      fail_option(ErrorCode::not_applicable, "--report is for -o -", "--report",
                  "leave it out: a report is written beside each file");
    }
    return;
  }
  if (options.format.empty()) {
    fail_option(ErrorCode::missing_key, "-o - does not say in which format", "-o -",
                "add --format " + format_words_text());
  }
  if (options.json) {
    fail_option(ErrorCode::conflicting_keys, "-o - and --json both want standard output", "--json",
                "write the report to a file with --report");
  }
  if (!options.report.empty()) check_can_write(options.report);
}

/// The command line overrides what the mission says.
MissionFile with_options(MissionFile mission, const ComputeArguments& options) {
  if (!options.method.empty()) mission.method = options.method == "spheres" ? Method::spheres : Method::exact;
  if (!options.device.empty()) mission.spheres.device = parse_device_choice(options.device);
  if (mission.method == Method::spheres) return mission;
  const char* const unused = !options.stages.empty() ? "--stages" : !options.device.empty() ? "--device" : nullptr;
  if (unused) {
    throw Error(ErrorCode::not_applicable,
                std::string(unused) + " is for the method of spheres, and this mission's is exact",
                "command line, " + std::string(unused), "add --method spheres, or leave it out");
  }
  return mission;
}

std::vector<const Cause*> by_area(const Volume& volume) {
  std::vector<const Cause*> causes;
  for (const Cause& cause : volume.causes) causes.push_back(&cause);
  std::stable_sort(causes.begin(), causes.end(),
                   [](const Cause* a, const Cause* b) { return a->area_m2 > b->area_m2; });
  return causes;
}

double total_area(const Volume& volume) {
  double total = 0;
  for (const Cause& cause : volume.causes) total += cause.area_m2;
  return total;
}

/// The largest causes in one line, with their shares of the surface.
std::string main_causes(const Volume& volume) {
  const std::vector<const Cause*> causes = by_area(volume);
  const double total = total_area(volume);
  std::string text;
  for (std::size_t i = 0; i < std::min(causes.size(), kCausesInLine) && total > 0; ++i) {
    text += (i > 0 ? ", " : "") + causes[i]->name + " " + fixed(100 * causes[i]->area_m2 / total, 0) + " %";
  }
  return causes.size() > kCausesInLine ? text + ", and " + count(causes.size() - kCausesInLine) + " more" : text;
}

/// The largest causes, and how many more there are.
void add_causes(TextTable& table, const Volume& volume) {
  const std::vector<const Cause*> causes = by_area(volume);
  const double total = total_area(volume);
  table.heading("what bounds it, by area in square metres");
  const std::size_t shown = std::min(causes.size(), kCausesListed);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string share = total > 0 ? fixed(100 * causes[i]->area_m2 / total, 1) + " %, " : "";
    table.row(causes[i]->name, fixed(causes[i]->area_m2, 1), share + name_of(causes[i]->kind));
  }
  if (shown < causes.size()) table.row("and " + count(causes.size() - shown) + " more", "", "all are in the report");
}

void add_spheres(TextTable& table, const SpheresReport& report) {
  table.heading("visibility spheres");
  table.row("spheres", count(report.spheres), "of the target's vertices, and of midpoints of its edges");
  table.row("pairs", count(report.pairs), report.pairs == 0 ? "not looked at: no edge was to be halved by them" : "");
  table.row("splits", count(report.splits), "edges halved");
  table.row("unresolved", count(report.unresolved_pairs), "pairs still no topological sphere where halving had to end");
}

/// How much the exact engine raised the target; 0 for none.
void add_lift(TextTable& table, const Volume& volume) {
  double lift_m = 0;
  for (const double of_part : volume.lift_m) lift_m = std::max(lift_m, of_part);
  if (lift_m > 0) {
    table.row("lift", fixed(1e3 * lift_m, 3), "mm that the target was raised to clear the surface it lies on");
  }
}

/// What everyone wants to know, in five lines: target, volume, mesh, causes, time. And the lift where there is one.
void add_essentials(TextTable& table, const Mission& mission, const Result& run, const MeshMeasures& measures) {
  const Volume& volume = run.volume;
  table.heading("target '" + mission.target.name + "', range " + fixed(range_limit_m(mission.sensor), 1) + " m" +
                (run.spheres ? ", visibility spheres, " + run.spheres->device.name : ""));
  if (run.spheres && !run.spheres->device_note.empty()) table.heading("  " + run.spheres->device_note);
  if (volume.outcome == Outcome::computed) {
    table.row("volume", fixed(measures.volume_m3, 1), "cubic metres");
    table.row("mesh", count(measures.facets),
              "facets, " + count(measures.pieces) + (measures.pieces == 1 ? " piece" : " pieces"));
    table.row("bounded by", "", main_causes(volume));
    add_lift(table, volume);
  } else {
    table.heading("no volume: " + volume.reason);
    if (!volume.hint.empty()) table.heading("what to try: " + volume.hint);
  }
  table.row("time", duration(volume.seconds.total), "");
}

void add_times(TextTable& table, const Result& run) {
  const Seconds& seconds = run.volume.seconds;
  table.heading("time");
  table.row("start", duration(loading_seconds()), "loading the program and its libraries");
  table.row("read", duration(seconds.read), "");
  table.row("prepare", duration(seconds.prepare), count(run.scene.polygons) + " convex polygons");
  if (run.spheres) {
    table.row("engine", duration(seconds.engine),
              duration(run.spheres->render_seconds) + " for spheres, " + duration(run.spheres->boolean_seconds) +
                  " for intersections");
  } else {
    table.row("engine", duration(seconds.engine), count(run.volume.counts.visible_blockers) + " blockers in sight");
  }
  table.row("navigation", duration(seconds.navigation), "");
  table.row("write", duration(seconds.write), "");
  table.row("total", duration(seconds.total), "");
}

std::string summary(const Mission& mission, const Result& run, const MeshMeasures& measures, bool verbose) {
  TextTable table;
  add_essentials(table, mission, run, measures);
  if (!verbose) return table.text();
  if (run.volume.outcome == Outcome::computed) {
    table.heading("mesh");
    table.row("area", fixed(measures.area_m2, 1), "square metres");
    table.row("vertices", count(measures.vertices), "");
    table.row("tolerance", fixed(run.volume.tolerance_m, 4), "metres that range facets may lie inside the true sphere");
    add_causes(table, run.volume);
  }
  if (run.spheres) add_spheres(table, *run.spheres);
  add_times(table, run);
  return table.text();
}

/// Some formats have single precision only: with map coordinates that may be far less than what was computed.
void warn_of_rounding(const ComputeArguments& options, const Volume& volume, const WrittenResults& written) {
  if (options.common.quiet) return;
  for (std::size_t i = 0; i < written.written.size(); ++i) {
    const double rounding = written.written[i].rounding_m;
    if (rounding <= volume.tolerance_m) continue;
    note(options.outputs[i] + ": rounding to single precision moved the surface by up to " + fixed(rounding, 3) +
         " m, more than the tolerance of " + fixed(volume.tolerance_m, 3) + " m; write " + double_extensions_text() +
         " for more");
  }
}

/// All that is written but standard output, and what people are told of it.
std::string list_of_files(const ComputeArguments& options, const Result& run, const WrittenResults& written) {
  std::string text;
  for (const std::string& output : options.outputs) {
    if (run.volume.outcome == Outcome::computed && !is_standard_stream(output)) text += "wrote " + output + "\n";
  }
  for (const fs::path& report : written.reports) text += "wrote " + report.string() + "\n";
  if (!options.report.empty()) text += "wrote " + options.report + "\n";
  if (!options.stages.empty()) {
    text += "wrote " + (fs::path(options.stages) / "stages.json").string() + " and its meshes\n";
  }
  return text;
}

/// Notes which files were not written, and whether standard output was not.
void tell_of_unwritten(const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    std::error_code error;
    note(!is_standard_stream(output) && fs::exists(output, error)
             ? output + " is of an earlier run and was left as it was"
             : (is_standard_stream(output) ? "standard output" : output) + " was not written");
  }
}

/// `target`: its name where there are several, else empty.
void tell_of_no_volume(const std::string& target, const std::vector<std::string>& outputs, const Volume& volume) {
  note((target.empty() ? "no volume: " : "no volume of " + target + ": ") + volume.reason);
  if (!volume.hint.empty()) note("what to try: " + volume.hint);
  tell_of_unwritten(outputs);
}

void tell_of_heights(const ComputeArguments& options, const std::optional<Georeference>& georeference) {
  if (options.common.quiet) return;
  for (const std::string& output : options.outputs) {
    if (const std::string text = height_note(georeference, output); !text.empty()) note(text);
  }
}

/// What was proved is the mesh before its numbers were rounded for a file.
void tell_of_unproved_rounding(const ComputeArguments& options, const std::vector<std::string>& outputs,
                               const WrittenResults& written) {
  if (!options.prove || options.common.quiet) return;
  for (std::size_t i = 0; i < written.written.size(); ++i) {
    const double rounding = written.written[i].rounding_m;
    if (!(rounding > 0)) continue;
    note((is_standard_stream(outputs[i]) ? "standard output" : outputs[i]) +
         ": what is proved is the mesh before its numbers were rounded, by up to " + shortest(rounding) +
         " m; 'vantage prove' judges the file");
  }
}

/// Standard output holds the report, or the volume, or the summary.
void tell(const ComputeArguments& options, const Mission& mission, const Result& run, const WrittenResults& written,
          const OutgoingFile* outgoing) {
  const bool has_volume = run.volume.outcome == Outcome::computed;
  if (options.json) {
    print(written.report);
  } else if (!options.common.quiet) {
    const std::string text =
        summary(mission, run, written.measures, options.verbose) + list_of_files(options, run, written);
    if (outgoing) {
      std::fputs(text.c_str(), stderr);
    } else {
      print(text);
    }
  }
  if (!options.common.quiet) notes(run.volume.notes);
  warn_of_rounding(options, run.volume, written);
  tell_of_unproved_rounding(options, options.outputs, written);
  if (has_volume) tell_of_heights(options, run.volume.georeference);
  if (!has_volume) tell_of_no_volume({}, options.outputs, run.volume);
  if (outgoing && has_volume) outgoing->send();
}

/// What a mission with a volume for each target cannot be combined with.
void check_each(const ComputeArguments& options) {
  const char* const unused = options.is_to_stdout()    ? "-o -"
                             : !options.stages.empty() ? "--stages"
                             : options.json            ? "--json"
                                                       : nullptr;
  if (!unused) return;
  fail_option(ErrorCode::not_applicable,
              std::string(unused) + " is for one volume, and the mission asks for each target's", unused,
              "leave it out, or write 'combine: all' or 'combine: any' in the mission");
}

std::string summary_of_each(const std::vector<TableRow>& rows) {
  TextTable table;
  table.heading(count(rows.size()) + (rows.size() == 1 ? " volume" : " volumes, one for each target"));
  for (const TableRow& row : rows) {
    const bool has_volume = row.volume->outcome == Outcome::computed;
    table.row(row.target, has_volume ? fixed(row.measures->volume_m3, 1) : "none",
              has_volume ? "cubic metres" : row.volume->reason);
  }
  return table.text();
}

/// Those that all targets have once, the others with the names of the targets that they are about.
std::vector<Warning> warnings_of_each(const std::vector<TableRow>& rows) {
  std::vector<Warning> result;
  std::vector<std::string> targets;
  for (const TableRow& row : rows) {
    for (const Warning& warning : row.volume->notes) {
      const auto known = std::find(result.begin(), result.end(), warning);
      if (known == result.end()) {
        result.push_back(warning);
        targets.push_back(row.target);
      } else {
        targets[static_cast<std::size_t>(known - result.begin())] += ", " + row.target;
      }
    }
  }
  std::string all;
  for (const TableRow& row : rows) all += (all.empty() ? "" : ", ") + row.target;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (targets[i] != all) result[i].text = targets[i] + ": " + result[i].text;
  }
  return result;
}

/// With --prove: says why a volume must not be written, and returns the exit code; kSuccess where nothing is against
/// it.
int judge(const ComputeArguments& options, const Mission& mission, const Volume& volume, const Progress& progress) {
  if (!options.prove || volume.outcome != Outcome::computed) return kSuccess;
  const ProofReport report = prove_volume(mission, volume.mesh, ProveOptions{.lift_m = volume.lift_m}, progress);
  if (report.verdict() == ProofVerdict::proved) {
    if (!options.common.quiet)
      note(mission.target.name + ": all is proved, of the volume less " + shortest(report.shrink) + " of the distance");
    return kSuccess;
  }
  note("not all of the volume of " + mission.target.name + " is proved");
  for (const ClaimProof& claim : report.claims) {
    if (claim.verdict != ProofVerdict::proved) note(claim.name + ": " + name_of(claim.verdict) + ": " + claim.text);
  }
  if (report.verdict() == ProofVerdict::wrong) return kCheckFailed;
  note("to try points: compute it without --prove, then 'vantage verify'");
  return kUndecided;
}

/// All are judged, so that all are told that stand in the way.
int judge_each(const ComputeArguments& options, const Mission& mission, const std::vector<Result>& results,
               const Progress& progress) {
  if (!options.prove) return kSuccess;
  std::size_t against = 0;
  bool is_wrong = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const int judgement = judge(options, one_volume(mission, i), results[i].volume, progress);
    if (judgement != kSuccess) ++against;
    is_wrong = is_wrong || judgement == kCheckFailed;
  }
  if (against == 0) return kSuccess;
  note("nothing is written, because of " + count(against) + " of " + count(results.size()) + " volumes");
  return is_wrong ? kCheckFailed : kUndecided;
}

std::vector<std::string> names_of(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.string());
  return names;
}

int run_each(const ComputeArguments& options, const MissionFile& file, const std::vector<fs::path>& inputs) {
  check_each(options);
  const fs::path table = table_file(options.files().front());
  check_derived_output(table);
  check_not_an_input(table, inputs);
  std::vector<Result> results;
  std::vector<WrittenResults> written;
  std::vector<TableRow> rows;
  std::vector<std::vector<fs::path>> files;  // of each target
  {
    ProgressLine progress(options.common);
    const Mission mission = resolve_mission(file, progress.callback());
    check_volume_place(options.files(), mission.scene().georeference, sea_level_m(mission));
    if (options.prove) check_provable(mission);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < volume_count(mission); ++i) {
      names.push_back(mission.views.empty() ? mission.target.name : mission.views[i].front().name);
    }
    files.resize(names.size());
    std::vector<fs::path> all;  // checked together: a file of one output may have the name of another one's
    for (const fs::path& output : options.files()) {
      const std::vector<fs::path> named = volume_files(output, names);
      for (std::size_t i = 0; i < named.size(); ++i) files[i].push_back(named[i]);
      all.insert(all.end(), named.begin(), named.end());
    }
    check_result_files(all, inputs);
    for (const fs::path& one : all) check_derived_output(one);
    results = run_missions(mission, {options.common.threads, {}}, progress.callback());
    const int judgement = judge_each(options, mission, results, progress.callback());
    if (judgement != kSuccess) {
      tell_of_unwritten(names_of(all));
      return judgement;
    }
    for (std::size_t i = 0; i < results.size(); ++i) {
      ResultRequest request = result_request(mission, results[i], files[i]);
      request.source.target = names[i];
      request.are_names_derived = true;
      written.push_back(write_results(results[i].volume, request, progress.callback()));
    }
    for (std::size_t i = 0; i < results.size(); ++i) {
      rows.push_back({names[i], files[i].front(), &results[i].volume, &written[i].measures});
    }
    check_derived_output(table);  // the run may have taken long
    write_whole_file(table, table_csv(rows));
  }
  if (!options.common.quiet) {
    std::string text = summary_of_each(rows);
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (results[i].volume.outcome != Outcome::computed) continue;
      for (const fs::path& one : files[i]) text += "wrote " + one.string() + "\n";
    }
    print(text + "wrote " + table.string() + ", and a report beside each volume\n");
    notes(warnings_of_each(rows));
  }
  tell_of_heights(options, results.front().volume.georeference);
  for (std::size_t i = 0; i < files.size(); ++i) tell_of_unproved_rounding(options, names_of(files[i]), written[i]);
  bool has_all = true;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].volume.outcome == Outcome::computed) continue;
    has_all = false;
    tell_of_no_volume(rows[i].target, names_of(files[i]), results[i].volume);
  }
  return has_all ? kSuccess : kCheckFailed;
}

int run_compute(const ComputeArguments& options) {
  check_compute_outputs(options);
  const double start = seconds_since_start();
  const MissionFile file = with_options(read_mission_argument(options.mission_file), options);
  const std::vector<fs::path> inputs = input_files(file);
  check_result_files(options.files(), inputs);
  if (!options.report.empty()) check_not_an_input(options.report, inputs);
  std::optional<StageFolder> stages;
  if (!options.stages.empty()) stages.emplace(options.stages);
  std::optional<OutgoingFile> outgoing;
  if (options.is_to_stdout()) outgoing.emplace("." + options.format);
  std::vector<fs::path> files(options.outputs.begin(), options.outputs.end());
  if (outgoing) std::replace(files.begin(), files.end(), fs::path("-"), outgoing->path());

  if (file.combine == Combine::each) return run_each(options, file, inputs);
  Mission mission;
  Result run;
  WrittenResults written;
  {
    ProgressLine progress(options.common);
    mission = resolve_mission(file, progress.callback());
    check_volume_place(files, mission.scene().georeference, sea_level_m(mission));
    if (options.prove) check_provable(mission);
    const double read_seconds = seconds_since_start() - start;
    run = run_mission(mission, {options.common.threads, stages ? stages->sink() : StageSink()}, progress.callback());
    run.volume.seconds.read = read_seconds;
    run.volume.seconds.total = seconds_since_start();  // with all that lies between; writing is added
    const int judgement = judge(options, mission, run.volume, progress.callback());
    if (judgement != kSuccess) {
      tell_of_unwritten(options.outputs);
      return judgement;
    }
    if (stages) stages->write_story(mission, run);
    written = write_results(run.volume, result_request(mission, run, files), progress.callback());
    if (stages) stages->commit();
  }
  if (outgoing) std::erase(written.reports, report_file(outgoing->path()));
  if (!options.report.empty()) {
    write_whole_file(options.report,
                     report_json(run.volume, written.measures, result_request(mission, run, {}).source));
  }
  tell(options, mission, run, written, outgoing ? &*outgoing : nullptr);
  return run.volume.outcome == Outcome::computed ? kSuccess : kCheckFailed;
}

}  // namespace

void add_compute(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("compute", "Compute the visibility volume of a mission and write it");
  auto options = std::make_shared<ComputeArguments>();
  command->add_option("mission", options->mission_file, "The mission file; - for standard input")
      ->required()
      ->option_text("MISSION");
  command
      ->add_option("-o,--output", options->outputs,
                   "Where to write: " + volume_extensions_text() + ", or - for standard output; may be repeated")
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
  command->add_option("--format", options->format, "Format for -o -: " + format_words_text())
      ->check(CLI::IsMember(format_words()))
      ->option_text("FORMAT");
  command->add_option("--report", options->report, "File for the report of -o -; default: none is written")
      ->option_text("FILE");
  command->add_flag(
      "--prove", options->prove,
      "Write only if the computed mesh is proved, as by 'vantage prove'; else exit code 1 or 4, as there");
  command->add_flag("--fail-empty")->group("");  // without effect: it was an option once
  command->add_flag("--json", options->json, "Print the report instead of a summary");
  command->add_flag("-v,--verbose", options->verbose, "Print all causes, sizes and times instead of five lines");
  finish<ComputeArguments>(*command, options, compute_examples(), chosen, run_compute);
}

}  // namespace vantage::cli
