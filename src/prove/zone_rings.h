// Whether a zone's outline and holes are what docs/proof.md needs of them.
#pragma once

#include <string>

#include "vantage/navigation.h"

namespace vantage::internal::prove {

/// Throws Error(input), with `where`, for a ring of fewer than 3 corners, a coordinate that is not finite, sides that
/// cross or touch others besides at the corner that neighbours share, and a hole that is not inside of the outline, or
/// in another hole. Decided exactly. Cost: O(n log n) in the corners where sides are short, O(n^2) at worst.
void check_rings(const Zone& zone, const std::string& where);

}  // namespace vantage::internal::prove
