// The outlines of one object of a map, for targets that are laid on the ground.
#pragma once

#include <filesystem>
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

/// `object`: "way/123"; nothing for a text that is not an id of an object. Throws what osm::read_extract throws.
VANTAGE_INTERNAL_API std::optional<ObjectOutlines> outlines_of_object(const std::filesystem::path& file,
                                                                      const CityRegion& region,
                                                                      const std::string& object,
                                                                      const geo::LocalFrame& frame,
                                                                      const Progress& progress);

}  // namespace vantage::internal::city
