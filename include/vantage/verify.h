// The independent check of a volume: ray casting that shares no geometry code with the engine.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

struct VerifyOptions {
  std::size_t points = 20000;      ///< viewpoints tried: half spread over the volume and its surroundings, half near the boundary
  int target_samples = 64;         ///< points of the target looked at besides its vertices and edge points
  std::uint64_t seed = 1;
  double depth_tolerance = 1e-6;   ///< a claimed point is over-claimed when it lies deeper inside than this times its distance
};

struct VerifyReport {
  std::size_t points = 0;          ///< viewpoints tried
  std::size_t inside = 0;          ///< of those, claimed by the volume
  std::size_t rays = 0;
  std::size_t over_claimed = 0;    ///< claimed, but some part of the target is hidden or out of range
  std::size_t under_claimed = 0;   ///< not claimed, though everything sampled was visible, by more than the tolerance
  double worst_over_depth_m = 0;   ///< how deep inside the worst over-claimed point lies
  double worst_under_depth_m = 0;  ///< how far outside the worst under-claimed point lies
  double over_claim_bound = 0;     ///< with 95 % confidence at most this share of the volume is over-claimed (exact binomial)
  Vec3 worst_over_point = Vec3::Zero();
  bool closed = false, oriented = false;
  long euler = 0;
  std::uint64_t seed = 0;
};

/// Checks `volume` (any closed mesh, scene frame) against the scene by shadow rays to the target's vertices, edges and
/// interior. Hits lower than 1 mm over the target itself count as the
/// surface that it lies on. Throws Error(input) for a mesh that is not closed.
VerifyReport verify_volume(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                           const Mesh& volume, const VerifyOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
