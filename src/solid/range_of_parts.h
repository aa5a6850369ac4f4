// What the range alone leaves of a target's front.
#pragma once

#include <optional>

#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {

/// Where all parts are in range, in front of the first one's plane, whatever the scene: the convex hull of places on
/// the spheres about all corners, so dense that no point of a facet lies more than the tolerance within all of them
/// (docs/theory.md, "Targets of several parts"). nullopt where the middle of the target in that plane is not in range,
/// from which they are looked for, or where the tolerance asks for too many. Cost: of a convex hull, a few times; each
/// place is compared with all corners.
std::optional<Volume> range_of_parts(const PreparedTarget& target, const ExactOptions& options);

}  // namespace vantage::internal::solid
