// Boxes and zones to stay in and out of.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "vantage/navigation.h"

namespace vantage::internal::prove {

/// The proof for the union of all that the vehicle is to stay in.
ClaimProof prove_keep_in(const LimitedVolume& volume, const Navigation& navigation,
                         const core::ProgressReporter& progress);

/// The worst of the proofs for each box and zone that it is to stay out of.
ClaimProof prove_keep_out(const LimitedVolume& volume, const Navigation& navigation,
                          const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
