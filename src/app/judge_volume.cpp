// What it takes to judge the volume of a file: what it says of itself, and the report beside it.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/combine_targets.h"
#include "vantage/error.h"
#include "vantage/hash.h"
#include "vantage/result.h"

namespace vantage {
namespace {

constexpr double kMostLift = ProveOptions::kMostLift;  // a target is raised by no more than 2.01 mm

/// The largest lift of the target's parts, by the report beside the file, if there is one.
std::optional<double> reported_lift_m(const std::filesystem::path& volume_file) {
  std::filesystem::path volume = volume_file;
  if (volume.extension() == ".gz") volume.replace_extension();
  const std::filesystem::path report = report_file(volume);
  std::ifstream in(report);
  if (!in) return std::nullopt;
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const double lift =
      json.is_object() && json.contains("lift_m") && json["lift_m"].is_number() ? json["lift_m"].get<double>() : -1;
  if (lift >= 0 && lift <= kMostLift) return lift;
  throw Error(ErrorCode::record_garbled, "the report beside the volume gives no lift_m from 0 to 0.01", report.string(),
              "write it again with \"vantage compute\", or say how far the target was raised with --lift");
}

}  // namespace

std::vector<Warning> volume_warnings(const VolumeFile& read, const Mission& mission) {
  if (!read.volume.provenance) return {};
  const VolumeProvenance& made = *read.volume.provenance;
  if (!made.scene_hash.empty() && made.scene_hash != scene_hash(mission.loaded.scene)) {
    return {{WarningCode::volume_of_other_scene,
             "the file says that the volume was computed in another scene than the mission's"}};
  }
  if (!made.mission_hash.empty() && made.mission_hash != mission_hash(mission)) {
    return {{WarningCode::volume_of_other_mission, "the file says that the volume was computed for another mission"}};
  }
  return {};
}

VerifyOptions verify_options(const VolumeFile& read, const Mission& mission) {
  VerifyOptions options;
  options.tolerance_m = mission.as_written.exact.tolerance_m;
  options.rounding_m = read.rounding_m;
  options.lift_m = read.volume.lift_m;
  for (const double lift : options.lift_m) {
    if (lift <= kMostLift) continue;
    throw Error(ErrorCode::record_garbled, "the volume says that its target was raised by more than 0.01 m",
                read.file.string(), "compute it again: its header was changed");
  }
  std::size_t parts = 0;
  for (const std::vector<Target>& view : internal::app::views_of(mission)) {
    for (const Target& target : view) parts += target.parts.size();
  }
  if (options.lift_m.size() != parts) options.lift_m.assign(parts, reported_lift_m(read.file).value_or(0));
  return options;
}

}  // namespace vantage
