// Facets in groups of groups, by where they lie as seen from the target.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

struct Patch {
  std::uint32_t begin = 0, end = 0;  ///< of Patches::order
  std::uint32_t second = 0;          ///< of its two halves; the first one is the next patch. 0: a single facet
  double extent = 0;                 ///< of its facets' directions, roughly: radians
};

struct Patches {
  std::vector<std::uint32_t> order;  ///< numbers of facets
  std::vector<Patch> tree;           ///< depth first; none where there are no facets
};

/// Halved again and again. `vertices`: about the target. Cost: O(n log n).
Patches make_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets);

}  // namespace vantage::internal::prove
