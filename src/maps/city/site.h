// Everything that is to be built, in the frame's metres, before it becomes solid.
#pragma once

#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "maps/city/occluders.h"
#include "maps/city/region.h"
#include "maps/osm/extract.h"
#include "maps/osm/region_filter.h"
#include "vantage/city.h"

namespace vantage::internal::city {

/// Why an object is not built as the map has it, for the ledger.
struct Fault {
  std::string reason;   ///< "its ring is open at 7.41, 1.11"
  std::string instead;  ///< "its outline without holes"; may be empty
  bool may_be_larger = false;
};

/// One object of the scene.
struct Item {
  CityRecord record;          ///< heights are filled when it is built
  std::vector<Shape> shapes;  ///< each becomes a closed piece
  enum class Stand {
    together,  ///< on the lowest ground under `standing`; what stands in goes on to above the highest
    each,      ///< each shape on the ground under it: trees, and walls, which go on to above the highest of it
    above      ///< on the highest ground under `standing`: bridges
  } stand = Stand::together;
  std::vector<Footprint> standing;  ///< of a part its building's outline; empty: the shapes' footprints
  std::vector<Fault> faults;        ///< with any it is in the ledger
  LedgerEntry entry;                ///< what of it the map says; the rest is filled when it is built
};

/// A line overhead, for clearance alone.
struct Overhead {
  SceneObject object;
  std::vector<Vec2> points;
  double height_m = 0;  ///< of its supports above the ground
};

struct Site {
  std::vector<Overhead> overhead;
  std::vector<Item> items;
  std::vector<CityPassedOver> passed_over;
  std::vector<LedgerEntry> lost;  ///< what stands there as the map says, and nothing stands in for
  Outside outside;
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< bounds of the footprints

  /// What is made of an object depends on no others than these: what belongs to a building or a part that meets it,
  /// none of which is larger across than so many metres. Nor is any shape so far from where its object is drawn.
  double reach_m = 0;
};

/// Why the objects of a site that has nothing to build are not built; one for each.
std::vector<std::string> reasons_of(const Site& site);

/// Buildings and parts by Simple 3D Buildings, and the other occluders that are switched on. An object belongs to the
/// region when some of it does, as it is drawn or as it is built, and a building with all its parts when some of them
/// does.
Site make_site(const osm::Extract& extract, const osm::RegionFilter& region, const geo::LocalFrame& frame,
               const CityOptions& options);

}  // namespace vantage::internal::city
