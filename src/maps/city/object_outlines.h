// The outlines of one object of a map, for targets that are laid on the ground.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "maps/osm/extract.h"
#include "vantage/city.h"

namespace vantage::internal::city {

struct ObjectOutlines {
  bool is_area = false;             ///< the map has such an object, and it is an area or any closed way
  std::vector<Footprint> outlines;  ///< cleaned, in the frame
  std::string name;                 ///< its tag `name`; empty where it has none
};

/// The areas and closed ways of a map's region.
class MapOutlines {
 public:
  /// Throws what osm::read_extract throws.
  VANTAGE_INTERNAL_API MapOutlines(const std::filesystem::path& file, const CityRegion& region,
                                   const Progress& progress);

  /// `object`: "way/123"; nothing for a text that is not an id of an object.
  VANTAGE_INTERNAL_API std::optional<ObjectOutlines> of(const std::string& object, const geo::LocalFrame& frame) const;

 private:
  struct Rough {
    std::vector<osm::Polygon> polygons;
    std::string name;
  };
  std::map<osm::ObjectId, Rough> objects_;
};

}  // namespace vantage::internal::city
