// How the polygons of a part of a larger scene are grouped.
#pragma once

namespace vantage::internal::core {

/// The side of the squares in which polygons are indexed together, metres. Larger squares make better hierarchies; but
/// a part must be complete almost three squares beyond what targets can reach: src/maps/city/tiles.cpp.
inline constexpr double kGroupSide = 64;

}  // namespace vantage::internal::core
