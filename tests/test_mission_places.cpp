// Missions on maps: targets and limits by degrees, by map coordinates, by name and by address, on the flat and on a
// slope.
#include <proj.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/triangle_tree.h"
#include "geo/local_frame.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/opengl.h"
#include "support/random.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr geo::LonLat kCentre = {11.5755, 48.1374};
constexpr const char* kRegion = "center: [48.1374, 11.5755], radius: 300";
constexpr const char* kSensor80 = "sensor: {max_range: 80}\n";
constexpr double kSlope = 0.1;  // the terrain rises by this much to the north

class MissionPlaces : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map(kCentre);
    map.box(30, -10, 45, 10, {{"building", "yes"}, {"height", "20"}, {"name", "Tower"}});  // way/1
    map.box(-10, -10, 10, 10, {{"leisure", "pitch"}});                                     // way/2
    map.area({{-70, -20}, {-30, -20}, {-30, -5}, {-50, -5}, {-50, 20}, {-70, 20}}, {{"amenity", "parking"}});
    map.box(-48, 2, -35, 12, {{"building", "yes"}, {"height", "6"}});    // way/4, in the elbow of way/3
    map.line({{60, 60}, {70, 60}, {70, 70}}, {{"highway", "footway"}});  // way/5
    map.box(-200, -200, -180, -180, {{"building", "yes"}});
    map.box(180, 180, 200, 200, {{"building", "yes"}});
    write("city.osm", map.text());
    std::string grid =
        "ncols 41\nnrows 41\nxllcenter 11.5655\nyllcenter 48.1274\ncellsize 0.0005\nNODATA_value -9999\n";
    for (int row = 0; row < 41; ++row) {
      const double north = frame_.to_local({kCentre.longitude_deg, 48.1274 + (40 - row) * 0.0005}).y();
      for (int column = 0; column < 41; ++column) grid += std::to_string(500 + kSlope * north) + " ";
      grid += "\n";
    }
    write("dem.asc", grid);
    write("dem.prj",
          "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
          "UNIT[\"degree\",0.0174532925199433]]");
  }

  /// Written, and read as vantage reads it.
  MissionFile mission(const std::string& scene, const std::string& rest) {
    write("mission.yaml", "scene: {" + scene + "}\n" + rest + kSensor80);
    return read_mission(folder_ / "mission.yaml");
  }
  static std::string map_scene() { return std::string("osm: city.osm, ") + kRegion; }

  /// Placed, with its scene.
  Mission placed(const std::string& scene, const std::string& rest) {
    Mission result = resolve_mission(mission(scene, rest));
    scene_ = result.scene();
    notes_ = result.notes;
    return result;
  }
  Volume volume(const std::string& scene, const std::string& rest) {
    return run_mission(resolve_mission(mission(scene, rest))).volume;
  }

  void expect_refused(const std::string& scene, const std::string& rest, const std::string& where) {
    expect_bad_mission("scene: {" + scene + "}\n" + rest + kSensor80, where);
  }

  const geo::LocalFrame frame_{kCentre};
  Scene scene_;
  std::vector<Warning> notes_;
};

using CliMissionPlaces = MissionPlaces;

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10f", value);
  return text;
}

/// "[x, y, z]".
std::string text_of(const Vec3& p) {
  std::string text = "[";
  text.append(text_of(p.x())).append(", ").append(text_of(p.y())).append(", ").append(text_of(p.z()));
  return text.append("]");
}
std::string list_of(const std::vector<Vec3>& points) {
  std::string list = "[";
  for (const Vec3& p : points) list.append(list.size() > 1 ? ", " : "").append(text_of(p));
  return list.append("]");
}

const std::vector<Vec3> kSquare = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}};

double area_of(const Target& target) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < target.parts[0].size(); ++i) {
    sum += (target.parts[0][i] - target.parts[0][0]).cross(target.parts[0][i + 1] - target.parts[0][0]) / 2;
  }
  return sum.norm();
}

// ---- scenes ----

TEST_F(MissionPlaces, AMapIsTheSceneThatTheCommandWrites) {
  const std::string target = "target: {vertices: " + list_of(kSquare) + "}\n";
  const Volume direct = volume(map_scene(), target);
  ASSERT_EQ(direct.outcome, Outcome::computed);
  ASSERT_TRUE(direct.georeference);
  EXPECT_EQ(direct.georeference->latitude_deg, 48.1374);
  output_of({"scene", "city.osm", "--center", "48.1374,11.5755", "--radius", "300", "-q", "-o", "city2.obj"});
  const Volume written = volume("mesh: city2.obj", target);
  EXPECT_NEAR(enclosed_volume(written.mesh), enclosed_volume(direct.mesh), 1e-6 * enclosed_volume(direct.mesh));
  const bool is_hidden = std::any_of(direct.causes.begin(), direct.causes.end(),
                                     [](const Cause& cause) { return cause.name == "way/1 Tower"; });
  EXPECT_TRUE(is_hidden);
}

TEST_F(MissionPlaces, HeightsAboveTheSurfaceOfARasterAreNoted) {
  const std::string target = "target: {center: [48.1374, 11.5755], width: 5, length: 5, offset: 1}\n";
  const auto has_note = [&](const std::string& navigation) {
    const Mission resolved =
        resolve_mission(mission(std::string("raster: dem.asc, origin: [48.1374, 11.5755], ") + kRegion,
                                target + "navigation: " + navigation + "\n"));
    return std::any_of(resolved.notes.begin(), resolved.notes.end(),
                       [](const Warning& note) { return note.code == WarningCode::above_surface; });
  };
  const std::string heights = "{altitude: {agl: [5, 30]}";
  EXPECT_TRUE(has_note(heights + "}"));
  EXPECT_FALSE(has_note(heights + ", ground: 500}"));
  EXPECT_FALSE(has_note("{altitude: [500, 530]}"));
}

TEST_F(MissionPlaces, ARasterIsAScene) {
  const double z = 500 + kSlope * 10;
  const std::string vertices = list_of({{-10, -10, z}, {10, -10, z}, {10, 10, z}, {-10, 10, z}});
  const Volume result = volume(std::string("raster: dem.asc, origin: [48.1374, 11.5755], ") + kRegion,
                               "target: {vertices: " + vertices + ", offset: 0.5}\n");
  ASSERT_EQ(result.outcome, Outcome::computed) << result.reason;
  EXPECT_GT(enclosed_volume(result.mesh), 1e5);
}

// ---- reference systems ----

/// East and north by PROJ itself.
Vec3 in_system(const char* system, const geo::LonLat& at, double z) {
  PJ_CONTEXT* const context = proj_context_create();
  PJ* const rough = proj_create_crs_to_crs(context, "EPSG:4326", system, nullptr);
  PJ* const transform = proj_normalize_for_visualization(context, rough);
  const PJ_COORD result = proj_trans(transform, PJ_FWD, proj_coord(at.longitude_deg, at.latitude_deg, 0, 0));
  proj_destroy(transform);
  proj_destroy(rough);
  proj_context_destroy(context);
  return {result.xy.x, result.xy.y, z};
}

TEST_F(MissionPlaces, TargetsInReferenceSystems) {
  for (const char* const system : {"EPSG:4326", "EPSG:25832", "EPSG:3857"}) {
    std::vector<Vec3> there;
    for (const Vec3& corner : kSquare) there.push_back(in_system(system, frame_.to_lonlat(corner.head<2>()), 1.5));
    const Mission result =
        placed(map_scene(), std::string("crs: ") + system + "\ntarget: {vertices: " + list_of(there) + "}\n");
    for (std::size_t i = 0; i < kSquare.size(); ++i) {
      const Vec3 expected = kSquare[i] + Vec3(0, 0, 1.5);
      EXPECT_NEAR((result.target.parts[0][i] - expected).norm(), 0, 1e-4) << system;
    }
  }
}

TEST_F(MissionPlaces, LimitsInReferenceSystems) {
  // A box between meridians and parallels, 40 m about the centre, and one to stay out of.
  const geo::LonLat low = frame_.to_lonlat({-40, -40}), high = frame_.to_lonlat({40, 40}),
                    out = frame_.to_lonlat({5, 5});
  const auto corner = [](const geo::LonLat& at, double z) {
    return text_of(Vec3(at.longitude_deg, at.latitude_deg, z));
  };
  std::vector<Vec3> there;
  for (const Vec3& at : kSquare) there.push_back(in_system("EPSG:4326", frame_.to_lonlat(at.head<2>()), 0));
  const Mission result =
      placed(map_scene(), "crs: EPSG:4326\ntarget: {vertices: " + list_of(there) +
                              "}\nnavigation:\n  boxes: [{min: " + corner(low, 5) + ", max: " + corner(high, 60) +
                              "}]\n  keep_out: [{min: " + corner(out, 0) + ", max: " + corner(high, 30) + "}]\n");
  ASSERT_EQ(result.navigation.keep_in.size(), 1U);
  const Box keep = result.navigation.keep_in[0].box(), avoid = result.navigation.keep_out.at(0).box();
  EXPECT_NEAR((keep.min - Vec3(-40, -40, 5)).norm(), 0, 0.01);
  EXPECT_NEAR((keep.max - Vec3(40, 40, 60)).norm(), 0, 0.01);
  EXPECT_NEAR((avoid.min - Vec3(5, 5, 0)).norm(), 0, 0.01);
  for (const geo::LonLat& at : {low, high}) {
    const Eigen::Vector2d p = frame_.to_local(at);
    EXPECT_LE(keep.min.x(), std::max(p.x(), -40.0) + 1e-3);
  }
}

TEST_F(MissionPlaces, LimitsInDegreesNeedTheSystem) {
  const std::string target = "target: {osm: way/2}\nnavigation:\n";
  const std::string polygon = "{polygon: [[11.575, 48.137], [11.576, 48.137], [11.576, 48.138]], heights: any}";
  const std::string box = "{min: [11.575, 48.137, 0], max: [11.576, 48.138, 30]}";
  for (const std::string list : {"keep_in", "keep_out"}) {
    for (const std::string& limit : {polygon, box}) {
      SCOPED_TRACE(list + limit);
      const Error error = expect_error([&] { placed(map_scene(), target + "  " + list + ": [" + limit + "]\n"); },
                                       ErrorCode::value_out_of_range);
      EXPECT_NE(error.where().find("mission.yaml"), std::string::npos) << error.where();
    }
  }
  EXPECT_EQ(
      placed(map_scene(), "crs: EPSG:4326\n" + target + "  keep_out: [" + polygon + "]\n").navigation.keep_out.size(),
      1U);
}

// ---- targets by name ----

TEST_F(MissionPlaces, AConvexAreaIsTheTargetAsItIs) {
  const Mission result = placed(map_scene(), "target: {osm: way/2}\n");
  ASSERT_EQ(result.target.parts.size(), 1U);
  ASSERT_EQ(result.target.parts[0].size(), 4U);
  EXPECT_NEAR(area_of(result.target), 400, 1);
  for (const Vec3& vertex : result.target.parts[0]) {
    EXPECT_NEAR(std::abs(vertex.x()), 10, 0.012);
    EXPECT_NEAR(std::abs(vertex.y()), 10, 0.012);
    EXPECT_EQ(vertex.z(), 0);
  }
  const Volume named = volume(map_scene(), "target: {osm: way/2}\n");
  const Volume given = volume(map_scene(), "target: {vertices: " + list_of(result.target.parts[0]) + "}\n");
  EXPECT_NEAR(enclosed_volume(named.mesh), enclosed_volume(given.mesh), 1e-5 * enclosed_volume(given.mesh));
}

TEST_F(MissionPlaces, AnAreaThatIsNotConvexIsItsParts) {
  const Mission whole = placed(map_scene(), "target: {osm: way/3}\n");
  ASSERT_EQ(whole.target.parts.size(), 2U) << "an L is two rectangles";
  EXPECT_EQ(whole.target.name, "way/3");
  EXPECT_EQ(whole.target.part(1).name, "way/3, part 2");
  EXPECT_NEAR(area_of(whole.target.part(0)) + area_of(whole.target.part(1)), 40 * 15 + 20 * 25, 1);
  const Volume both = run_mission(resolve_mission(mission(map_scene(), "target: {osm: way/3}\n"))).volume;
  ASSERT_EQ(both.outcome, Outcome::computed);
  const Volume halves[2] = {volume(map_scene(), "target: {vertices: " + list_of(whole.target.parts[0]) + "}\n"),
                            volume(map_scene(), "target: {vertices: " + list_of(whole.target.parts[1]) + "}\n")};
  const core::TriangleTree tree(both.mesh), first(halves[0].mesh), second(halves[1].mesh);
  Random random(4404);
  Box box = bounding_box(halves[0].mesh);
  int inside = 0, decided = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 point = random.in_box(box);
    if (std::min({tree.distance(point), first.distance(point), second.distance(point)}) < 0.02) continue;
    ++decided;
    const bool in_both = first.winding_number(point) == 1 && second.winding_number(point) == 1;
    EXPECT_EQ(tree.winding_number(point) == 1, in_both) << point.transpose();
    inside += in_both;
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(decided, 2500);
  const double least = std::min(enclosed_volume(halves[0].mesh), enclosed_volume(halves[1].mesh));
  EXPECT_LT(enclosed_volume(both.mesh), least);
}

TEST_F(MissionPlaces, ARectangleAboutAPlace) {
  const std::string place = "center: [48.1374, 11.5755], width: 8, length: 20";
  const Mission north = placed(map_scene(), "target: {" + place + "}\n");
  const Mission east = placed(map_scene(), "target: {" + place + ", heading: 90}\n");
  const Mission between = placed(map_scene(), "target: {" + place + ", heading: 45}\n");
  for (const Mission* one : {&north, &east, &between}) EXPECT_NEAR(area_of(one->target), 160, 0.01);
  for (const Vec3& vertex : north.target.parts[0]) {
    EXPECT_NEAR(std::abs(vertex.x()), 4, 1e-3);
    EXPECT_NEAR(std::abs(vertex.y()), 10, 1e-3) << "the length runs to the north";
  }
  for (const Vec3& vertex : east.target.parts[0]) EXPECT_NEAR(std::abs(vertex.x()), 10, 1e-3);
  double most = -INFINITY;
  for (const Vec3& vertex : between.target.parts[0]) most = std::max(most, vertex.dot(Vec3(1, 1, 0)) / std::sqrt(2));
  EXPECT_NEAR(most, 10, 1e-3) << "45 degrees is north-east";
}

TEST_F(MissionPlaces, ANamedAreaGivesItsNameToTheTarget) {
  MapText map(kCentre);
  map.box(30, -10, 45, 10, {{"building", "yes"}});
  map.box(-10, -10, 10, 10, {{"leisure", "park"}, {"name", "Zuccotti Park"}});
  write("city.osm", map.text());
  const Mission unnamed = placed("osm: city.osm", "target: {osm: way/2}\n");
  EXPECT_EQ(unnamed.target.name, "Zuccotti Park (way/2)");
  const Mission named = placed("osm: city.osm", "target: {osm: way/2, name: lawn}\n");
  EXPECT_EQ(named.target.name, "lawn");
  mission("osm: city.osm", "target: {osm: way/2}\n");
  EXPECT_NE(run({"compute", "mission.yaml", "-o", "out.ply"}).out.find("Zuccotti Park"), std::string::npos);
  const auto report = nlohmann::json::parse(content(folder_ / "out.report.json"));
  EXPECT_EQ(report.at("target"), unnamed.target.name);
}

// ---- the ground under it ----

Box ground_box(const Scene& scene) {
  Box box;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (display_name(scene.objects[scene.object_of[i]]) != "ground") continue;
    for (const std::uint32_t vertex : scene.mesh.triangles[i]) box.extend(scene.mesh.vertices[vertex]);
  }
  return box;
}

TEST_F(MissionPlaces, FlatGroundIsExtendedToHoldTheTarget) {
  MapText map(kCentre);
  map.box(-20, -20, 0, 0, {{"building", "yes"}, {"height", "8"}});
  map.box(60, -10, 120, 40, {{"leisure", "park"}});    // way/2: the ground ends at 50
  map.box(300, 300, 340, 330, {{"leisure", "park"}});  // way/3: nothing is built near it
  write("city.osm", map.text());
  for (const std::string name : {"way/2", "way/3"}) {
    const Mission result = placed("osm: city.osm", "target: {osm: " + name + "}\n");
    EXPECT_EQ(notes_.size(), 1u);
    const Box ground = ground_box(scene_);
    for (const Vec3& vertex : result.target.parts[0]) {
      EXPECT_EQ(vertex.z(), 0);
      EXPECT_GT((vertex - ground.min).head<2>().minCoeff(), 10);
      EXPECT_GT((ground.max - vertex).head<2>().minCoeff(), 10);
    }
    const Volume seen = volume("osm: city.osm", "target: {osm: " + name + "}\n");
    ASSERT_EQ(seen.outcome, Outcome::computed) << seen.reason;
    ASSERT_FALSE(seen.notes.empty());
    EXPECT_EQ(seen.notes[0].code, WarningCode::ground_extended);
    testing::expect_wording(seen.notes[0].text);
  }
  // By its place in degrees, a little off the ground; and in a scene that was written to a file.
  const geo::LonLat at = frame_.to_lonlat({80, 10});
  const std::string target =
      "target: {center: [" + text_of(at.latitude_deg) + ", " + text_of(at.longitude_deg) + "], width: 8, length: 12}\n";
  placed("osm: city.osm", target);
  EXPECT_EQ(notes_.size(), 1u);
  output_of({"scene", "city.osm", "-q", "-o", "built.glb"});
  placed("mesh: built.glb", target);
  EXPECT_EQ(notes_.size(), 1u);
  // What is large enough stays as it is.
  placed("osm: city.osm", "target: {center: [48.1374, 11.57575], width: 8, length: 12}\n");
  EXPECT_TRUE(notes_.empty());
  // As large as it takes, though nothing can see all of it.
  const Volume field = volume("osm: city.osm", "target: {center: [48.1374, 11.5757], width: 5, length: 5000}\n");
  EXPECT_EQ(field.outcome, Outcome::out_of_range);
}

TEST_F(MissionPlaces, TerrainIsBuiltAsFarAsTheTarget) {
  MapText map(kCentre);
  map.box(-20, -20, 0, 0, {{"building", "yes"}, {"height", "8"}});
  map.box(60, -10, 120, 40, {{"leisure", "park"}});
  write("city.osm", map.text());
  const std::string scene = "osm: city.osm, terrain: dem.asc, error: 0.01";
  const Mission result = placed(scene, "target: {osm: way/2}\n");
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_EQ(notes_[0].code, WarningCode::ground_extended);
  testing::expect_wording(notes_[0].text);
  for (const Vec3& vertex : result.target.parts[0]) {
    const double north =
        frame_
            .to_local(geo::LocalFrame({scene_.georeference->longitude_deg, scene_.georeference->latitude_deg})
                          .to_lonlat(vertex.head<2>()))
            .y();
    EXPECT_NEAR(vertex.z(), 500 + kSlope * north, 0.05);
  }
}

// ---- what stands on it ----

TEST_F(CliMissionPlaces, WhatStandsOnATargetCanBeLeftOut) {
  MapText map(kCentre);
  map.box(60, -10, 75, 10, {{"building", "yes"}, {"height", "20"}});
  map.box(-10, -10, 10, 10, {{"leisure", "pitch"}, {"barrier", "fence"}});  // way/2, with its fence
  map.box(20, -10, 40, 10, {{"leisure", "pitch"}});                         // way/3, with another's
  map.line({{20, -10}, {40, -10}, {40, 10}}, {{"barrier", "fence"}});
  map.box(-60, -10, -30, 20, {{"leisure", "park"}});  // way/5
  map.node(-45, 5, {{"natural", "tree"}});
  map.box(-60, 40, -30, 70, {{"amenity", "parking"}});  // way/6: a building stands on it
  map.box(-50, 50, -40, 60, {{"building", "yes"}, {"height", "12"}});
  write("city.osm", map.text());
  const std::string scene = "osm: city.osm";
  expect_refused(scene, "target: {osm: way/2}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {osm: way/3}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {osm: way/5}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {osm: way/6}\n", "mission.yaml:2:");
  for (const char* target : {"target: {osm: way/2}\n", "target: {osm: way/3}\n"}) {
    EXPECT_EQ(volume(scene + ", without: [walls]", target).outcome, Outcome::computed);
  }
  const Volume without_trees = volume(scene + ", without: [trees]", "target: {osm: way/5}\n");
  EXPECT_EQ(without_trees.outcome, Outcome::computed);
}

// ---- on a slope ----

TEST_F(MissionPlaces, ATargetLiesOnTheSlope) {
  for (const char* const target :
       {"target: {osm: way/2}\n", "target: {center: [48.1374, 11.5755], width: 20, length: 20}\n"}) {
    const Mission result = placed(map_scene() + ", terrain: dem.asc, error: 0.01", target);
    for (const Vec3& vertex : result.target.parts[0]) {
      EXPECT_NEAR(vertex.z(), 500 + kSlope * vertex.y(), 0.03) << target;
    }
    const Vec3 normal = make_target_frame(result.target).normal;
    EXPECT_NEAR((normal - Vec3(0, -kSlope, 1).normalized()).norm(), 0, 2e-3);
    const Volume seen =
        run_mission(resolve_mission(mission(map_scene() + ", terrain: dem.asc, error: 0.01", target))).volume;
    ASSERT_EQ(seen.outcome, Outcome::computed) << seen.reason;
    EXPECT_GT(enclosed_volume(seen.mesh), 2e5);
  }
}

TEST_F(CliMissionPlaces, ComputeQueryVerifyAndRenderOnASlope) {
  const std::map<std::string, std::string> above = {{"way/2", "0,0,"}, {"way/3", "-55,-10,"}};
  for (const auto& [name, place] : above) {
    mission(map_scene() + ", terrain: dem.asc", "target: {osm: " + name + "}\n");
    output_of({"compute", "mission.yaml", "-q", "-o", "volume.ply"});
    const auto report = nlohmann::json::parse(content(folder_ / "volume.report.json"));
    EXPECT_EQ(report.at("outcome"), "computed");
    EXPECT_EQ(report.at("georeference").at("latitude_deg"), 48.1374);
    const auto verified =
        nlohmann::json::parse(output_of({"verify", "mission.yaml", "volume.ply", "--points", "2000", "--json"}));
    EXPECT_EQ(verified.at("right"), true) << verified.dump();
    EXPECT_GT(verified.at("inside").get<int>(), 100);
    std::string points;
    for (const char* const z : {"540\n", "400\n", "700\n"}) points.append(place).append(z);
    write("points.csv", points);
    const std::vector<std::string> answers = lines(output_of({"query", "mission.yaml", "points.csv"}));
    ASSERT_EQ(answers.size(), 4U);
    EXPECT_NE(answers[1].find(",true,"), std::string::npos) << answers[1];
    EXPECT_NE(answers[2].find(",false,"), std::string::npos) << answers[2];
    EXPECT_NE(answers[3].find(",false,"), std::string::npos) << answers[3];
    if (!why_no_opengl().empty()) continue;
    output_of({"render", "mission.yaml", "--volume", "volume.ply", "--size", "320x240", "-q", "-o", "picture.png"});
    EXPECT_EQ(content(folder_ / "picture.png").substr(1, 3), "PNG");
  }
}

// ---- what is refused ----

TEST_F(CliMissionPlaces, TargetsThatAreNone) {
  const std::string scene = map_scene();
  expect_refused(scene, "target: {osm: way/999}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {osm: way/5}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {osm: plaza}\n", "mission.yaml:2:");
  expect_refused("mesh: city.obj", "target: {osm: way/2}\n", "mission.yaml:2:");
  expect_refused("mesh: city.obj", "target: {center: [48, 11], width: 5, length: 5}\n", "mission.yaml");
  expect_refused(scene, "target: {center: [48.2, 11.5755], width: 5, length: 5}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {center: [11.5755, 48.1374], width: 5, length: 5}\n", "mission.yaml:2:");
  expect_refused("osm: city.osm", "target: {center: [48.2, 11.5755], width: 5, length: 5}\n", "mission.yaml:2:");
  expect_refused("osm: city.osm", "target: {osm: way/999}\n", "mission.yaml:2:");
  expect_refused(scene + ", terrain: dem.asc", "target: {center: [48.1374, 11.5755], width: 5, length: 5000}\n",
                 "dem.asc");
  expect_refused("raster: dem.asc", "target: {center: [48.1373, 11.5656], width: 200, length: 20}\n",
                 "mission.yaml:2:");
  expect_refused(scene, "target: {center: [148.1, 11], width: 5, length: 5}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {center: [48.1374, 11.5755], width: 5}\n", "mission.yaml");
  expect_refused(scene, "target: {center: [48.1374, 11.5755], width: -5, length: 5}\n", "mission.yaml:2:");
  expect_refused(scene, "target: {width: 5, vertices: [[0,0,0],[1,0,0],[0,1,0]]}\n", "mission.yaml:2:");
}

TEST_F(CliMissionPlaces, SystemsAndScenesThatAreNone) {
  const std::string target =
      "target: {vertices: [[11.5755, 48.1374, 0], [11.5756, 48.1374, 0], [11.5756, 48.1375, 0]]}\n";
  expect_refused(map_scene(), "crs: EPSG:999999\n" + target, "mission.yaml");
  expect_refused("mesh: city.obj", "crs: EPSG:4326\n" + target, "mission.yaml");
  expect_refused("osm: none.osm", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, center: [11.5755, 48.1374], radius: 300", target, "");
  expect_refused("osm: city.osm, radius: 300", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, mesh: city.obj", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, terrain: none.tif", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, lod: 2", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, without: [doors]", target, "mission.yaml:1:");
  expect_refused("osm: city.osm, defaults: {level: -3}", target, "mission.yaml:1:");
}

}  // namespace
}  // namespace vantage::testing
