// Results of one map about two origins: every command that reads them puts them where they lie on the earth.
#include "geo/local_frame.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr geo::LonLat kCentre = {11.5755, 48.1374};

/// a.yaml and b.yaml: the same target on the same map, in frames that lie 74 m apart; a.ply: the volume of the first.
class CliPlaces : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map(kCentre);
    map.box(30, -10, 45, 10, {{"building", "yes"}, {"height", "20"}});
    map.area({{-20, -20}, {10, -20}, {10, -5}, {-5, -5}, {-5, 20}, {-20, 20}}, {{"amenity", "parking"}});  // way/2
    map.box(-150, -150, -140, -140, {{"building", "yes"}});  // the ground reaches from here
    map.box(140, 140, 150, 150, {{"building", "yes"}});      // to here
    write("city.osm", map.text());
    write("a.yaml", mission_at("[48.1374, 11.5755]"));
    write("b.yaml", mission_at("[48.1374, 11.5765]"));
    output_of({"compute", "a.yaml", "-q", "-o", "a.ply"});
  }

  static std::string mission_at(const std::string& centre) {
    return "scene: {osm: city.osm, center: " + centre +
           ", radius: 300}\ntarget: {osm: way/2}\nsensor: {max_range: 80}\n";
  }
  double computed_m3(const std::string& mission) {
    return nlohmann::json::parse(output_of({"compute", mission, "-o", "out.ply", "--json"})).at("volume_m3");
  }
};

TEST_F(CliPlaces, NavigationMeshesAreMoved) {
  const double alone = computed_m3("b.yaml");
  write("kept.yaml", mission_at("[48.1374, 11.5765]") + "navigation: {meshes: [a.ply]}\n");
  EXPECT_NEAR(computed_m3("kept.yaml"), alone, 1e-4 * alone) << "the volume cut to itself";
  write("flat.yaml", mission_at("[48.1374, 11.5755]") + "navigation: {meshes: [a.ply]}\n");
  EXPECT_NEAR(computed_m3("flat.yaml"), alone, 1e-4 * alone) << "in its own frame";
}

TEST_F(CliPlaces, NavigationMeshesFromAnotherLevelAreRefused) {
  std::string ply = content(folder_ / "a.ply");
  const std::string flat = "flat ground";
  ply.replace(ply.find(flat), flat.size(), "EGM96 geoid");
  write("high.ply", ply);
  expect_bad_mission(mission_at("[48.1374, 11.5765]") + "navigation: {meshes: [high.ply]}\n",
                     "'high.ply' are measured from another level (EGM96 geoid) than the scene's (flat ground)",
                     "mission.yaml", "same ground");
}

TEST_F(CliPlaces, VolumesAreVerifiedWhereTheyLie) {
  for (const char* const mission : {"a.yaml", "b.yaml"}) {
    const auto json = nlohmann::json::parse(output_of({"verify", mission, "a.ply", "--points", "4000", "--json"}));
    EXPECT_EQ(json.at("right"), true) << mission << json.dump();
    EXPECT_EQ(json.at("under_claimed"), 0) << mission << ": the target has two parts, and both must be seen";
    EXPECT_GT(json.at("inside").get<int>(), 1000);
  }
}

TEST_F(CliPlaces, AnObjForAGlbSceneComesBackWhereItWas) {
  output_of({"scene", "city.osm", "--center", "48.1374,11.5755", "--radius", "300", "-q", "-o", "city.glb"});
  const std::string mission =
      "scene: {mesh: city.glb}\ntarget: {center: [48.1374, 11.5755], width: 8, length: 20}\nsensor: {max_range: 80}\n";
  write("glb.yaml", mission);
  const double alone = computed_m3("glb.yaml");
  output_of({"compute", "glb.yaml", "-q", "-o", "up.obj"});  // y up, as the scene
  EXPECT_EQ(nlohmann::json::parse(output_of({"verify", "glb.yaml", "up.obj", "--json"})).at("right"), true);
  write("kept.yaml", mission + "navigation: {meshes: [up.obj]}\n");
  EXPECT_NEAR(computed_m3("kept.yaml"), alone, 1e-4 * alone);
}

TEST_F(CliPlaces, VolumesAreComparedWhereTheyLie) {
  output_of({"compute", "b.yaml", "-q", "-o", "b.obj"});
  const ProgramRun compared = run({"compare", "a.ply", "b.obj", "--json"});
  const auto json = nlohmann::json::parse(compared.out);
  EXPECT_LT(json.at("only_a_percent").get<double>(), 0.01);
  EXPECT_LT(json.at("only_b_percent").get<double>(), 0.01);
  EXPECT_NE(compared.err.find("another origin"), std::string::npos) << compared.err;

  // What is written of the difference lies in the frame of the first, and says so.
  write("low.yaml", mission_at("[48.1374, 11.5765]") + "navigation: {altitude: [0, 30]}\n");
  output_of({"compute", "low.yaml", "-q", "-o", "low.ply"});
  output_of({"compare", "a.ply", "low.ply", "--only-a", "high.stl", "-q"});
  const Scene high = read_scene(folder_ / "high.stl");
  ASSERT_TRUE(high.georeference);
  EXPECT_EQ(high.georeference->longitude_deg, kCentre.longitude_deg);
  const Vec3 top = bounding_box(read_scene(folder_ / "a.ply").mesh).max;
  EXPECT_NEAR((bounding_box(high.mesh).max - top).norm(), 0, 1e-2) << "the frames lie 74 m apart";
}

}  // namespace
}  // namespace vantage::testing
