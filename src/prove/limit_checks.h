// Whether the limits are what the proof takes them for, by code of its own: check_navigation has been there before.
#pragma once

#include "vantage/navigation.h"

namespace vantage::internal::prove {

/// Throws Error(input) for a zone whose sides cross, decided exactly, and for a mesh to stay in that is not closed,
/// oriented and outward.
void check_limits(const Navigation& navigation);

}  // namespace vantage::internal::prove
