// The one check of navigation limits.
#pragma once

#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/export.h"
#include "vantage/navigation.h"

namespace vantage::internal::core {

/// Throws Error(input) for a ground with a coordinate that is not finite or too large, or an index out of range.
void check_ground(const Ground& ground, const std::string& where);

/// check_navigation, for those who cut: returns the meshes to stay in as checked_solid does, welded.
std::vector<Mesh> checked_navigation(const Navigation& navigation, const ProgressReporter& progress = {});

}  // namespace vantage::internal::core
