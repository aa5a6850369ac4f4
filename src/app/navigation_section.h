// The section 'navigation' of a mission file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

struct NavigationSection {
  Navigation navigation;  ///< without meshes; zones are named by their place in the list: "0", "1"
  std::optional<GroundSource> ground;
  std::vector<NavigationMeshFile> meshes;
  std::vector<ZoneFile> keep_in_files, keep_out_files;
  MissionPlaces places;  ///< of all these
};

/// Paths start from `folder`. Zones are checked as they are written. Throws Error(input) with the place for what
/// docs/mission-file.md does not allow.
NavigationSection parse_navigation_section(const YamlNode& node, const ValueReader& reader,
                                           const std::filesystem::path& folder);

}  // namespace vantage::internal::app
