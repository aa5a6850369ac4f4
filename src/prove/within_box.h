// Boxes that a volume is cut to.
#pragma once

#include <string>

#include "prove/limited_volume.h"

namespace vantage::internal::prove {

/// Whether the volume is in a box, which may be infinite (scene frame).
ClaimProof prove_within_box(const std::string& name, const LimitedVolume& volume, const Box& box);

}  // namespace vantage::internal::prove
