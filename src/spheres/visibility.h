// compute_visibility_spheres and visibility_sphere with a renderer of the caller's choice.
#pragma once

#include "depth/depth.h"
#include "vantage/spheres.h"

namespace vantage::internal::spheres {

/// As compute_visibility_spheres, but for SpheresReport::device_note. Runs in the caller's arena.
Volume compute_visibility(const PreparedTarget& target, const SpheresOptions& options, depth::DepthRenderer& renderer,
                          SpheresReport* report, const StageSink& stages, const Progress& progress);

/// As visibility_sphere.
Mesh visibility_sphere(const Vec3& viewpoint, double radius_m, const SpheresOptions& options,
                       depth::DepthRenderer& renderer, const Progress& progress);

}  // namespace vantage::internal::spheres
