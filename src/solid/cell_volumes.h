// Volumes of targets that are cut into cells, or have many parts: docs/theory.md, "A share of the target as a volume".
#pragma once

#include <optional>

#include "vantage/progress.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {

/// What sees at least the share of the target that its sensor asks, within the range of all of it and in front of all
/// its parts. The target has a share. Guaranteed from the inside: from each point so many of the cells are seen whole.
/// Cost: a volume for each cell, and an arrangement of these, in which each meets each other one.
Volume share_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& progress);

/// What sees all parts of a target of several, each of which is a polygon. nullopt where one of them has no volume, or
/// range_of_parts has none.
/// Cost: a volume for each part, whose range has few facets, and arrangements of a few of them at a time.
std::optional<Volume> volume_of_parts(const PreparedTarget& target, const ExactOptions& options,
                                      const Progress& progress);

}  // namespace vantage::internal::solid
