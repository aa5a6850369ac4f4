#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "common/atomic_file.h"
#include "common/output.h"
#include "common/shown_address.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "core/volume_check.h"
#include "io/writers.h"
#include "vantage/error.h"
#include "vantage/result.h"

namespace vantage {

std::filesystem::path report_file(const std::filesystem::path& volume_file) {
  return volume_output(volume_file).replace_extension(".report.json");
}

ResultRequest result_request(const Mission& mission, const Result& result, std::vector<std::filesystem::path> volumes) {
  ResultRequest request{std::move(volumes), mission.scene().up, mission.scene().scale};
  request.sea_level_z_m = sea_level_m(mission);
  ReportSource& source = request.source;
  source.mission = mission.as_written.file.string();
  source.scene = shown_address(mission.as_written.scene.file).string();
  source.target = mission.target.name;
  if (result.spheres) source.spheres = SpheresRun{mission.as_written.spheres, *result.spheres};
  return request;
}

void check_result_files(const std::vector<std::filesystem::path>& volumes,
                        const std::vector<std::filesystem::path>& inputs) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& volume : volumes) {
    check_volume_output(volume);
    check_derived_output(report_file(volume));
    if (!seen.insert(volume_output(volume).lexically_normal()).second) {
      throw Error(ErrorCode::output_named_twice, "an output is named twice", volume.string(),
                  "give each output a name of its own");
    }
    for (const std::filesystem::path& output : {volume, report_file(volume)}) check_not_an_input(output, inputs);
  }
}

WrittenResults write_results(Volume& volume, const ResultRequest& request, const Progress& callback) {
  const internal::core::Stopwatch stopwatch;
  const internal::core::ProgressReporter progress(callback);
  progress.begin("writing");
  const bool has_volume = volume.outcome == Outcome::computed;
  WrittenResults result;
  result.measures = has_volume ? internal::core::measure_sound(volume.mesh) : measure(volume.mesh);

  std::vector<StagedVolume> volumes;
  if (has_volume) {
    for (const std::filesystem::path& file : request.volumes) {
      progress.report(result.written.size(), request.volumes.size() + 1);
      StagedVolume staged = stage_volume(volume, file, request.obj_up, request.obj_scale, request.sea_level_z_m);
      if (!staged.files.empty()) staged.files.front()->seal();
      result.written.push_back(staged.report);
      volumes.push_back(std::move(staged));
    }
  }
  progress.finish();
  volume.seconds.write = stopwatch.seconds();
  volume.seconds.total += volume.seconds.write;

  std::vector<std::unique_ptr<AtomicFile>> files;  // the reports
  for (const std::filesystem::path& file : request.volumes) {
    ReportSource source = request.source;
    if (has_volume) source.volume = file.string();
    const std::string text = report_json(volume, result.measures, source);
    if (result.report.empty()) result.report = text;
    const std::filesystem::path report = report_file(file);
    const auto is_same = [&](const auto& other) { return other.lexically_normal() == report.lexically_normal(); };
    if (std::any_of(result.reports.begin(), result.reports.end(), is_same)) continue;
    files.push_back(std::make_unique<AtomicFile>(report));
    files.back()->write(text);
    result.reports.push_back(report);
  }
  // Last: the run may have taken long, and writing, too.
  for (const std::filesystem::path& report : result.reports) check_derived_output(report);
  if (request.are_names_derived && has_volume) {
    for (const std::filesystem::path& file : request.volumes) check_derived_output(file);
  }
  commit_volumes(std::move(volumes), std::move(files));
  return result;
}

}  // namespace vantage
