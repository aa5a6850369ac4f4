// Where the boundary of a footprint touches itself in a point, a solid over it would have edges with four facets.
#pragma once

#include <vector>

#include "maps/city/grid_rings.h"

namespace vantage::internal::city {

/// Rings of the same space (inside to their left) that do not touch: at every point where they did, each wedge of space
/// there has a corner of its own, drawn 1 mm into it (farther where it is so sharp, or so crowded, that this is not
/// enough, up to 6 cm). The rings as they are when nothing touches. Throws Error(internal) when no distance will do.
std::vector<GridRing> drawn_apart(const std::vector<GridRing>& rings);

}  // namespace vantage::internal::city
