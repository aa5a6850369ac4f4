// The proof of a volume less a layer below its surface: for what is rounded.
#pragma once

#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "prove/open_volume.h"
#include "prove/scene_tree.h"
#include "prove/view.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// A layer says nothing where it is a large part of the volume: at most so much of the smallest extent of its box.
constexpr double kThickestLayer = 0.01;
double thickest_layer_m(const Mesh& volume);

struct LayerProof {
  std::vector<OpenFacet> open;  ///< those that stay so
  double depth_m = 0;           ///< of what hides something on the way to a facet that does not; of View::inner
  bool is_too_thick = false;    ///< what would be the thinnest layer, so that none was tried
  bool has_too_many = false;    ///< open facets, and obstacles of each: none was tried
};

/// Which of the open facets are so for what is hidden only of a layer that is as thick as one rounding, or two.
LayerProof prove_less_layer(const OpenVolume& volume, const View& view, const Scene& scene, const SceneTree& obstacles,
                            const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
