// Looks for what a volume claims wrongly where that is most likely: right beside the edges of the scene.
#pragma once

#include <cstddef>

#include "support/random.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::testing {

struct AimedReport {
  std::size_t looks = 0;   ///< directions in which the scene ends the view
  double worst_depth = 0;  ///< of a hidden place inside the volume: metres to the volume's surface
  double worst_share = 0;  ///< the greatest such depth in parts of the distance to the target's centre
  Vec3 worst_place = Vec3::Zero();
};

/// From each vertex of the target (a point's one) in `tries` directions that pass a visible scene edge at 1e-6 to 1e-3
/// radians: the volume must not reach farther than the first triangle that a ray hits. Shares nothing with the engine.
AimedReport look_beside_edges(const Scene& scene, const Volume& volume, double range, std::size_t tries,
                              Random& random);

}  // namespace vantage::testing
