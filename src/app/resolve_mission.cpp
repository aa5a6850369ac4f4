#include <cmath>
#include <string>
#include <utility>

#include "app/components/solid.h"
#include "app/find_ground.h"
#include "app/georeferencing.h"
#include "app/ground_room.h"
#include "app/input_file.h"
#include "app/navigation_meshes.h"
#include "app/places.h"
#include "app/zone_files.h"
#include "core/stopwatch.h"
#include "vantage/error.h"
#include "vantage/input.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

/// The navigation meshes, checked, in the axes and the unit that their files and the mission say. What they leave to
/// the scene's file is settled by app::place_navigation_meshes.
std::vector<internal::app::NavigationMesh> read_navigation_meshes(const MissionFile& mission) {
  std::vector<internal::app::NavigationMesh> meshes;
  for (std::size_t i = 0; i < mission.navigation_meshes.size(); ++i) {
    const NavigationMeshFile& named = mission.navigation_meshes[i];
    internal::app::NavigationMesh mesh;
    if (i < mission.places.navigation_meshes.size()) mesh.place = mission.places.navigation_meshes[i];
    SceneReadOptions options;
    if (named.up) options.up = *named.up;
    if (named.scale) options.scale = *named.scale;
    const Scene read = read_scene(named.file, options);
    mesh.keep_in.name = named.name;
    mesh.keep_in.mesh =
        internal::app::with_place(mesh.place, [&] { return internal::app::checked_keep_in(read.mesh, named.name); });
    mesh.in_scene_axes = is_obj(named.file) && !named.up && !read.states_axes;
    mesh.in_scene_unit = is_obj(named.file) && !named.scale && !read.states_axes;
    mesh.georeference = read.georeference;
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

/// Throws app::TerrainTooSmall.
Mission assembled(const MissionFile& file, const std::vector<internal::app::NavigationMesh>& meshes, LoadedScene loaded,
                  const Progress& progress) {
  Mission mission{file, std::move(loaded), file.target, {}, file.sensor, file.navigation, 0};
  mission.navigation.meshes = internal::app::placed_navigation_meshes(meshes, mission.loaded.scene);
  internal::app::georeference(mission, progress);
  internal::app::add_file_zones(mission, progress);
  internal::app::find_ground(mission);
  internal::app::find_obstacles(mission);
  return mission;
}

}  // namespace

Mission resolve_mission(const MissionFile& file, const Progress& progress) {
  const internal::core::Stopwatch stopwatch;
  const std::vector<internal::app::NavigationMesh> meshes = read_navigation_meshes(file);
  const auto finished = [&](Mission mission) {
    mission.read_seconds = stopwatch.seconds();
    return mission;
  };
  try {
    return finished(assembled(file, meshes, load_scene(file.scene, progress), progress));
  } catch (const internal::app::TerrainTooSmall& terrain) {
    const double farther = std::ceil(terrain.missing_m) + 1;
    SceneSource larger = file.scene;
    larger.city.ground_margin_m += farther;
    LoadedScene loaded = load_scene(larger, progress);
    loaded.notes.push_back(
        {WarningCode::ground_extended, "the ground was built " + std::to_string(std::lround(farther)) +
                                           " m farther to hold the target: the map has nothing to build out there"});
    return finished(assembled(file, meshes, std::move(loaded), progress));
  }
}

}  // namespace vantage
