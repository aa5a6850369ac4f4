// The volume of a polygon, with the limits that can be cut in the chart.
#pragma once

#include <vector>

#include "exact/chart_limits.h"
#include "vantage/volume.h"

namespace vantage::internal::exact {

struct LimitedVisibility {
  enum class How {
    computed,
    /// A limit passes through the target's centre, or nothing is left: cut_to_limits tells these apart, and says why.
    needs_booleans,
    failed,  ///< floor and envelope meet in a way that could not be triangulated
  };
  How how = How::needs_booleans;
  Volume volume;  ///< where it is computed
};

/// As compute_visibility, of a target that is one polygon, but only what keeps the limits. `causes`: by label, for
/// facets that are due to a limit.
LimitedVisibility compute_visibility_within(const PreparedTarget& target, const ChartLimits& limits,
                                            const std::vector<Cause>& causes, const ExactOptions& options,
                                            const Progress& progress);

}  // namespace vantage::internal::exact
