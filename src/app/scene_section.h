// The section `scene` of a mission: a mesh, a map or a raster, and how it is read.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "app/value_reader.h"
#include "vantage/scene_source.h"

namespace vantage::internal::app {

struct SceneSection {
  SceneSource source;                 ///< paths start from the mission's folder
  std::optional<double> sea_level_m;  ///< scene z of the mean sea level
  std::string where;                  ///< "mission.yaml:3:9": of the file's name
  std::string terrain_where;          ///< likewise; empty without terrain
};

SceneSection parse_scene_section(const YamlNode& node, const ValueReader& reader, const std::filesystem::path& folder);

UpAxis parse_up_axis(const YamlNode& node, const ValueReader& reader, const std::string& what);

/// "[latitude, longitude]" in degrees, in range.
std::array<double, 2> parse_lat_lon(const YamlNode& node, const ValueReader& reader, const std::string& what);

}  // namespace vantage::internal::app
