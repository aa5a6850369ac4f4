// The one check of navigation limits.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "vantage/export.h"
#include "vantage/navigation.h"

namespace vantage::internal::core {

/// check_navigation, for those who cut: returns the meshes to stay in as checked_solid does, welded.
std::vector<Mesh> checked_navigation(const Navigation& navigation, const ProgressReporter& progress = {});

}  // namespace vantage::internal::core
