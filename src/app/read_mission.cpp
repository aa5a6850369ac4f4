#include <algorithm>
#include <array>
#include <variant>

#include "app/input_file.h"
#include "app/mission_parser.h"
#include "common/input.h"
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
    case SceneSource::Kind::tileset:
      return "the scene's tileset";
  }
  return "the scene's file";
}

void check_scene(MissionFile& mission) {
  SceneSource& scene = mission.scene;
  for (fs::path* const terrain : {&scene.city.terrain, &scene.terrain}) {
    if (terrain->empty()) continue;
    check_readable(*terrain, "the terrain", mission.places.terrain);
    *terrain = with_true_folder(*terrain);
  }
  if (scene.kind == SceneSource::Kind::tileset && is_web_address(scene.file)) return;
  check_readable(scene.file, what_of(scene.kind), mission.places.scene);
  scene.file = with_true_folder(scene.file);
}

/// The files that targets name.
void check_target_files(MissionFile& mission) {
  for (MissionTarget& one : mission.targets) {
    auto* const target = std::get_if<TargetFile>(&one.source);
    if (!target) continue;
    check_readable(target->file, target->is_volume ? "the target's volume" : "the target's file", one.place);
    target->file = with_true_folder(target->file);
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

[[noreturn]] void refuse_file(const std::string& name, const std::string& place) {
  throw Error(ErrorCode::not_applicable, "the mission names a file that it did not name when it was opened",
              place + " (" + name + ")", "name it in the mission file and start again");
}

/// Files that a text of others names are taken as `opened` has them: by their names alone.
class OpenedFiles {
 public:
  explicit OpenedFiles(const MissionFile& opened) : opened_(opened) {}

  void take(std::vector<NavigationMeshFile>& meshes, const std::vector<std::string>& places) const {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      meshes[i].file = file_of(meshes[i].name, std::array<ZoneFile, 0>{}, opened_.navigation_meshes, places[i]);
    }
  }
  void take(std::vector<MissionTarget>& targets) const {
    std::vector<TargetFile> known;
    for (const MissionTarget& one : opened_.targets) {
      if (const auto* target = std::get_if<TargetFile>(&one.source)) known.push_back(*target);
    }
    for (MissionTarget& one : targets) {
      auto* const target = std::get_if<TargetFile>(&one.source);
      if (target) target->file = file_of(target->name, known, std::array<TargetFile, 0>{}, one.place);
    }
  }
  void take(std::vector<ZoneFile>& zones, const std::vector<std::string>& places) const {
    for (std::size_t i = 0; i < zones.size(); ++i) {
      zones[i].file = file_of(zones[i].name, opened_.keep_in_files, opened_.keep_out_files, places[i]);
    }
  }

 private:
  template <typename First, typename Second>
  static fs::path file_of(const std::string& name, const First& first, const Second& second, const std::string& place) {
    const fs::path wanted = fs::path(name).lexically_normal();
    const auto is_wanted = [&](const auto& known) { return fs::path(known.name).lexically_normal() == wanted; };
    for (const auto& known : first) {
      if (is_wanted(known)) return known.file;
    }
    for (const auto& known : second) {
      if (is_wanted(known)) return known.file;
    }
    refuse_file(name, place);
  }

  const MissionFile& opened_;
};

/// "EPSG:4326".
bool is_authority_code(std::string_view crs) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t colon = crs.find(':');
  if (colon == 0 || colon == std::string_view::npos || colon + 1 == crs.size()) return false;
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  return std::all_of(crs.begin(), crs.begin() + static_cast<std::ptrdiff_t>(colon), is_letter) &&
         crs.find_first_not_of(kDigits, colon + 1) == std::string_view::npos;
}

}  // namespace

MissionFile read_mission(const fs::path& file) {
  check_readable(file, "the mission file", "");
  return read_mission_text(internal::app::read_text(file, "mission file"), file);
}

MissionFile read_mission_text(std::string_view text, const fs::path& file) {
  MissionFile mission = internal::app::parse_mission(text, file);
  check_scene(mission);
  check_target_files(mission);
  check_limits(mission);
  return mission;
}

MissionFile read_mission_text(std::string_view text, const fs::path& file, const SceneSource& source) {
  MissionFile mission = internal::app::parse_mission(text, file, &source);
  check_target_files(mission);
  check_limits(mission);
  return mission;
}

MissionFile read_mission_text(std::string_view text, const fs::path& file, const SceneSource& source,
                              const MissionFile& opened) {
  MissionFile mission = internal::app::parse_mission(text, file, &source);
  const OpenedFiles files(opened);
  files.take(mission.targets);
  files.take(mission.navigation_meshes, mission.places.navigation_meshes);
  files.take(mission.keep_in_files, mission.places.keep_in_files);
  files.take(mission.keep_out_files, mission.places.keep_out_files);
  // Whatever else a mission may name one day.
  const std::vector<fs::path> named = input_files(opened);
  for (const fs::path& wanted : input_files(mission)) {
    const bool is_named = wanted == file || std::find(named.begin(), named.end(), wanted) != named.end();
    if (!is_named) refuse_file(wanted.filename().string(), file.string());
  }
  if (!mission.crs.empty() && mission.crs != opened.crs && !is_authority_code(mission.crs)) {
    throw Error(ErrorCode::not_applicable, "the mission has another 'crs' than when it was opened", file.string(),
                "write a code such as EPSG:4326, or change the mission file and start again");
  }
  check_target_files(mission);
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
  if (const fs::path& terrain = terrain_of(mission.scene); !terrain.empty()) files.push_back(terrain);
  for (const MissionTarget& one : mission.targets) {
    if (const auto* target = std::get_if<TargetFile>(&one.source)) files.push_back(target->file);
  }
  for (const NavigationMeshFile& mesh : mission.navigation_meshes) files.push_back(mesh.file);
  for (const ZoneFile& zones : mission.keep_in_files) files.push_back(zones.file);
  for (const ZoneFile& zones : mission.keep_out_files) files.push_back(zones.file);
  return files;
}

}  // namespace vantage
