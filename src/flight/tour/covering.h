// Small exact problems of sets, by branch and bound: the least cover, the largest clique, and groups without a
// conflict.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/progress_reporter.h"

namespace vantage::internal::flight::tour {

/// Numbers of elements, sorted, without repeats.
using Group = std::vector<std::size_t>;

/// When a search ends before it is done.
struct CoveringLimits {
  std::size_t most_nodes = 1'000'000;    ///< the same on every machine
  std::function<bool()> is_over = {};    ///< asked now and then; empty: no
  core::ProgressReporter progress = {};  ///< asked whether to go on; its fraction is left as it is
};

/// Whether all of `part` is in `whole`.
bool is_subset(const Group& part, const Group& whole);

struct Cover {
  std::vector<std::size_t> chosen;  ///< numbers of sets, sorted
  bool is_least = false;            ///< no fewer sets hold all elements
};

/// The fewest sets that hold all of 0 to count - 1. Each element must be in a set. The same every time. Throws
/// Error(cancelled).
Cover least_cover(std::size_t count, const std::vector<Group>& sets, const CoveringLimits& limits = {});

/// Elements of 0 to count - 1 of which each two are a pair that is given: the most, or what was found within the limits
/// (E. Tomita and T. Seki, "An efficient branch-and-bound algorithm for finding a maximum clique", 2003). Sorted. The
/// same every time. Throws Error(cancelled).
Group most_apart(std::size_t count, const std::vector<Group>& conflicts, const CoveringLimits& limits = {});

struct Division {
  enum class End : std::uint8_t {
    found,
    none,  ///< there is none: certain
    cut,   ///< by the limits
  };
  End end = End::cut;
  std::vector<Group> groups;  ///< some may be empty
};

/// All of 0 to count - 1 in so many groups, none of which holds all of a conflict. `apart`: elements of which each two
/// are a conflict. `affinity(a, b)`: how well two elements go together; the search puts such together first. The same
/// every time. Throws Error(cancelled).
Division divide(std::size_t count, std::size_t groups, const std::vector<Group>& conflicts, const Group& apart,
                const std::function<double(std::size_t, std::size_t)>& affinity, const CoveringLimits& limits = {});

}  // namespace vantage::internal::flight::tour
