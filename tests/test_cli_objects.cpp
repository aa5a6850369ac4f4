// vantage inspect --objects: the names of objects, and what a mission writes for them.
#include "common/objects.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage::testing {
namespace {

using nlohmann::json;

class CliObjects : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map;
    map.box(10, 20, 30, 50, {{"building", "yes"}, {"height", "12"}, {"name", "Old Mill"}});        // way/1
    map.box(-30, -30, -10, -10, {{"building", "yes"}, {"height", "30"}, {"name", "Water Mill"}});  // way/2
    map.box(40, 40, 60, 60, {{"building", "yes"}, {"height", "7"}});                               // way/3
    write("city.osm", map.text());
    write("town.obj",
          "o ground\nv -99 -99 0\nv 99 -99 0\nv 0 99 0\nf 1 2 3\n"
          "o clock tower\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 25\nf 4 6 5\nf 4 5 7\nf 5 6 7\nf 6 4 7\n"
          "o cabin\nv 40 0 0\nv 50 0 0\nv 50 8 0\nv 40 8 0\nv 40 0 4\nv 50 0 4\nv 50 8 4\nv 40 8 4\n"
          "f 8 11 10 9\nf 12 13 14 15\nf 8 9 13 12\nf 9 10 14 13\nf 10 11 15 14\nf 11 8 12 15\n");
  }
  json objects(const std::string& scene, const std::string& pattern) {
    return json::parse(output_of({"inspect", scene, "--objects", pattern, "--json"})).at("objects");
  }
  std::vector<std::string> names(const std::string& scene, const std::string& pattern) {
    std::vector<std::string> found;
    for (const json& one : objects(scene, pattern)) found.push_back(one.at("name"));
    return found;
  }
};

using Names = std::vector<std::string>;

TEST_F(CliObjects, NamesAreFoundByPartsAndByStars) {
  EXPECT_EQ(names("city.osm", "mill"), Names({"Old Mill", "Water Mill"}));
  EXPECT_EQ(names("city.osm", "OLD"), Names({"Old Mill"}));
  EXPECT_EQ(names("city.osm", "*mill"), Names({"Old Mill", "Water Mill"}));
  EXPECT_EQ(names("city.osm", "?a*r mill"), Names({"Water Mill"}));
  EXPECT_EQ(names("city.osm", "way/3"), Names({""})) << "by the id";
  EXPECT_EQ(names("city.osm", "way/1 old*"), Names({"Old Mill"})) << "by both, as reports write it";
}

TEST_F(CliObjects, WhatAMissionWritesFindsTheObject) {
  const json mill = objects("city.osm", "water").at(0);
  EXPECT_EQ(mill.at("source_id"), "way/2");
  EXPECT_EQ(mill.at("kind"), "building");
  EXPECT_NEAR(mill.at("height_m"), 30, 1e-6);
  EXPECT_NEAR(mill.at("footprint_m2"), 400, 0.5);
  const json tower = objects("town.obj", "tower").at(0);
  EXPECT_EQ(tower.at("height_m"), 25);
  EXPECT_TRUE(tower.at("footprint_m2").is_null());
  const json cabin = objects("town.obj", "cabin").at(0);
  for (const auto& [scene, found] : {std::pair{"osm: city.osm", mill}, {"mesh: town.obj", cabin}}) {
    write("mission.yaml", std::string("scene: {") + scene + "}\nsensor: {max_range: 60}\n" +
                              found.at("mission").get<std::string>() + "\n");
    const json report = json::parse(output_of({"compute", "mission.yaml", "-o", "volume.ply", "--json", "-q"}));
    EXPECT_EQ(report.at("outcome"), "computed") << report.dump(2);
    EXPECT_GT(report.at("volume_m3").get<double>(), 1000);
  }
  const std::string of_tower = "target: {object: \"clock tower\", part: roof}",
                    of_ground = "navigation: {ground: ground}";
  EXPECT_EQ(tower.at("mission"), of_tower);
  EXPECT_EQ(objects("town.obj", "ground").at(0).at("mission"), of_ground);
}

TEST_F(CliObjects, AQuestionMarkIsOneCharacter) {
  const std::string side = "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n";
  write("names.obj", "o caf\u00e9\n" + side + "o M\u00fchle\nf 1 2 3\no NULL\nf 1 2 3\no Null 2\nf 1 2 3\n");
  EXPECT_EQ(names("names.obj", "caf?"), Names({"caf\u00e9"}));
  EXPECT_EQ(names("names.obj", "m?hle"), Names({"M\u00fchle"}));
  EXPECT_EQ(names("names.obj", "m*?hle"), Names({"M\u00fchle"})) << "the star goes on by characters too";
  expect_bad({"inspect", "names.obj", "--objects", "caf??"}, "");
  const std::string quoted = "target: {object: \"NULL\", part: roof}";
  EXPECT_EQ(objects("names.obj", "null").at(0).at("mission"), quoted) << "not YAML's null";
}

TEST(ListedObjects, WallsHaveFacadesAndTreesAndStandInsAreNoTargets) {
  LoadedScene loaded;
  loaded.scene.mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  loaded.scene.mesh.triangles.assign(6, {0, 1, 2});
  loaded.scene.object_of = {0, 1, 2, 3, 4, 5};
  loaded.scene.objects = {{"fence", "", ObjectKind::wall}, {"oak", "", ObjectKind::tree},
                          {"", "", ObjectKind::building},  {"Yes", "", ObjectKind::building},
                          {"", "", ObjectKind::ground},    {"crane", "", ObjectKind::stand_in}};
  const std::vector<std::string> expected = {"target: {object: fence, part: facade}", "", "",
                                             "target: {object: \"Yes\", part: roof}", "", ""};
  std::vector<std::string> missions;
  for (const ListedObject& one : list_objects(loaded)) missions.push_back(one.mission);
  EXPECT_EQ(missions, expected);
}

TEST(ListedObjects, ASceneMayHaveNone) {
  LoadedScene loaded;
  loaded.scene.mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  loaded.scene.mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(list_objects(loaded).empty());
  Mission mission;
  mission.target.parts = {{{2, 2, 1}, {3, 2, 1}, {3, 3, 1}}};
  mission.sensor.max_range_m = 20;
  mission.loaded = std::make_shared<const LoadedScene>(loaded);
  EXPECT_EQ(run_mission(mission, {}).volume.outcome, Outcome::computed);
}

TEST_F(CliObjects, TheSceneMayStandBehindTheOption) {
  EXPECT_EQ(output_of({"inspect", "--objects", "city.osm"}), output_of({"inspect", "city.osm", "--objects"}));
  EXPECT_EQ(output_of({"inspect", "--json", "--objects", "city.osm"}),
            output_of({"inspect", "city.osm", "--json", "--objects"}));
  expect_bad({"inspect", "--objects"}, "");
  expect_bad({"inspect", "--objects", "missing.osm"}, "");
}

TEST_F(CliObjects, TheTableHasARowForEach) {
  const std::string table = output_of({"inspect", "city.osm", "--objects"});
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 4) << "three houses and the ground\n" << table;
  const std::vector<std::string> cells = {"target: {osm: way/1, part: roof}", "way/1 Old Mill", "12.0",
                                          "600"};  // m, m2
  for (const std::string& cell : cells) EXPECT_NE(table.find(cell), std::string::npos) << cell << "\n" << table;
}

TEST_F(CliObjects, NamesThatAreNotThereAreRefused) {
  expect_bad({"inspect", "city.osm", "--objects", "old mil*l?"}, "");
  expect_bad({"inspect", "city.osm", "--objects", "church"}, "");
  expect_bad({"inspect", "city.osm", "--objects", "mill", "--named"}, "command line, --objects");
}

}  // namespace
}  // namespace vantage::testing
