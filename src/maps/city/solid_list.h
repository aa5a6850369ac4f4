// From a site to checked solids.
#pragma once

#include <vector>

#include "maps/city/ground.h"
#include "maps/city/site.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage::internal::city {

/// One mesh per item, on the ground; fills the records' heights, repairs and faults. Every shape of an item is checked
/// to be closed, outward-oriented and free of self-intersection; shapes of one item may overlap, as a wall's pieces do.
/// An item with a shape that is not a solid is built again with flat roofs, as a named repair; if that fails too it
/// stays as it is, an open surface, and the record says why. Uses the threads of the caller's arena. Throws
/// Error(cancelled).
std::vector<Mesh> build_solids(Site& site, const Ground& ground, const Progress& progress);

}  // namespace vantage::internal::city
