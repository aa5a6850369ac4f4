// What missions need of maps and rasters. The library vantage_maps provides it, once the application has called
// enable_maps(): an application without maps links neither that library nor what it stands on.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/footprint.h"
#include "geo/local_frame.h"
#include "vantage/city.h"
#include "vantage/export.h"
#include "vantage/ground.h"

namespace vantage::internal::app {

struct ObjectOutlines {
  bool is_area = false;                   ///< the map has such an object, and it is an area or any closed way
  std::vector<core::Footprint> outlines;  ///< cleaned, in the frame
  std::string name;                       ///< its tag `name`; empty where it has none
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

struct ConvexArea {
  core::Ring outer;
  std::vector<core::Ring> pieces;  ///< convex; they cover it
};

/// What state outlines are in.
enum class Outlines { clean, rough };

/// The functions of vantage_maps with these names.
struct MapProvider {
  City (*build_city)(const std::filesystem::path& file, const CityOptions& options, const Progress& progress);
  RasterScene (*scene_from_raster)(const std::filesystem::path& file, const RasterOptions& options,
                                   const Progress& progress);
  void (*add_terrain)(Scene& scene, const std::filesystem::path& raster, const TerrainOptions& options,
                      const Progress& progress);
  OutlineFinder (*find_outlines)(const std::filesystem::path& file, const CityRegion& region, const Progress& progress);
  std::vector<ConvexArea> (*convex_areas)(const std::vector<core::Footprint>& footprints, Outlines state);
};

/// From now on missions use it. It must last as long as the program.
VANTAGE_INTERNAL_API void provide(const MapProvider& provider);

/// What was provided. Throws Error(component_missing) where nothing was; `what` cannot be done then: "rasters".
const MapProvider& map_provider(const std::string& what, const std::string& where);

}  // namespace vantage::internal::app
