// The outlines of a zone about a volume.
#pragma once

#include <vector>

#include "vantage/navigation.h"

namespace vantage::internal::solid {

using ZoneRings = std::vector<Zone::Ring>;

/// The rings of the zone within the rectangle of `bounds` in plan, relative to `origin`: the outer one
/// counter-clockwise, holes clockwise. Nothing within the rectangle changes, but for the rounding of corners to doubles
/// about the origin, however far the zone reaches. Rings may run along the border of the rectangle, and along
/// themselves there. Empty where the zone does not meet the rectangle.
ZoneRings rings_within(const Zone& zone, const Box& bounds, const Vec3& origin);

}  // namespace vantage::internal::solid
