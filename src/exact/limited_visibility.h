// Volumes of targets in one chart that compute_visibility does not compute: of parts, and with limits.
#pragma once

#include <optional>
#include <vector>

#include "exact/chart_limits.h"
#include "exact/star_target.h"
#include "vantage/volume.h"

namespace vantage::internal::exact {

/// As compute_visibility, of a target of several parts that are one star-shaped polygon (exact/star_target.h). nullopt
/// where they are not, and where the view is blocked at once.
std::optional<Volume> compute_star_visibility(const PreparedTarget& target, const ExactOptions& options,
                                              const Progress& progress);

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

/// As compute_visibility, or compute_star_visibility, but only what keeps the limits. `star`: of the target; the limits
/// are in its frame. `causes`: by label, for facets that are due to a limit.
LimitedVisibility compute_visibility_within(const PreparedTarget& target, const StarTarget& star,
                                            const ChartLimits& limits, const std::vector<Cause>& causes,
                                            const ExactOptions& options, const Progress& progress);

}  // namespace vantage::internal::exact
