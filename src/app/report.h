// The text of *.report.json.
#pragma once

#include <optional>
#include <string>

#include "vantage/spheres.h"
#include "vantage/volume.h"

namespace vantage::app {

/// How the spheres method was run.
struct SpheresRun {
  SpheresOptions options;
  SpheresReport report;
};

/// What the volume was made from, for the report; empty entries are left out.
struct ReportSource {
  std::string mission;                               ///< file
  std::string scene;                                 ///< file
  std::string target;                                ///< name
  std::string volume;                                ///< the file that holds the volume
  std::optional<SpheresRun> spheres = std::nullopt;  ///< the method was spheres; else it was exact
};

/// The part of a report that tells of the spheres method: a JSON object.
std::string spheres_json(const SpheresRun& run);

/// A JSON object, UTF-8, two spaces of indentation, a newline at the end. Lengths are metres in the scene frame.
/// `causes` are in the order of Volume::causes, so that the facet property of a PLY file indexes them. `bounding_box`
/// is null for an empty volume; `georeference` is there when the scene has one. Bytes of names that are not UTF-8 are
/// replaced.
std::string report_json(const Volume& volume, const MeshMeasures& measures, const ReportSource& source = {});

}  // namespace vantage::app
