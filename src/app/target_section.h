// A target as a mission file gives it.
#pragma once

#include <string>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// `mission`: with its scene and its `crs`. Throws Error(input) with the place for what docs/mission-file.md does not
/// allow, and for what make_target_frame refuses.
MissionTarget parse_target_section(const YamlNode& node, const ValueReader& reader, const MissionFile& mission);

/// "south"; "200 degrees from north".
std::string heading_text(double heading_deg);

}  // namespace vantage::internal::app
