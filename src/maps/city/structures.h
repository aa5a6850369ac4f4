// Buildings and their parts in the plane: which part belongs to which outline, and what the parts leave uncovered.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "maps/osm/extract.h"

namespace vantage::internal::city {

/// A building or a building part.
struct Structure {
  const osm::Area* source = nullptr;
  bool is_part = false;
  std::vector<Footprint> footprints;  ///< empty: nothing with an area was left
  Repairs repairs;
  double area_m2 = 0;
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< bounds

  std::optional<std::size_t> outline;  ///< of a part: the structure that it belongs to
  std::vector<std::size_t> parts;      ///< of a building: the structures that lie in it
};

/// Those of the areas that are buildings or parts, in the frame's metres.
std::vector<Structure> structures_of(const std::vector<osm::Area>& areas, const geo::LocalFrame& frame);

/// What an area covers: its rings, cleaned, and the smallest rectangle round those that are incomplete, have no area or
/// are tangled (Repairs::enclosed). Empty only where it is beyond all bounds.
std::vector<Footprint> footprints_of(const osm::Area& area, const geo::LocalFrame& frame, Repairs& repairs);

/// Fills `outline` and `parts`. A part may replace every building that holds at least half of it, and the one that a
/// type=building relation names for it: outlines lie on one another where a block, a station or a mall is drawn as well
/// as the buildings in it. Its own outline is the one of the relation (of several the one that holds most of it), or
/// else the smallest.
void assign_parts(std::vector<Structure>& structures, const std::vector<osm::BuildingRelation>& relations);

/// What of a building none of these structures covers, seen from above. Less than 1 m2 in all, and than a tenth of the
/// building, comes of careless drawing and is left out.
std::vector<Footprint> uncovered(const Structure& building, const std::vector<Structure>& structures,
                                 const std::vector<std::size_t>& parts);

}  // namespace vantage::internal::city
