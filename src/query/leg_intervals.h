// Sets of closed intervals of a leg, as functions of lists that are sorted and disjoint.
#pragma once

#include <algorithm>
#include <vector>

#include "vantage/query.h"

namespace vantage::internal::query {

using LegIntervals = std::vector<LegInterval>;

/// Sorts, and joins what overlaps or touches.
LegIntervals joined(LegIntervals intervals);

/// What is in both. Single points that are no interval of their own are left out.
LegIntervals common(const LegIntervals& a, const LegIntervals& b);

/// What of `from` is outside of `taken`, with its ends. Parts without length are left out, but for a whole interval of
/// `from` that nothing of `taken` meets.
LegIntervals without(const LegIntervals& from, const LegIntervals& taken);

/// All of the leg that is outside.
inline LegIntervals rest_of(const LegIntervals& taken) { return without({{0, 1}}, taken); }

/// Where a linear function with these values at the ends of the leg is > 0; or nothing. Zero all along is nothing.
LegIntervals where_positive(double at_begin, double at_end);

}  // namespace vantage::internal::query
