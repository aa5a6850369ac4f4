// The outlines of one object of a map, for targets that are laid on the ground.
#pragma once

#include <filesystem>

#include "app/providers/maps.h"
#include "vantage/city.h"

namespace vantage::internal::city {

using app::NamedOutline;
using app::ObjectOutlines;
using app::OutlineFinder;

/// Reads them. Throws what osm::read_extract throws.
OutlineFinder find_outlines(const std::filesystem::path& file, const CityRegion& region, const Progress& progress);

}  // namespace vantage::internal::city
