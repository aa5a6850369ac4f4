// Missions in a program without the libraries for maps and pictures: they are read, written and run, and what needs one
// of these is refused.
#include <cstdio>
#include <string>

#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace {

/// Whether running a mission is refused for want of `library`.
bool is_refused(const std::string& text, const std::string& folder, const std::string& library) try {
  vantage::run_mission(vantage::resolve_mission(vantage::read_mission_text(text, folder + "/mission.yaml")));
  std::printf("%s is not missed\n", library.c_str());
  return false;
} catch (const vantage::Error& error) {
  const bool names_it = error.problem().find("'" + library + "'") != std::string::npos;
  if (error.code() == vantage::ErrorCode::component_missing && names_it) return true;
  std::printf("instead of the lack of %s: %s\n", library.c_str(), error.what());
  return false;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  const std::string folder = argv[1];  // with plaza.obj
  const std::string start = "scene: {mesh: plaza.obj}\nsensor: {max_range: 40}\n";
  const std::string square = "target: {vertices: [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]]}\n";

  const vantage::MissionFile file = vantage::read_mission_text(start + square, folder + "/mission.yaml");
  const std::string text = vantage::mission_text(file, folder);
  const vantage::MissionFile again = vantage::read_mission_text(text, folder + "/mission.yaml");
  const vantage::Mission mission = vantage::resolve_mission(again);
  vantage::Result result = vantage::run_mission(mission);
  vantage::write_results(result.volume, vantage::result_request(mission, result, {argv[2]}));
  if (vantage::read_volume(argv[2]).volume.mesh.triangles.size() != result.volume.mesh.triangles.size()) return 1;

  const bool all_refused =
      is_refused(start + square + "method: spheres\n", folder, "vantage_picture") &&
      is_refused("scene: {osm: ../town/town.osm}\nsensor: {max_range: 40}\n" + square, folder, "vantage_maps") &&
      is_refused("scene: {raster: plaza.obj}\nsensor: {max_range: 40}\n" + square, folder, "vantage_maps") &&
      is_refused(start + "target: {outline: [[0, 0], [4, 0], [4, 4]]}\n", folder, "vantage_maps");
  return all_refused ? 0 : 1;
} catch (const vantage::Error& error) {
  std::puts(error.what());
  return 2;
}
