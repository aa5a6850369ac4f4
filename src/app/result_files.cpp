#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>

#include "core/progress_reporter.h"
#include "core/volume_check.h"
#include "io/writers.h"
#include "vantage/atomic_file.h"
#include "vantage/error.h"
#include "vantage/output.h"
#include "vantage/result.h"

namespace vantage {

std::filesystem::path report_file(const std::filesystem::path& volume_file) {
  return std::filesystem::path(volume_file).replace_extension(".report.json");
}

WrittenResults write_results(Volume& volume, const ResultRequest& request, const Progress& callback) {
  const auto start = std::chrono::steady_clock::now();
  const internal::core::ProgressReporter progress(callback);
  progress.begin("writing");
  const bool has_volume = volume.outcome == Outcome::computed;
  WrittenResults result;
  result.measures = has_volume ? internal::core::measure_sound(volume.mesh) : measure(volume.mesh);

  std::vector<std::unique_ptr<AtomicFile>> files;
  if (has_volume) {
    for (const std::filesystem::path& file : request.volumes) {
      progress.report(result.written.size(), request.volumes.size() + 1);
      StagedVolume staged = stage_volume(volume, file, request.obj_up, request.obj_scale);
      staged.files.front()->seal();
      std::move(staged.files.begin(), staged.files.end(), std::back_inserter(files));
      result.written.push_back(staged.report);
    }
  }
  progress.finish();
  volume.seconds.write = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  volume.seconds.total += volume.seconds.write;

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
  commit_all(files);
  return result;
}

}  // namespace vantage
