
#include "mission/input_file.h"
#include "mission/mission_parser.h"
#include "mission/run_mission.h"
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

}  // namespace

Mission read_mission(const fs::path& file) {
  mission_io::check_readable(file, "the mission file", "");
  mission_io::ParsedMission parsed = mission_io::parse_mission(mission_io::read_text(file, "mission file"), file);
  mission_io::check_readable(parsed.scene.file, "the scene's mesh file", parsed.scene.where);
  parsed.mission.scene_file = with_true_folder(parsed.scene.file);
  for (const mission_io::MeshReference& reference : parsed.navigation_meshes) {
    mission_io::check_readable(reference.file, "the navigation mesh", reference.where);
    const Scene scene = read_scene(reference.file, reference.options);
    parsed.mission.navigation.meshes.push_back(
        {mission_io::with_place(reference.where, [&] { return solid::checked_solid(scene.mesh, reference.name); }),
         reference.name});
    parsed.mission.navigation_files.push_back(with_true_folder(reference.file));
  }
  return std::move(parsed.mission);
}

}  // namespace vantage
