// The proof of a volume less a layer below its surface: for what is rounded.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/scene_tree.h"
#include "prove/sight.h"
#include "prove/view.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// A volume of which some facets were tested, and are open.
struct OpenVolume {
  const Mesh& whole;                   ///< closed, about View::origin
  const std::vector<Vec3>& vertices;   ///< of the facets that were tested
  const std::vector<Triangle>& facets; ///< likewise
  const std::vector<OpenFacet>& open;
  double rounding_m = 0;  ///< how far a file's numbers may have moved the surface
};

struct LayerProof {
  std::vector<OpenFacet> open;  ///< those that stay so
  double depth_m = 0;           ///< of what hides something on the way to a facet that does not
};

/// Which of the open facets are so for what is hidden only of a layer that is as thick as a few roundings.
LayerProof prove_less_layer(const OpenVolume& volume, const View& view, const Scene& scene, const SceneTree& obstacles,
                            const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
