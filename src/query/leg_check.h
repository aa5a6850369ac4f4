// What legs may be asked about.
#pragma once

#include "vantage/query.h"

namespace vantage::internal::query {

/// Throws Error(input) for a leg that is not finite or too far away, and for a radius that is negative, not finite or
/// larger than 1e9 m. `index`: for messages.
void check_leg(const Leg& leg, double radius_m, std::size_t index = 0);

}  // namespace vantage::internal::query
