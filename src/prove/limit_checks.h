// Whether limits are wrong in themselves. No file is behind them here: whoever calls the library may have made them.
#pragma once

#include "vantage/constraints.h"

namespace vantage::internal::prove {

/// Throws Error(input) for a band, a box or a zone that is reversed, flat or not finite, a zone whose sides cross, a
/// mesh to stay in that is not closed, oriented and outward, ground or obstacles with an index out of range or a
/// coordinate that is not finite, and a clearance that is not positive or without obstacles.
void check_limits(const Navigation& navigation);

}  // namespace vantage::internal::prove
