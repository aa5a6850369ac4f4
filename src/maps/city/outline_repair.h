// Outlines that cross themselves, made simple.
#pragma once

#include <vector>

#include "maps/city/grid_polygon.h"

namespace vantage::internal::city {

/// Whether sides cross one another more often than drawing explains. What is made of them would take time with the
/// square of the crossings, and look like nothing. `closed`: rings, not lines.
bool is_tangled(const std::vector<GridRing>& rings, bool closed = true);

/// The space that the outer ring goes round an odd number of times, less that of the holes. The rings are tidied.
std::vector<GridPolygon> repaired(const GridPolygon& rough, Repairs& repairs);

}  // namespace vantage::internal::city
