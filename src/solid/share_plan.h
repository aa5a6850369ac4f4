// How a share of a target's area is counted in cells: docs/theory.md, "A share of the target as a volume".
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/target.h"

namespace vantage::internal::solid {

/// What may be missed: cells that cost no more than `budget` together. Where all areas are at least what the costs say,
/// then what is seen is at least the share.
struct SharePlan {
  std::vector<std::size_t> counts;   ///< cells of each part
  std::vector<std::uint64_t> costs;  ///< of a cell of each part
  std::uint64_t budget = 0;
};

/// Of a target whose sensor asks for a share.
SharePlan share_plan(const PreparedTarget& target);

/// Whether the target may be seen in part, so far as its cells tell: not where all of them must be seen.
bool has_share(const PreparedTarget& target);

}  // namespace vantage::internal::solid
