// A place of a volume from which a point of the target is surely hidden.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "prove/scene_tree.h"
#include "prove/sight.h"
#include "prove/view.h"
#include "vantage/prove.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// What is looked at for one.
struct Suspects {
  const Mesh& whole;                         ///< the shrunk volume, closed, about View::origin
  const std::vector<Vec3>& vertices;         ///< of the facets that were tested
  const std::vector<Triangle>& facets;       ///< likewise
  const std::vector<std::uint32_t>& numbers; ///< of these, in the volume that was given
  const std::vector<OpenFacet>& open;
  double rounding_m = 0;  ///< what is hidden no deeper than this does not count
};

/// The deepest that is found, if it is deeper than `known`; else that one.
std::optional<HiddenView> deepest_witness(const Scene& scene, const View& view, const SceneTree& obstacles,
                                          const Suspects& suspects, std::optional<HiddenView> known,
                                          const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
