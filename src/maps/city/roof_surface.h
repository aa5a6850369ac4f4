// A footprint's triangles with the roof's height at every corner.
#pragma once

#include <string>
#include <vector>

#include "maps/city/grid_rings.h"
#include "maps/city/roof_profile.h"
#include "vantage/geometry.h"

namespace vantage::internal::city {

struct RoofSurface {
  std::vector<Vec2> points;     ///< scene frame
  std::vector<double> heights;  ///< of the roof there, above the eaves; 0 at a bulging roof's outline
  std::vector<Triangle> roof;   ///< counter-clockwise from above, onions' bulges excepted
  std::vector<Triangle> floor;  ///< counter-clockwise from above; with the same sides along the outline
  bool floor_is_roof = true;    ///< the two lists are the same: one height to every place
  std::string repair;           ///< as in CitySolid
};

/// `rings`: the footprint's, drawn apart. `form`: settled. The creases are as exact as their ends: no corner is more
/// than 0.1 mm (or a thousandth of the roof) off in height. Where the outline leaves out the highest place of the
/// profile, the roof is stretched to reach its height all the same.
RoofSurface roof_surface(const Footprint& footprint, const Grid& grid, const std::vector<GridRing>& rings,
                         const BuildingForm& form, const RoofFrame& frame);

}  // namespace vantage::internal::city
