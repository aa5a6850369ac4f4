// The volume of positions that see a part of the target's area, though not all of it: docs/theory.md, "A share of
// the target as a volume".
#pragma once

#include "vantage/progress.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {

/// Whether the target may be seen in part, so far as its cells tell: not where all of them must be seen.
bool has_share(const PreparedTarget& target);

/// What sees at least the share of the target that its sensor asks, within the range of all of it and in front of all
/// its parts. The target has a share. Guaranteed from the inside: from each point so many of the cells are seen whole.
/// Cost: a volume for each cell, and an arrangement of these, in which each meets each other one.
Volume share_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& progress);

}  // namespace vantage::internal::solid
