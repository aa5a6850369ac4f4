// Zones of KML.
#pragma once

#include <filesystem>
#include <string_view>

#include "app/zone_file.h"

namespace vantage::internal::app {

/// parse_zones of a text in XML. `file` is for messages. In builds without Expat it throws Error(component_missing).
ZoneList parse_kml_zones(std::string_view text, const std::filesystem::path& file,
                         const core::ProgressReporter& progress);

}  // namespace vantage::internal::app
