// The areas of a map, as targets: every parking lot, every pitch.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "vantage/city.h"
#include "vantage/export.h"
#include "vantage/progress.h"

namespace vantage {

/// A tag that an area must have.
struct AreaTag {
  std::string key;    ///< "amenity"
  std::string value;  ///< "parking"; empty: any but "no"
};

/// "amenity=parking", or "amenity=*" for any value but "no". The key ends at the first '='. Throws Error(input), with
/// `where`, for a text without '=', without a key or without a value.
VANTAGE_API AreaTag area_tag(const std::string& text, const std::string& where);

/// Which areas are listed: those of which all of this holds.
struct AreaFilter {
  std::vector<AreaTag> tags;  ///< all of these; none: any tags
  bool named = false;         ///< only those with a name
  CityRegion region;          ///< an area belongs to it when some of it does; default: all of the map
};

/// Degrees, WGS 84; rings are open: the first position is not repeated.
struct AreaPolygon {
  using Ring = std::vector<std::array<double, 2>>;  ///< longitude, latitude
  Ring outer;                                       ///< counter-clockwise
  std::vector<Ring> holes;                          ///< clockwise
};

/// A closed way or a multipolygon of a map.
struct MapArea {
  std::string source_id;                                  ///< "way/265517", "relation/5": what a target's `osm` takes
  std::string name;                                       ///< its tag `name`; may be empty
  std::vector<std::pair<std::string, std::string>> tags;  ///< in the order of the file
  std::vector<AreaPolygon> polygons;                      ///< at least one
  std::array<double, 2> center_deg{};                     ///< latitude, longitude of the middle of its bounds
  double area_m2 = 0;                                     ///< holes taken off
};

/// The areas of an OpenStreetMap file (.osm, .osm.gz, .osm.bz2, .osm.pbf) that `filter` wants, by type and id, each
/// once. Areas are closed ways and multipolygons whose tags bound an area (docs/python-areas.md); closed ways that are
/// lines, as a wall round a garden, are not listed. Neither are outlines that bound less than 0.01 m2, since they can be
/// no target. Memory: 24 bytes for each node of the file, and what is wanted. Cost: the file is read twice; a third and a
/// fourth time to explain why there is none.
///
/// Throws Error(input) for what build_city refuses in files and regions, and with ErrorCode::map_object_missing where
/// no area is wanted: it says which tag no area has, and the nearest that areas have. Error(cancelled) when told to
/// stop.
VANTAGE_API std::vector<MapArea> read_areas(const std::filesystem::path& file, const AreaFilter& filter = {},
                                            const Progress& progress = {});

}  // namespace vantage
