#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "app/find_ground.h"
#include "app/georeferencing.h"
#include "app/ground_room.h"
#include "app/input_file.h"
#include "app/links_section.h"
#include "app/navigation_meshes.h"
#include "app/tour_home.h"
#include "app/zone_files.h"
#include "common/input.h"
#include "core/places.h"
#include "core/solid_check.h"
#include "core/stopwatch.h"
#include "vantage/error.h"
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
    options.missing = MissingPolicy::warn;  // what would stand in must not be allowed
    if (named.up) options.up = *named.up;
    if (named.scale) options.scale = *named.scale;
    const Scene read = read_scene(named.file, options);
    mesh.keep_in.name = named.name;
    mesh.keep_in.mesh =
        internal::core::with_place(mesh.place, [&] { return internal::core::checked_solid(read.mesh, named.name); });
    mesh.in_scene_axes = is_obj(named.file) && !named.up && !read.states_axes;
    mesh.in_scene_unit = is_obj(named.file) && !named.scale && !read.states_axes;
    mesh.georeference = read.georeference;
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

/// Throws app::TerrainTooSmall.
Mission assembled(const MissionFile& file, const std::vector<internal::app::NavigationMesh>& meshes,
                  std::shared_ptr<const LoadedScene> loaded, const Progress& progress) {
  Mission mission;
  mission.as_written = file;
  mission.loaded = std::move(loaded);
  mission.target = file.targets.front().target;
  mission.sensor = file.sensor;
  mission.navigation = file.navigation;
  mission.navigation.meshes = internal::app::placed_navigation_meshes(meshes, mission.scene());
  internal::app::georeference(mission, progress);
  internal::app::place_home(mission);
  internal::app::georeference_limits(mission);
  internal::app::add_file_zones(mission, progress);
  internal::app::find_ground(mission);
  internal::app::find_obstacles(mission);
  internal::app::place_links(mission);
  return mission;
}

std::shared_ptr<const LoadedScene> load(const SceneSource& source, const Progress& progress) {
  return std::make_shared<const LoadedScene>(load_scene(source, progress));
}

/// `loaded`: null where it is to be loaded.
Mission resolved(const MissionFile& file, std::shared_ptr<const LoadedScene> loaded, const Progress& progress) {
  if (file.targets.empty()) {
    throw Error(ErrorCode::nothing_given, "the mission has no target", file.file.string(), "give it one or more");
  }
  const internal::core::Stopwatch stopwatch;
  const std::vector<internal::app::NavigationMesh> meshes = read_navigation_meshes(file);
  Mission mission;
  try {
    mission = assembled(file, meshes, loaded ? std::move(loaded) : load(file.scene, progress), progress);
  } catch (const internal::app::TerrainTooSmall& terrain) {
    const double farther = std::ceil(terrain.missing_m) + 1;
    SceneSource larger = file.scene;
    larger.city.ground_margin_m += farther;
    mission = assembled(file, meshes, load(larger, progress), progress);
    mission.notes.insert(
        mission.notes.begin(),
        {WarningCode::ground_extended, "the ground was built " + std::to_string(std::lround(farther)) +
                                           " m farther to hold the target: the map has nothing to build out there"});
  }
  mission.read_seconds = stopwatch.seconds();
  return mission;
}

}  // namespace

Mission resolve_mission(const MissionFile& file, const Progress& progress) { return resolved(file, {}, progress); }

Mission resolve_mission(const MissionFile& file, std::shared_ptr<const LoadedScene> loaded, const Progress& progress) {
  if (!loaded) {
    throw Error(ErrorCode::nothing_given, "there is no scene to resolve the mission in", file.file.string(),
                "pass a scene, or nothing for the one that the mission names");
  }
  return resolved(file, std::move(loaded), progress);
}

}  // namespace vantage
