// What missions need of the component `depth`: spheres.cpp, or without_spheres.cpp in builds without it. The latter
// also has the public run_willis_config, whose definition else is in run_willis.cpp.
#pragma once

#include "vantage/spheres.h"

namespace vantage::internal::app {

/// As compute_visibility_spheres.
Volume spheres_volume(const PreparedTarget& target, const SpheresOptions& options, SpheresReport& report,
                      const StageSink& stages, const Progress& progress);

}  // namespace vantage::internal::app
