// The mission file's text -> Mission, without touching any other file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::app {

/// A mesh file that a mission names.
struct MeshReference {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< as written in the mission
  SceneReadOptions options;
  bool in_scene_axes = false,
       in_scene_unit = false;  ///< as NavigationFile says; `options` then leaves them as they are
  std::string where;           ///< "mission.yaml:12:13", for messages
};

struct ParsedMission {
  Mission mission;                         ///< complete but for the navigation meshes
  std::string scene_where, terrain_where;  ///< "mission.yaml:3:9": of the names of the scene's files
  std::vector<MeshReference> navigation_meshes;
};

/// Parses and checks the text of a mission file. `file` gives the folder that relative paths start from and the name in
/// messages; it is not opened. Throws as read_mission does, but for what only the named files can tell.
ParsedMission parse_mission(std::string_view text, const std::filesystem::path& file);

}  // namespace vantage::app
