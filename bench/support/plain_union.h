// The plain alternative to the engine: the range region minus the union of one convex hull per scene triangle.
#pragma once

#include <functional>

#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::bench {

struct PlainVolume {
  std::size_t facets = 0;
  double volume_m3 = 0;
  bool is_finished = false;  ///< otherwise it was given up
};

/// What a plain program spends its time on: blockers of all triangles that reach into the region, their union, and the
/// difference, by Manifold. `region`: the range region in the target's frame, above its plane; closed. `goes_on` is
/// asked every few milliseconds, and ends it with false. Shares nothing with the engine but the target's frame.
PlainVolume plain_visibility(const Scene& scene, const TargetFrame& frame, const Mesh& region, double max_range,
                             int threads, const std::function<bool()>& goes_on);

}  // namespace vantage::bench
