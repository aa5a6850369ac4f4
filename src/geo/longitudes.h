// Longitudes as places on a circle: which of the two arcs between them holds the data.
#pragma once

#include <cmath>

namespace vantage::internal::geo {

/// From `west` eastwards to `east`, degrees in -180 to 180; west > east: across the antimeridian.
struct LongitudeRange {
  double west = 0, east = 0;

  double width_deg() const { return west <= east ? east - west : east - west + 360; }
  double middle_deg() const {  ///< in -180 to 180
    if (west <= east) return (west + east) / 2;
    return std::remainder(west + width_deg() / 2, 360);
  }
  bool holds(double longitude_deg) const {
    const bool from_west = longitude_deg >= west, to_east = longitude_deg <= east;
    return west <= east ? from_west && to_east : from_west || to_east;
  }
  bool meets(const LongitudeRange& other) const { return holds(other.west) || holds(other.east) || other.holds(west); }
};

}  // namespace vantage::internal::geo
