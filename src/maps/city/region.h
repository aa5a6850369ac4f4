// The part of the map that is asked for: checks, and what is said when it holds nothing.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "maps/osm/extract.h"
#include "maps/osm/region_filter.h"
#include "vantage/city.h"

namespace vantage::internal::city {

/// Throws Error(input) for what cannot be right in any file: numbers out of range, no area, circle and box at once.
std::optional<osm::Region> checked_region(const CityRegion& region);

/// More than any part lies from the rest of its building, metres, but for a few.
constexpr double kMargin = 300;

/// What to read so that every building of the region comes with all its parts: a margin round it.
std::optional<osm::Region> with_margin(const std::optional<osm::Region>& region, double margin_m = kMargin);

/// Throws Error(input) where the region lies outside the file (its bounds; latitude and longitude the wrong way round).
void check_overlap(const CityRegion& region, const osm::Extract& extract, const std::filesystem::path& file);

/// Throws Error(input) where the file says itself that it is not complete.
void check_complete(const osm::Extract& extract, const std::filesystem::path& file);

/// Whether some of what is built lies in the region: a side of it, or the region's centre in it.
bool reaches_into(const osm::RegionFilter& region, const std::vector<Footprint>& built, const geo::LocalFrame& frame);

/// What was read and does not belong to the region.
struct Outside {
  std::size_t objects = 0;
  double nearest_m = 0;  ///< from the region's centre; 0 when there are none

  void add(std::size_t more, double nearest);
};

/// Says what the region lacks: how far the nearest object outside is, and why what was read of it is not built.
/// `reasons`: one for each object.
[[noreturn]] void fail_empty(const CityRegion& region, const osm::Extract& extract, const Outside& outside,
                             const std::vector<std::string>& reasons, const std::filesystem::path& file);

/// Origin of the frame: the middle of what is asked for, or else of the areas that were read.
geo::LonLat frame_origin(const CityRegion& region, const osm::Extract& extract);

}  // namespace vantage::internal::city
