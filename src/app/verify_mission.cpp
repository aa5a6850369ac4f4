// The check of a mission's volume.
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage {

VerifyReport verify_volume(const Mission& mission, const Mesh& volume, const VerifyOptions& options,
                           const Progress& progress) {
  const auto check = [&](const auto& seen) {
    return verify_volume(mission.scene(), seen, mission.sensor, mission.navigation, volume, options, progress);
  };
  VerifyReport report = mission.views.empty() ? check(mission.target) : check(mission.views);
  for (const Warning& warning : mission_warnings(mission)) {
    if (warning.code == WarningCode::scene_incomplete) report.scene_incomplete = warning.text;
  }
  return report;
}

}  // namespace vantage
