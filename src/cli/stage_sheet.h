// The figure sheet of a run of the spheres method.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/mission.h"
#include "vantage/picture.h"
#include "vantage/progress.h"

namespace vantage::cli {

/// A step as `vantage compute --method spheres --stages` wrote it down.
struct StageFile {
  std::string kind;  ///< "sphere", "pair", "split", "partial", "result"
  std::string name;
  std::filesystem::path mesh;  ///< empty: the step has none
  long euler = 0;
};

/// Reads `folder`/stages.json. Throws Error(input) for a missing or garbled file, naming the stage.
std::vector<StageFile> read_stages(const std::filesystem::path& folder);

/// Panels of one scale: the scene with its target, each sphere, each pair, the result from the top and obliquely, and
/// where the mission limits navigation, the limits and what they leave. `size`: pixels of a panel.
Picture stage_sheet(const Mission& mission, const Scene& scene, const std::vector<StageFile>& stages,
                    const PictureView& view, std::array<int, 2> size, const Progress& progress);

}  // namespace vantage::cli
