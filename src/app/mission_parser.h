// The mission file's text -> MissionFile, without touching any other file.
#pragma once

#include <filesystem>
#include <string_view>

#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Parses and checks the text of a mission file. `file` gives the folder that relative paths start from and the name in
/// messages; it is not opened. With `source` the text has no scene, and this is what the scene was loaded from. Throws
/// as read_mission does, but for what only the named files can tell.
MissionFile parse_mission(std::string_view text, const std::filesystem::path& file,
                          const SceneSource* source = nullptr);

/// Of a text that has a scene and nothing else.
MissionFile parse_scene(std::string_view text, const std::filesystem::path& file);

}  // namespace vantage::internal::app
