// Regions that are built as parts of their whole map.
#pragma once

#include <array>
#include <optional>

#include "geo/local_frame.h"
#include "maps/city/site.h"
#include "maps/osm/extract.h"
#include "vantage/city.h"

namespace vantage::internal::city {

/// Throws Error(input) for a frame with numbers that are out of range, and for terrain beside it.
void check_frame(const CityOptions& options);

/// The bounds of the whole map's ground, at z = 0.
Box bounds_of_whole(const CityFrame& frame);

/// A rectangle of the frame that holds a region: larger than need be by 2 m, and by what the samples of its sides may
/// miss of their curvature.
PlanBounds plan_bounds(const osm::Region& region, const geo::LocalFrame& frame);

/// Degrees, west, south, east, north, that hold a rectangle of the frame; larger in the same way. Throws Error(input)
/// where that is round a pole.
std::array<double, 4> degrees_round(const PlanBounds& bounds, const geo::LocalFrame& frame);

/// Takes out what does not meet the region, if there is one.
void leave_out_beyond(const std::optional<osm::Region>& region, const geo::LocalFrame& frame, Site& site);

}  // namespace vantage::internal::city
