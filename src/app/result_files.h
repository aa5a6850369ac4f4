// What a computation leaves on the disk: the volume, in any number of formats, and reports beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/report.h"
#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage::app {

struct ResultRequest {
  std::vector<std::filesystem::path> volumes;  ///< files to write; each extension chooses a format, see write_volume
  UpAxis obj_up = UpAxis::z;                   ///< as Scene::up
  double obj_scale = 1.0;                      ///< as Scene::scale
  ReportSource source;                         ///< `volume` is filled in for each report
};

struct WrittenResults {
  MeshMeasures measures;
  std::vector<WrittenVolume> written;          ///< of each file that is asked for; empty when there is no volume
  std::vector<std::filesystem::path> reports;  ///< those written
  std::string report;                          ///< text of the first file's
};

/// "volume.ply" has its report in "volume.report.json".
std::filesystem::path report_file(const std::filesystem::path& volume_file);

/// Writes the volume to every file that is asked for, and a report beside each; only the reports when there is no
/// volume. First of all it is measured. All files are written or none: when anything fails, old ones stay as they were.
/// Fills Volume::seconds.write (until all is ready on the disk) and adds it to the total. Throws Error(internal) for a
/// volume that is not closed and oriented, Error(cancelled) when told to stop, and as write_volume does.
WrittenResults write_results(Volume& volume, const ResultRequest& request, const Progress& progress = {});

}  // namespace vantage::app
