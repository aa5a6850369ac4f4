// The closed surface that stands for a tree.
#pragma once

#include "maps/city/occluders.h"
#include "vantage/geometry.h"

namespace vantage::internal::city {

/// Needs 0 < trunk_m < crown_m and bottom_m < top_m.
Mesh tree_mesh(const Tree& tree, double ground_m);

}  // namespace vantage::internal::city
