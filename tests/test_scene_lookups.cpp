// Missions in one loaded scene share what was looked up in it, and get what each would get alone.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

class SceneLookupsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MapText map({11.5755, 48.1374});
    map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}, {"name", "Hall"}});   // way/1
    map.box(20, -10, 40, 10, {{"leisure", "pitch"}, {"name", "Pitch"}});                    // way/2
    map.box(-40, 20, -20, 40, {{"building", "yes"}, {"height", "30"}, {"name", "Tower"}});  // way/3
    write_bytes(folder_ / "city.osm", map.text());
    write_bytes(folder_ / "scene.yaml", "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\n");
    source_ =
        read_scene_text("scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\n", folder_ / "m.yaml").scene;
    loaded_ = std::make_shared<const LoadedScene>(load_scene(source_));
  }

  Mission resolved(const std::string& target, std::shared_ptr<const LoadedScene> in) const {
    const std::string text = "sensor: {max_range: 60}\ntarget: " + target + "\n";
    return resolve_mission(read_mission_text(text, folder_ / "m.yaml", source_), std::move(in));
  }
  Mission alone(const std::string& target) const {
    return resolved(target, std::make_shared<const LoadedScene>(load_scene(source_)));
  }

  const std::array<std::string, 5> targets_ = {
      "{osm: way/2}", "{osm: way/1, part: roof}", "{object: Tower, part: facade}",
      "{center: [48.1374, 11.5759], width: 4, length: 6}", "{at: [48.1374, 11.5755], part: roof}"};
  TemporaryDirectory folder_;
  SceneSource source_;
  std::shared_ptr<const LoadedScene> loaded_;
};

TEST_F(SceneLookupsTest, GiveWhatEachMissionGetsAlone) {
  for (int round = 0; round < 2; ++round) {
    for (const std::string& target : targets_) {
      const Mission shared = resolved(target, loaded_);
      EXPECT_EQ(shared.loaded, loaded_);
      EXPECT_EQ(mission_hash(shared), mission_hash(alone(target))) << target;
    }
  }
}

TEST_F(SceneLookupsTest, AreMadeByWhoeverAsksFirst) {
  std::vector<std::string> hashes(targets_.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    threads.emplace_back([&, i] { hashes[i] = mission_hash(resolved(targets_[i], loaded_)); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < targets_.size(); ++i) EXPECT_EQ(hashes[i], mission_hash(alone(targets_[i])));
}

TEST_F(SceneLookupsTest, AreNotThoseOfTheSceneThatWasCopied) {
  const double height = resolved("{osm: way/1, part: roof}", loaded_).target.parts[0][0].z();
  LoadedScene taller = *loaded_;
  for (Vec3& vertex : taller.scene.mesh.vertices) vertex.z() *= 2;
  const Mission mission = resolved("{osm: way/1, part: roof}", std::make_shared<const LoadedScene>(std::move(taller)));
  EXPECT_DOUBLE_EQ(mission.target.parts[0][0].z(), 2 * height);
}

TEST_F(SceneLookupsTest, SayWhatIsMissingEachTime) {
  for (int round = 0; round < 2; ++round) {
    testing::expect_code([&] { resolved("{osm: way/77}", loaded_); }, ErrorCode::map_object_missing);
    testing::expect_code([&] { resolved("{osm: way/77, part: roof}", loaded_); }, ErrorCode::object_missing);
    testing::expect_code([&] { resolved("{osm: way/2, part: roof}", loaded_); }, ErrorCode::object_missing);
  }
}

TEST_F(SceneLookupsTest, OfATriangleOfNoObjectAreRefused) {
  LoadedScene broken = *loaded_;
  broken.scene.object_of[0] = 1000;
  const auto scene = std::make_shared<const LoadedScene>(std::move(broken));
  testing::expect_code([&] { resolved("{osm: way/1, part: roof}", scene); }, ErrorCode::index_out_of_range);
}

}  // namespace
}  // namespace vantage
