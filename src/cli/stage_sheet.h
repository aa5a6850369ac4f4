// The figure sheet of a run of the spheres method.
#pragma once

#include <array>
#include <vector>

#include "common/stages.h"
#include "vantage/mission.h"
#include "vantage/picture.h"
#include "vantage/progress.h"

namespace vantage::cli {

/// Panels of one scale: the scene with its target, each sphere, each pair, the result from the top and obliquely, and
/// where the mission limits navigation, the limits and what they leave. `size`: pixels of a panel.
Picture stage_sheet(const Mission& mission, const std::vector<StageFile>& stages, const PictureView& view,
                    std::array<int, 2> size, const Progress& progress);

}  // namespace vantage::cli
