// The last resort: planes through corners and along edges, with more digits than a double has.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "prove/fine.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// A direction in whole numbers along which all of the hull of `points` lies farther than all of `polygon`, whatever
/// was rounded: sets that are apart are so along the normal of a face of one of them, or across an edge of each.
/// `points` as they are stored; `polygon` less than `largest` away, as its numbers are. Nothing where none is found.
std::optional<std::array<std::int64_t, 3>> find_corner_plane(std::span<const Vec3> points,
                                                             std::span<const FineVec3> polygon, double largest);

}  // namespace vantage::internal::prove
