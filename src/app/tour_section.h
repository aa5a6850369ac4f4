// The section `tour` of a mission file.
#pragma once

#include <string>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/tour_settings.h"

namespace vantage::internal::app {

/// Throws Error(input) with the place in the file for an unknown key, a wrong type and a value out of range.
TourSettings parse_tour(const YamlNode& node, const ValueReader& reader);

/// The text of the section, which parse_tour reads back as the same; every key is written.
std::string tour_section_text(const TourSettings& tour);

}  // namespace vantage::internal::app
