// vantage inspect --objects: the names of objects, and what a mission writes for them.
#include "support/cli_fixture.h"
#include "support/map_text.h"

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
          "o clock tower\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 25\nf 4 6 5\nf 4 5 7\nf 5 6 7\nf 6 4 7\n");
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
  for (const auto& [scene, found] : {std::pair{"osm: city.osm", mill}, {"mesh: town.obj", tower}}) {
    write("mission.yaml", std::string("scene: {") + scene + "}\nsensor: {max_range: 60}\n" +
                              found.at("mission").get<std::string>() + "\n");
    if (found == mill) EXPECT_GT(output_of({"compute", "mission.yaml", "-o", "volume.ply"}).size(), 0u);
  }
  EXPECT_EQ(tower.at("mission"), "target: {object: \"clock tower\", part: roof}");
  EXPECT_EQ(objects("town.obj", "ground").at(0).at("mission"), "navigation: {ground: ground}");
}

TEST_F(CliObjects, TheTableHasARowForEach) {
  const std::string table = output_of({"inspect", "city.osm", "--objects"});
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 4) << "three houses and the ground\n" << table;
  EXPECT_NE(table.find("target: {osm: way/1, part: roof}"), std::string::npos) << table;
  EXPECT_NE(table.find("way/1 Old Mill"), std::string::npos);
  EXPECT_NE(table.find("12.0"), std::string::npos);
  EXPECT_NE(table.find("600"), std::string::npos) << "square metres";
}

TEST_F(CliObjects, NamesThatAreNotThereAreRefused) {
  expect_bad({"inspect", "city.osm", "--objects", "old mil*l?"}, "");
  expect_bad({"inspect", "city.osm", "--objects", "church"}, "");
  expect_bad({"inspect", "city.osm", "--objects", "mill", "--named"}, "command line, --objects");
}

}  // namespace
}  // namespace vantage::testing
