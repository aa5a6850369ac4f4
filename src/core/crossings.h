// Where a mesh passes through itself.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// Pairs of triangles that pass through each other deeper than `distance` (Contact::crossing), the first one of each
/// from `among`. The mesh should lie about the origin. In the order of `among`. Cost: O(n log n).
std::vector<std::pair<std::uint32_t, std::uint32_t>> find_crossings(const Mesh& mesh,
                                                                    std::span<const std::uint32_t> among,
                                                                    double distance);

}  // namespace vantage::internal::core
