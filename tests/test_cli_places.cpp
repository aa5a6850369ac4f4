// Results of one map about two origins: every command that reads them puts them where they lie on the earth.
#include "geo/local_frame.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/opengl.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr geo::LonLat kCentre = {11.5755, 48.1374};
constexpr const char* kOtherCentre = "[48.1374, 11.5765]";

/// a.yaml and b.yaml: the same target on the same map, in frames that lie 74 m apart; a.ply: the volume of the first.
class CliPlaces : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map(kCentre);
    map.box(30, -10, 45, 10, {{"building", "yes"}, {"height", "20"}});
    map.area({{-20, -20}, {10, -20}, {10, -5}, {-5, -5}, {-5, 20}, {-20, 20}}, {{"amenity", "parking"}});  // way/2
    map.box(-60, -60, -50, -50, {{"building", "yes"}});
    map.box(-150, -150, -140, -140, {{"building", "yes"}});  // the ground reaches from here
    map.box(140, 140, 150, 150, {{"building", "yes"}});      // to here
    write("city.osm", map.text());
    write("a.yaml", mission_at("[48.1374, 11.5755]"));
    write("b.yaml", mission_at(kOtherCentre));
    output_of({"compute", "a.yaml", "-q", "-o", "a.ply"});
  }

  static std::string mission_at(const std::string& centre) {
    return "scene: {osm: city.osm, center: " + centre +
           ", radius: 300}\ntarget: {osm: way/2}\nsensor: {max_range: 80}\nexact: {tolerance: 0.2}\n";
  }
  double computed_m3(const std::string& mission) {
    return nlohmann::json::parse(output_of({"compute", mission, "-o", "out.ply", "--json"})).at("volume_m3");
  }
};

TEST_F(CliPlaces, NavigationMeshesAreMoved) {
  output_of({"compute", "a.yaml", "-q", "-o", "a.stl", "-o", "a.glb", "-o", "a.obj"});
  const double alone = computed_m3("b.yaml");
  for (const char* const name : {"a.ply", "a.stl", "a.glb", "a.obj"}) {
    write("kept.yaml", mission_at(kOtherCentre) + "navigation: {meshes: [" + name + "]}\n");
    EXPECT_NEAR(computed_m3("kept.yaml"), alone, 1e-4 * alone) << name << ": the volume cut to itself";
  }
  write("same.yaml", mission_at("[48.1374, 11.5755]") + "navigation: {meshes: [a.ply]}\n");
  EXPECT_NEAR(computed_m3("same.yaml"), alone, 1e-4 * alone) << "in its own frame";
}

TEST_F(CliPlaces, NavigationMeshesFromAnotherLevelAreRefused) {
  const auto write_with_level = [&](const std::string& name, const std::string& level) {
    std::string ply = content(folder_ / "a.ply");
    const std::string flat = "flat ground";
    write(name, ply.replace(ply.find(flat), flat.size(), level));
  };
  const std::string navigation = "navigation:\n  meshes: [";
  write_with_level("high.ply", "EGM96 geoid");
  expect_bad_mission(mission_at(kOtherCentre) + navigation + "high.ply]\n", "mission.yaml:6:12");
  write_with_level("unknown.ply", "");
  write("unknown.yaml", mission_at(kOtherCentre) + navigation + "unknown.ply]\n");
  EXPECT_GT(computed_m3("unknown.yaml"), 1e4) << "what is not known to differ is not refused";
}

TEST_F(CliPlaces, VolumesAreVerifiedWhereTheyLie) {
  for (const std::string mission : {"a.yaml", "b.yaml"}) {
    const ProgramRun verified = run({"verify", mission, "a.ply", "--points", "4000", "--json"});
    const auto report = nlohmann::json::parse(verified.out);
    EXPECT_EQ(report.at("over_claimed"), 0) << mission << report.dump();
    EXPECT_EQ(report.at("closed"), true);
    // About another origin the scene is rounded otherwise: the rays do not notice, the proof does.
    EXPECT_EQ(report.at("right"), mission == "a.yaml") << mission << report.dump();
    EXPECT_EQ(verified.exit_code, mission == "a.yaml" ? 0 : 1);
    EXPECT_EQ(report.at("under_claimed"), 0) << mission << ": the target has two parts, and both must be seen";
    EXPECT_GT(report.at("inside").get<int>(), 1000);
    const bool is_told = verified.err.find("a.ply lies about another origin") != std::string::npos;
    EXPECT_EQ(is_told, mission == "b.yaml") << verified.err;
  }
}

TEST_F(CliPlaces, AnObjForAGlbSceneComesBackWhereItWas) {
  output_of({"scene", "city.osm", "--center", "48.1374,11.5755", "--radius", "300", "-q", "-o", "city.glb"});
  fs::copy_file(folder_ / "city.glb", folder_ / "city.mesh");  // the content tells the format
  for (const std::string scene : {"city.glb", "city.mesh"}) {
    const std::string mission = "scene: {mesh: " + scene +
                                "}\ntarget: {center: [48.1374, 11.5755], width: 8, length: 20}\n"
                                "sensor: {max_range: 80}\n";
    write("glb.yaml", mission);
    const double alone = computed_m3("glb.yaml");
    output_of({"compute", "glb.yaml", "-q", "-o", "up.obj"});  // y up, as the scene
    EXPECT_EQ(nlohmann::json::parse(output_of({"verify", "glb.yaml", "up.obj", "--json"})).at("right"), true);
    write("kept.yaml", mission + "navigation: {meshes: [up.obj]}\n");
    EXPECT_NEAR(computed_m3("kept.yaml"), alone, 1e-4 * alone) << scene;
    output_of({"compute", "glb.yaml", "-q", "-o", "up.ply"});
    const auto same = nlohmann::json::parse(output_of({"compare", "up.ply", "up.obj", "--json"}));
    EXPECT_LT(same.at("only_a_percent").get<double>(), 1e-6) << "the file says that it is y up";
  }
}

TEST_F(CliPlaces, AnObjSaysItsAxesAndUnit) {
  // The lines of an editor that keeps no comments: then the scene's file tells, or the entry.
  std::string bare;
  write("feet.obj", "v -300 -300 0\nv 300 -300 0\nv 300 300 0\nv -300 300 0\nf 1 2 3 4\n");
  const std::string mission =
      "scene: {mesh: feet.obj, up: z, scale: 0.3048}\nsensor: {max_range: 50}\n"
      "target: {vertices: [[0, 0, 0.5], [9, 0, 0.5], [9, 9, 0.5]]}\n";
  write("feet.yaml", mission);
  const double alone = computed_m3("feet.yaml");
  output_of({"compute", "feet.yaml", "-q", "-o", "v.obj"});
  for (const std::string& line : lines(content(folder_ / "v.obj"))) {
    if (line.starts_with("#")) {
      if (line.find("axes") != std::string::npos) testing::expect_wording(line);
    } else {
      bare += line + "\n";
    }
  }
  write("bare.obj", bare);
  for (const char* const name : {"v.obj", "bare.obj"}) {
    write("kept.yaml", mission + "navigation: {meshes: [" + name + "]}\n");
    EXPECT_NEAR(computed_m3("kept.yaml"), alone, 1e-4 * alone) << name;
  }
}

TEST_F(CliPlaces, AnotherCityIsRefused) {
  output_of({"scene", "city.osm", "-q", "-o", "here.obj"});
  write("there.obj", "# vantage georeference: {\"latitude_deg\": 43.7, \"longitude_deg\": 7.4}\n" +
                         std::string("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"));
  expect_bad({"compare", "a.ply", "there.obj"}, "there.obj");
  expect_bad({"verify", "a.yaml", "there.obj"}, "there.obj");
  expect_bad_mission(mission_at(kOtherCentre) + "navigation: {meshes: [there.obj]}\n", "mission.yaml:5:23");
  expect_bad({"scene", "here.obj", "--origin", "11.5755,48.1374", "-o", "volume.ply"}, "here.obj");
}

TEST_F(CliPlaces, SwappedBoxesAreRefused) {
  const std::string crs = mission_at(kOtherCentre) + "crs: EPSG:4326\n";
  const std::string box = "{min: [48.1373, 11.5754, 0], max: [48.1375, 11.5756, 50]}";
  expect_bad_mission(crs + "navigation: {keep_out: [" + box + "]}\n", "mission.yaml");
  expect_bad_mission(crs + "navigation: {boxes: [" + box + "]}\n", "mission.yaml");
}

TEST_F(CliPlaces, TellsWhereTheMapEndsWithinTheRange) {
  const auto notes = [&](const std::string& scene, const std::string& rest) {
    write("short.yaml", "scene: {osm: city.osm" + scene + "}\ntarget: {osm: way/2}\n" + rest);
    const auto report = nlohmann::json::parse(run({"compute", "short.yaml", "-o", "out.ply", "--json"}).out);
    EXPECT_LE(report.at("notes").size(), 1U);
    EXPECT_EQ(report.at("note_codes").size(), report.at("notes").size());
    for (const std::string code : report.at("note_codes")) EXPECT_EQ(code, name_of(WarningCode::range_beyond_data));
    return report.at("notes").empty() ? std::string() : report.at("notes")[0].get<std::string>();
  };
  const std::string centre = ", center: [48.1374, 11.5755], radius: ";
  const std::string range80 = "sensor: {max_range: 80}\n", range200 = "sensor: {max_range: 200}\n";
  EXPECT_EQ(notes(centre + "120", range80), "");
  const std::string circle = notes(centre + "90", range80);
  EXPECT_NE(circle.find("19 m"), std::string::npos) << circle;  // the corner at (-20, -20)
  EXPECT_NE(circle.find("109 m"), std::string::npos) << circle;
  const std::string box = notes(", bbox: [11.5747, 48.1360, 11.5763, 48.1388]", range80);
  EXPECT_NE(box.find("scene.bbox"), std::string::npos) << box;
  const std::string file = notes("", range200);
  EXPECT_NE(file.find("71 m"), std::string::npos) << file;  // the map ends at 150
  testing::expect_wording({circle, box, file});
  output_of({"scene", "city.osm", "--center", "48.1374,11.5755", "--radius", "120", "-q", "-o", "part.glb"});
  write("part.yaml",
        "scene: {mesh: part.glb}\ntarget: {center: [48.1374, 11.5755], width: 8, length: 20}\n" + range200);
  testing::expect_wording(run({"compute", "part.yaml", "-o", "out.ply"}).err);
  // What the vehicle may not fly over cannot be between it and the target.
  const std::string boxes = "navigation: {boxes: [{min: [-90, -90, 0], max: [90, 90, 300]}]}\n";
  EXPECT_EQ(notes("", range200 + boxes), "");
  const ProgramRun enough = run({"verify", "a.yaml", "a.ply"});
  testing::expect_wording(enough.err);
  write("a.yaml", "scene: {osm: city.osm" + centre + "90}\ntarget: {osm: way/2}\n" + range80);
  const ProgramRun short_of_map = run({"verify", "a.yaml", "a.ply"});
  EXPECT_EQ(enough.err.find("scene.radius"), std::string::npos) << enough.err;
  EXPECT_NE(short_of_map.err.find("scene.radius"), std::string::npos) << short_of_map.err;
  testing::expect_wording(short_of_map.err);
}

TEST_F(CliPlaces, AsksWhetherATinyTargetIsInDegrees) {
  write("tiny.yaml",
        "scene: {osm: city.osm}\nsensor: {max_range: 50}\n"
        "target: {vertices: [[11.5755, 48.1374, 1], [11.5757, 48.1374, 1], [11.5757, 48.1376, 1]]}\n");
  const ProgramRun tiny = run({"compute", "tiny.yaml", "-o", "out.ply"});
  EXPECT_NE(tiny.err.find("0.28 mm across"), std::string::npos) << tiny.err;
  EXPECT_NE(tiny.err.find("crs: EPSG:4326"), std::string::npos) << tiny.err;
}

TEST_F(CliPlaces, VolumesAreComparedWhereTheyLie) {
  output_of({"compute", "b.yaml", "-q", "-o", "b.obj"});
  const ProgramRun compared = run({"compare", "a.ply", "b.obj", "--json"});
  const auto report = nlohmann::json::parse(compared.out);
  EXPECT_LT(report.at("only_a_percent").get<double>(), 0.01);
  EXPECT_LT(report.at("only_b_percent").get<double>(), 0.01);
  testing::expect_wording(compared.err);

  // What is written of the difference lies in the frame of the first, and says so.
  write("low.yaml", mission_at(kOtherCentre) + "navigation: {altitude: [0, 30]}\n");
  output_of({"compute", "low.yaml", "-q", "-o", "low.ply"});
  output_of({"compare", "a.ply", "low.ply", "--only-a", "high.stl", "-q"});
  const Scene high = read_scene(folder_ / "high.stl");
  ASSERT_TRUE(high.georeference);
  EXPECT_EQ(high.georeference->longitude_deg, kCentre.longitude_deg);
  const Vec3 top = bounding_box(read_scene(folder_ / "a.ply").mesh).max;
  EXPECT_NEAR((bounding_box(high.mesh).max - top).norm(), 0, 1e-2) << "the frames lie 74 m apart";
}

TEST_F(CliPlaces, StagesAndPicturesAreWhereTheyLie) {
  const std::string spheres = "method: spheres\nspheres: {cubemap: 20}\n";
  write("a.yaml", mission_at("[48.1374, 11.5755]") + spheres);
  output_of({"compute", "a.yaml", "-q", "-o", "spheres.ply", "--stages", "stages"});
  const Scene stage = read_scene(folder_ / "stages" / "000_sphere_0.ply");
  ASSERT_TRUE(stage.georeference);
  EXPECT_EQ(stage.georeference->longitude_deg, kCentre.longitude_deg);

  output_of({"compute", "b.yaml", "-q", "-o", "b.ply"});
  VANTAGE_REQUIRE_OPENGL();
  output_of({"render", "b.yaml", "--volume", "b.ply", "--size", "320x240", "-o", "own.png"});
  const ProgramRun other = run({"render", "b.yaml", "--volume", "a.ply", "--size", "320x240", "-o", "other.png"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_NE(other.err.find("another origin"), std::string::npos) << other.err;
  const double sizes = static_cast<double>(content(folder_ / "own.png").size()) /
                       static_cast<double>(content(folder_ / "other.png").size());
  EXPECT_NEAR(sizes, 1, 0.01) << "the same picture but for a pixel here and there";
}

}  // namespace
}  // namespace vantage::testing
