#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "mission/input_file.h"
#include "mission/mission_parser.h"
#include "mission/run_mission.h"
#include "solid/solid_check.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The whole file, up to one byte more than parse_yaml takes (which then says that it is too large).
std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorKind::input, std::string("the mission file cannot be read: ") + std::strerror(errno),
                file.string(), "check its permissions");
  }
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > mission_io::kMaxYamlBytes) {
    throw Error(ErrorKind::input,
                "the mission file is too large: " + std::to_string(size) + " bytes, at most " +
                    std::to_string(mission_io::kMaxYamlBytes),
                file.string(), "give the mission file, not a mesh");
  }
  std::string text(mission_io::kMaxYamlBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    throw Error(ErrorKind::input, "the mission file cannot be read to its end", file.string(),
                "check the disk that it lies on");
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

/// Without links and dots in the folder; the name stays, since the format may show in it alone.
fs::path with_true_folder(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::canonical(file.parent_path(), error);
  return error ? file : folder / file.filename();
}

}  // namespace

Mission read_mission(const fs::path& file) {
  mission_io::check_readable(file, "the mission file", "");
  mission_io::ParsedMission parsed = mission_io::parse_mission(read_text(file), file);
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
