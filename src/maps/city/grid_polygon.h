// Polygons with holes on the grid of footprints: their areas, what lies in what, and what is too small to build.
#pragma once

#include <cstddef>
#include <vector>

#include "maps/city/grid_rings.h"

namespace vantage::internal::city {

struct GridPolygon {
  GridRing outer;  ///< turned whichever way
  std::vector<GridRing> holes;
};

double perimeter(const GridRing& ring);      ///< in units of the grid, as all below
double area_of(const GridPolygon& polygon);  ///< holes taken off
double area_of(const std::vector<GridPolygon>& polygons);
std::vector<GridRing> rings_of(const std::vector<GridPolygon>& polygons);
GridRing turned(GridRing ring, bool counter_clockwise);

/// How close to a straight line a point is taken to lie on it.
enum class Straight { exact, within_a_unit };
/// Whether the tip of a spike goes, or only one whose ends are one point.
enum class Spikes { removed, kept };
/// Without points that say nothing: repeated ones, those on a straight line, tips of spikes. Empty when fewer than
/// three are left.
GridRing tidied(const GridRing& ring, Straight straight = Straight::within_a_unit, Spikes spikes = Spikes::removed);
/// The same of polygons; as they are where sides would cross then.
std::vector<GridPolygon> tidied(const std::vector<GridPolygon>& polygons);

/// Polygons from rings that do not cross: inside is what lies in an odd number of them.
std::vector<GridPolygon> nested(const std::vector<GridRing>& rings);
/// Whether every hole lies in the outer ring and in no other hole, for rings that neither cross nor touch.
bool is_nested(const GridPolygon& polygon);

/// Takes out what is too small to build, holes too: Repairs::slivers. Returns how many.
std::size_t drop_slivers(std::vector<GridPolygon>& polygons);

GridPolygon to_polygon(const Footprint& footprint, const Grid& grid);
std::vector<Footprint> to_footprints(const std::vector<GridPolygon>& polygons, const Grid& grid);

}  // namespace vantage::internal::city
