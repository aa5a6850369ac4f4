#include "app/input_file.h"
#include "app/mission_parser.h"
#include "vantage/error.h"
#include "vantage/input.h"
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

void check_scene(MissionFile& mission) {
  SceneSource& scene = mission.scene;
  check_readable(scene.file, what_of(scene.kind), mission.places.scene);
  scene.file = with_true_folder(scene.file);
  if (!scene.city.terrain.empty()) {
    check_readable(scene.city.terrain, "the terrain", mission.places.terrain);
    scene.city.terrain = with_true_folder(scene.city.terrain);
  }
}

/// The files that navigation limits name.
void check_limits(MissionFile& mission) {
  for (std::size_t i = 0; i < mission.navigation_meshes.size(); ++i) {
    fs::path& mesh = mission.navigation_meshes[i].file;
    check_readable(mesh, "the navigation mesh", mission.places.navigation_meshes[i]);
    mesh = with_true_folder(mesh);
  }
  const auto check_zones = [](std::vector<ZoneFile>& files, const std::vector<std::string>& places) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      check_readable(files[i].file, "the file of zones", places[i]);
      files[i].file = with_true_folder(files[i].file);
    }
  };
  check_zones(mission.keep_in_files, mission.places.keep_in_files);
  check_zones(mission.keep_out_files, mission.places.keep_out_files);
}

}  // namespace

MissionFile read_mission(const fs::path& file) {
  check_readable(file, "the mission file", "");
  return read_mission_text(internal::app::read_text(file, "mission file"), file);
}

MissionFile read_mission_text(std::string_view text, const fs::path& file) {
  MissionFile mission = internal::app::parse_mission(text, file);
  check_scene(mission);
  check_limits(mission);
  return mission;
}

MissionFile read_mission_text(std::string_view text, const fs::path& file, const SceneSource& source) {
  MissionFile mission = internal::app::parse_mission(text, file, &source);
  check_limits(mission);
  return mission;
}

MissionFile read_scene_text(std::string_view text, const fs::path& file) {
  MissionFile mission = internal::app::parse_scene(text, file);
  check_scene(mission);
  return mission;
}

std::vector<fs::path> input_files(const MissionFile& mission) {
  std::vector<fs::path> files = {mission.file, mission.scene.file};
  if (!mission.scene.city.terrain.empty()) files.push_back(mission.scene.city.terrain);
  for (const NavigationMeshFile& mesh : mission.navigation_meshes) files.push_back(mesh.file);
  for (const ZoneFile& zones : mission.keep_in_files) files.push_back(zones.file);
  for (const ZoneFile& zones : mission.keep_out_files) files.push_back(zones.file);
  return files;
}

}  // namespace vantage
