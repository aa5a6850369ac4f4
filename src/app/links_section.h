// The section `links` of a mission file.
#pragma once

#include <string>
#include <vector>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Throws Error(input) with the place in the file for an unknown key, a wrong type, a value out of range, and two links
/// of one name.
std::vector<MissionLink> parse_links(const YamlNode& node, const ValueReader& reader);

/// The text of the section, which parse_links reads back as the same; nothing where there are none.
std::string links_section_text(const std::vector<MissionLink>& links);

/// Sets `mission.links`; the ground must have been found. Throws Error(input) with the place of the link as place_home
/// does.
void place_links(Mission& mission);

}  // namespace vantage::internal::app
