// Whether anything is missing beyond a volume's facets.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "prove/limits_beyond.h"
#include "prove/scene_tree.h"
#include "prove/view.h"
#include "vantage/prove.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// What the facets are judged by, for one part of the target. References must last.
struct Beyond {
  const Scene& scene;
  const View& view;
  const SceneTree& obstacles;  ///< at least those that the grown volume reaches
  const LimitsBeyond& limits;
  double range_m = std::numeric_limits<double>::infinity();
  double tolerance_m = 0;     ///< less is asked of the range by so much
  double grow = 0;            ///< facets are moved out by this part of the distance from the target,
  double rounding_m = 0;      ///< and by this
  double point_radius_m = 0;  ///< of the ball that stands for a point
};

/// The mesh about View::origin, with its vertices moved away from there.
std::vector<Vec3> grown(const std::vector<Vec3>& vertices, const Beyond& beyond);

struct Witnesses {
  std::vector<FacetWitness> facets;
  bool may_return = false;  ///< beyond a facet that has a limit as its witness, that limit may end farther out
};

/// A witness for each triangle, if there is one. `vertices`: about View::origin, as they are.
Witnesses find_witnesses(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                         const Beyond& beyond, const core::ProgressReporter& progress);

/// What has to hold besides, so that the witnesses of all facets bound the volume.
std::vector<MaximalCondition> whole_conditions(const std::vector<Vec3>& vertices,
                                               const std::vector<Triangle>& triangles, const Witnesses& witnesses,
                                               const Beyond& beyond);

/// Fills in what follows from the witnesses: rows, shares and open facets.
void finish_maximal(const Mesh& volume, MaximalProof& proof);

}  // namespace vantage::internal::prove
