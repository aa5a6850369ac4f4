// Checks of navigation limits, for those who read them from files.
#pragma once

#include <vector>

#include "solid/csg.h"
#include "vantage/constraints.h"

namespace vantage::internal::solid {

/// Throws Error(input) for a reversed, empty or not finite altitude band or box and for a zone that is none; `where`
/// says which one in the words of a mission file ("navigation.boxes[1]").
void check_limits(const Navigation& navigation);

/// check_limits, and checked_solid on every mesh. Returns the meshes, welded.
std::vector<Mesh> check_navigation(const Navigation& navigation, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
