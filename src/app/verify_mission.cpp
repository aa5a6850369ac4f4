// The check of a mission's volume.
#include "app/scene_warnings.h"
#include "common/known_data.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage {

VerifyReport verify_volume(const Mission& mission, const Mesh& volume, const VerifyOptions& options,
                           const Progress& progress) {
  internal::app::refuse_in_stand_ins(mission);
  const auto check = [&](const auto& seen) {
    return verify_volume(mission.scene(), seen, mission.sensor, mission.navigation, volume, options, progress);
  };
  VerifyReport report = mission.views.empty() ? check(mission.target) : check(mission.views);
  if (const auto missing = incomplete_warning(mission)) report.scene_incomplete = missing->text;
  return report;
}

}  // namespace vantage
