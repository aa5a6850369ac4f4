// The files that a mission is in, and those that it names.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

class MissionFiles : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) {
    testing::write_bytes(folder_ / name, text);
    return folder_ / name;
  }

  static std::string text_of(const std::string& rest, const std::string& scene = "scene:\n  mesh: city.obj\n") {
    return scene +
           "target:\n  vertices: [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]\nsensor:\n  max_range: 100\n" + rest;
  }

  void expect_refusal_of(const fs::path& file, ErrorCode code, const std::string& where) {
    testing::expect_error([&] { read_mission(file); }, code, where);
  }

  static constexpr const char* kTetrahedron =
      "o zone\nv 0 0 0\nv 0 0 50\nv 0 50 0\nv 50 0 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";

  testing::TemporaryDirectory folder_;
};

TEST_F(MissionFiles, AreReadRelativeToTheMission) {
  fs::create_directory(folder_ / "meshes");
  write("meshes/city.obj", kTetrahedron);
  write("meshes/zone.obj", kTetrahedron);
  const fs::path file = write(
      "mission.yaml", text_of("navigation: {meshes: [meshes/zone.obj]}", "scene: {mesh: meshes/city.obj, up: y}\n"));
  const MissionFile written = read_mission(file);
  const Mission mission = resolve_mission(written);
  const fs::path folder = fs::canonical(folder_.path()) / "meshes";
  ASSERT_EQ(mission.navigation.meshes.size(), 1U);
  EXPECT_EQ(folder.parent_path() / mission.navigation.meshes[0].name, folder / "zone.obj");
  EXPECT_EQ(mission.navigation.meshes[0].mesh.triangles.size(), 4U);
  EXPECT_EQ(mission.navigation.meshes[0].mesh.vertices.size(), 4U);
  EXPECT_NEAR(enclosed_volume(mission.navigation.meshes[0].mesh), 50.0 * 50 * 50 / 6, 1e-6);
  EXPECT_EQ(bounding_box(mission.navigation.meshes[0].mesh).min, Vec3(0, -50, 0)) << "y up, as the scene's file";
  EXPECT_EQ(written.scene.file, folder / "city.obj");
  ASSERT_EQ(written.navigation_meshes.size(), 1U);
  EXPECT_EQ(written.navigation_meshes[0].file, folder / "zone.obj");
}

TEST_F(MissionFiles, MayLieInALinkedFolder) {
  fs::create_directories(folder_ / "data/missions");
  write("data/city.obj", kTetrahedron);
  write("data/missions/mission.yaml", text_of("", "scene: {mesh: ../city.obj}\n"));
  fs::create_directory_symlink(folder_ / "data/missions", folder_ / "here");
  const MissionFile mission = read_mission(folder_ / "here/mission.yaml");
  EXPECT_EQ(mission.scene.file, fs::canonical(folder_ / "data") / "city.obj");
}

TEST_F(MissionFiles, ThatAreMissing) {
  expect_refusal_of(folder_ / "none.yaml", ErrorCode::file_not_found, "none.yaml");
  expect_refusal_of(folder_.path(), ErrorCode::not_a_file, folder_.path().string());
  expect_refusal_of("/dev/null", ErrorCode::not_a_file, "/dev/null");
  const fs::path file = write("mission.yaml", text_of("navigation: {meshes: [zone.obj]}"));
  expect_refusal_of(file, ErrorCode::file_not_found, "mission.yaml:2:9 (" + folder_.path().string());
  write("city.obj", kTetrahedron);
  expect_refusal_of(file, ErrorCode::file_not_found, "mission.yaml:7:23 (" + folder_.path().string());
  fs::create_directory(folder_ / "zone.obj");
  expect_refusal_of(file, ErrorCode::not_a_file, "mission.yaml:7:23");
  fs::create_directory(folder_ / "town");
  write("town/tileset.json", "{}");
  expect_refusal_of(write("tiles.yaml", text_of("", "scene: {tiles: town}\n")), ErrorCode::not_a_file, "tiles.yaml:");
}

TEST_F(MissionFiles, ThatAreTooLarge) {
  const fs::path file = write("mission.yaml", "a: 1\n");
  fs::resize_file(file, std::uintmax_t{1} << 40);  // sparse: a terabyte that takes no room
  expect_refusal_of(file, ErrorCode::file_too_large, "mission.yaml");
}

}  // namespace
}  // namespace vantage
