// What must be seen of several targets, and of targets that are seen from either side.
#pragma once

#include <vector>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// Fills in `mission.target` and `mission.views` as `mission.as_written.combine` says. `targets`: for each of `given`
/// what became of it, one target or more; in the scene frame, checked.
void combine_targets(const std::vector<MissionTarget>& given, std::vector<std::vector<Target>> targets,
                     Mission& mission);

/// `mission.views`, or the one target that it has without them.
std::vector<std::vector<Target>> views_of(const Mission& mission);

}  // namespace vantage::internal::app
