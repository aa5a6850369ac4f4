// Which positions miss how much of a target that is cut into cells: unions and intersections of the cells' volumes.
// This is where an arrangement (arranged.h) cannot be made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "solid/csg.h"

namespace vantage::internal::solid {

/// The positions that miss cells of no more than some cost in all.
struct MissedAtMost {
  std::uint64_t cost = 0;
  Solid solid;
};

/// The positions that miss cells of no more than `budget`: of `costs`, one a cell, the sum over those that they do not
/// see whole. `volume_of(i)` makes the volume of a cell, once each, in order.
///
/// With M(n, j) for what misses at most j of the cells below a node n: M(n, j) is the union over a of M(left, a) and
/// M(right, j - a), intersected. Only some j are kept: for up to 8 cells all, for up to 16
/// every second, and so on, which depends on the cost of all cells below the node alone. What lies between is rounded
/// down, so that the result is right, and smaller. So it holds that of half as many cells, and of a smaller budget.
Solid seen_within(std::span<const std::uint64_t> costs, std::uint64_t budget,
                  const std::function<Solid(std::size_t)>& volume_of, const core::ProgressReporter& progress);

}  // namespace vantage::internal::solid
