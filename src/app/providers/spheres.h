// What missions need of the method of spheres. The library vantage_picture provides it, once the application has called
// enable_spheres().
#pragma once

#include <string>

#include "vantage/export.h"
#include "vantage/spheres.h"

namespace vantage::internal::app {

/// The function of vantage_picture with this name.
struct SpheresProvider {
  Volume (*compute_visibility_spheres)(const PreparedTarget& target, const SpheresOptions& options,
                                       SpheresReport* report, const StageSink& stages, const Progress& progress);
};

/// From now on missions use it. It must last as long as the program.
VANTAGE_INTERNAL_API void provide(const SpheresProvider& provider);

/// What was provided. Throws Error(component_missing) where nothing was; `what` cannot be done then.
const SpheresProvider& spheres_provider(const std::string& what, const std::string& where);

}  // namespace vantage::internal::app
