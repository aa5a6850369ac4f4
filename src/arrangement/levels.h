// How much of the operands holds what lies in front of each part of a facet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arrangement/subdivision.h"

namespace vantage::internal::arrangement {

/// Per half-edge of a subdivision: the sum of the weights of the operands that hold the space straight beyond the part
/// to its left, on the side where the facet's own operand does not count. It is the same across an edge, and changes by
/// a known weight across a meeting; where all parts hang together it is computed once, at one corner. nullopt where the
/// meshes contradict each other, as one does that passes through itself. Cost: O(n log n) in all.
std::optional<std::vector<std::uint64_t>> find_levels(const Soup& soup, const Subdivision& subdivision,
                                                      std::span<const Operand> operands);

}  // namespace vantage::internal::arrangement
