// Outlines that cross themselves, made simple.
#pragma once

#include <vector>

#include "maps/city/grid_polygon.h"

namespace vantage::internal::city {

/// Whether sides cross one another more often than drawing explains. What is made of them would take time with the
/// square of the crossings, and look like nothing. `closed`: rings, not lines.
bool is_tangled(const std::vector<GridRing>& rings, bool closed = true);

/// Whether a ring runs back along a side of its own, as it does where two corners were swapped.
bool has_spike(const GridRing& ring);

/// Round each place where sides of a ring cross, or touch other than in the corner between them, the hull of the two
/// sides and of those next to them: if two corners that follow each other were swapped, what the ring should hold lies
/// in there.
std::vector<GridPolygon> crossing_hulls(const GridRing& ring);

/// The space that the outer ring goes round, less that of the holes. The rings are tidied.
std::vector<GridPolygon> repaired(const GridPolygon& rough, Repairs& repairs);

}  // namespace vantage::internal::city
