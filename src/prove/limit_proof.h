// The proof of a limit: each room of src/limits/ defines that of its own.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "prove/view.h"
#include "vantage/each_limit.h"

namespace vantage::internal::prove {

/// What claims to keep a limit. Limits of the sensor are about the part of a volume in front of the target.
struct Claimant {
  const LimitedVolume& volume;
  const std::vector<View>& parts;  ///< of the target
  const Sensor& sensor;
};

/// Whether the volume keeps the limit. Declared alone: a limit whose room has no proof does not link.
template <Limit kLimit>
ClaimProof prove_limit(const LimitValueOf<kLimit>& limit, const Claimant& of, const core::ProgressReporter& progress);

/// Throws Error(input) for a point without a front: it has no plane, which the limit is about.
void check_has_plane(const Claimant& of, Limit limit);

}  // namespace vantage::internal::prove
