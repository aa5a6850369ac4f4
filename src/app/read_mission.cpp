
#include <cmath>

#include "app/ground_room.h"
#include "app/input_file.h"
#include "app/into_frame.h"
#include "app/mission_parser.h"
#include "app/placing.h"
#include "app/run_mission.h"
#include "solid/solid_check.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Without links and dots in the folder; the name stays, since the format may show in it alone.
fs::path with_true_folder(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::canonical(file.parent_path(), error);
  return error ? file : folder / file.filename();
}

const char* what_of(SceneSource::Kind kind) {
  switch (kind) {
    case SceneSource::Kind::mesh:
      return "the scene's mesh file";
    case SceneSource::Kind::map:
      return "the scene's map";
    case SceneSource::Kind::raster:
      return "the scene's raster";
  }
  return "the scene's file";
}

}  // namespace

Mission read_mission(const fs::path& file) {
  app::check_readable(file, "the mission file", "");
  return read_mission_text(app::read_text(file, "mission file"), file);
}

Mission read_mission_text(std::string_view text, const fs::path& file) {
  app::ParsedMission parsed = app::parse_mission(text, file);
  SceneSource& scene = parsed.mission.scene;
  app::check_readable(scene.file, what_of(scene.kind), parsed.scene_where);
  scene.file = with_true_folder(scene.file);
  if (!scene.city.terrain.empty()) {
    app::check_readable(scene.city.terrain, "the terrain", parsed.terrain_where);
    scene.city.terrain = with_true_folder(scene.city.terrain);
  }
  for (const app::MeshReference& reference : parsed.navigation_meshes) {
    app::check_readable(reference.file, "the navigation mesh", reference.where);
    const Scene limit = read_scene(reference.file, reference.options);
    parsed.mission.navigation.meshes.push_back(
        {app::with_place(reference.where, [&] { return solid::checked_solid(limit.mesh, reference.name); }),
         reference.name});
    parsed.mission.navigation_files.push_back({with_true_folder(reference.file), reference.where,
                                               reference.in_scene_axes && !limit.states_axes,
                                               reference.in_scene_unit && !limit.states_axes, limit.georeference});
  }
  return std::move(parsed.mission);
}

LoadedScene read_mission_scene(Mission& mission, const Progress& progress) {
  LoadedScene loaded = load_scene(mission.scene, progress);
  app::place_navigation_meshes(mission, loaded.scene);
  try {
    app::place_mission(mission, loaded, progress);
  } catch (const app::TerrainTooSmall& terrain) {
    const double farther = std::ceil(terrain.missing_m) + 1;
    mission.scene.city.ground_margin_m += farther;
    loaded = load_scene(mission.scene, progress);
    loaded.notes.push_back("the ground was built " + std::to_string(std::lround(farther)) +
                           " m farther to hold the target: the map has nothing to build out there");
    app::place_mission(mission, loaded, progress);
  }
  return loaded;
}

}  // namespace vantage
