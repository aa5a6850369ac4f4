// A place of a volume from which a point of the target is surely hidden.
#pragma once

#include <optional>

#include "core/progress_reporter.h"
#include "prove/open_volume.h"
#include "prove/scene_tree.h"
#include "prove/view.h"
#include "vantage/prove.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// The deepest that is found, if it is deeper than `known`; else that one. What is hidden no deeper than the volume's
/// rounding does not count.
std::optional<HiddenView> deepest_witness(const Scene& scene, const View& view, const SceneTree& obstacles,
                                          const OpenVolume& volume, std::optional<HiddenView> known,
                                          const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
