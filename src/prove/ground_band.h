// Heights above the ground, of the whole volume or of a zone.
#pragma once

#include <string>

#include "core/progress_reporter.h"
#include "prove/limited_volume.h"
#include "vantage/navigation.h"

namespace vantage::internal::prove {

ClaimProof prove_above_ground(const std::string& name, const LimitedVolume& volume, const AboveGround& limit,
                              const core::ProgressReporter& progress);

}  // namespace vantage::internal::prove
