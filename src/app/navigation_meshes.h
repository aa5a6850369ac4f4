// Meshes of navigation limits, which come from files of their own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// A mesh to stay in, as its file and the mission say.
struct NavigationMesh {
  KeepInMesh keep_in;
  std::string place;                         ///< "mission.yaml:9:13", for messages
  bool in_scene_axes = false;                ///< the mesh is in the axes of the scene's file: OBJ
  bool in_scene_unit = false;                ///< likewise
  std::optional<Georeference> georeference;  ///< of the frame that it is in, as its file says
};

/// In the frame of the scene. Throws Error(input) for one whose heights are measured from another level than the
/// scene's.
std::vector<KeepInMesh> placed_navigation_meshes(const std::vector<NavigationMesh>& meshes, const Scene& scene);

}  // namespace vantage::internal::app
