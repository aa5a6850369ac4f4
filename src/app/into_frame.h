// Meshes that go with a scene but come from files of their own: volumes, navigation limits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::app {

struct MeshInFrame {
  Mesh mesh;
  std::optional<Georeference> georeference;  ///< as the file says
  double rounding_m = 0;                     ///< as the file says: Scene::rounding_m
  std::vector<std::string> notes;            ///< for people: that it was moved, that its heights do not fit
};

/// Reads a mesh into a scene's frame. OBJ is in the axes and the unit of `obj`, other formats say it themselves. A mesh
/// that says where on the earth it lies is moved about the origin of `frame`, where there is one; any other is taken to
/// be in the frame. Heights stay as they are. Throws as read_scene does.
MeshInFrame read_into_frame(const std::filesystem::path& file, const SceneReadOptions& obj,
                            const std::optional<Georeference>& frame, const Progress& progress);

/// The same for what `compute` has written of a scene: OBJ as the scene's own file.
MeshInFrame read_into_frame(const std::filesystem::path& file, const Scene& scene, const Progress& progress);

/// Settles what read_mission leaves open of navigation meshes (see NavigationFile). Throws Error(input) for one whose
/// heights are measured from another level than the scene's.
void place_navigation_meshes(Mission& mission, const Scene& scene);

}  // namespace vantage::app
