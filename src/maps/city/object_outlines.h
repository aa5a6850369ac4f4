// The outlines of one object of a map, for targets that are laid on the ground.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "vantage/city.h"

namespace vantage::internal::city {

struct ObjectOutlines {
  bool is_area = false;             ///< the map has such an object, and it is an area or any closed way
  std::vector<Footprint> outlines;  ///< cleaned, in the frame
  std::string name;                 ///< its tag `name`; empty where it has none
};

struct NamedOutline {
  std::string name, id;
  bool is_line = false;  ///< a closed way that bounds no area: a street round a square
};

/// The areas and closed ways of a map's region, to be asked for any number of times, by any number of threads.
struct OutlineFinder {
  /// The outlines of an object, "way/123"; nothing for a text that is not an id of an object.
  std::function<std::optional<ObjectOutlines>(const std::string& object, const geo::LocalFrame& frame)> of;
  /// All that have a tag `name`, by id.
  std::function<std::vector<NamedOutline>()> named;
};

/// Reads them. Throws what osm::read_extract throws.
VANTAGE_INTERNAL_API OutlineFinder find_outlines(const std::filesystem::path& file, const CityRegion& region,
                                                 const Progress& progress);

}  // namespace vantage::internal::city
