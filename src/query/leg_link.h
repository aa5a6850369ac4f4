// Legs against the scene, by the zone of a radio link.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "query/link_query.h"
#include "vantage/query.h"

namespace vantage::internal::query {

/// The parts of a leg where an object enters the zone of some vehicle within `radius` of it, or does so nearly: by
/// halving, down to 1 mm, or to an 8192nd of the leg once there are 20,000 pieces. Where one object is in the way, the
/// parts of others may be told too long by a 256th of the leg. `origin`: of the scene. `slack`: what rounding may have
/// moved a position by. Of an object in any order, and more than once.
std::vector<std::pair<std::uint32_t, LegInterval>> link_parts(const LinkQuery& link, const Vec3& origin, const Leg& leg,
                                                              double radius, double slack);

}  // namespace vantage::internal::query
