// Roofs and facades that missions name: by an object of any scene, of a map, or by a place.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <variant>

#include "geo/local_frame.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "vantage/target.h"

namespace vantage {
namespace {

using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

constexpr geo::LonLat kOrigin = {11.5755, 48.1374};

double area_of(const Target& target) {
  double area = 0;
  for (const std::vector<Vec3>& part : target.parts) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < part.size(); ++i) sum += (part[i] - part[0]).cross(part[i + 1] - part[0]) / 2;
    area += sum.norm();
  }
  return area;
}

Vec3 normal_of(const Target& target, std::size_t part = 0) { return make_target_frame(target, part).normal; }

class FaceTargets : public ::testing::Test {
 protected:
  void SetUp() override {
    write_bytes(folder_ / "city.obj",
                "o ground\nv -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n"
                "o town_hall\nv 20 -5 0\nv 30 -5 0\nv 30 5 0\nv 20 5 0\nv 20 -5 12\nv 30 -5 12\nv 30 5 12\nv 20 5 12\n"
                "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n");
    MapText map(kOrigin);
    map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}, {"name", "Town Hall"}});  // way/1
    map.box(10, -10, 20, 10, {{"building", "yes"}, {"height", "6"}});                           // way/2
    map.box(40, 0, 60, 10, {{"building", "yes"}, {"name", "School"}});                          // way/3
    map.box(40, 0, 50, 10, {{"building:part", "yes"}, {"height", "9"}});                        // way/4
    map.box(50, 0, 60, 10, {{"building:part", "yes"}, {"height", "15"}});                       // way/5
    write_bytes(folder_ / "city.osm", map.text());
  }

  MissionFile file(const std::string& target, const std::string& scene) {
    write_bytes(folder_ / "mission.yaml", "scene: " + scene + "\nsensor: {max_range: 60}\ntarget: " + target + "\n");
    return read_mission(folder_ / "mission.yaml");
  }
  static const FaceTarget& faces_of(const MissionFile& file) { return std::get<FaceTarget>(file.targets[0].source); }
  Mission mesh(const std::string& target) { return resolve_mission(file(target, "{mesh: city.obj}")); }
  Mission map(const std::string& target) { return resolve_mission(file(target, "{osm: city.osm}")); }

  void expect_refused(const std::string& target, ErrorCode code, const std::string& scene = "{mesh: city.obj}") {
    SCOPED_TRACE(target);
    testing::expect_error([&] { resolve_mission(file(target, scene)); }, code, "mission.yaml:3:");
  }

  static std::string at(double east, double north) {
    const geo::LonLat place = geo::LocalFrame(kOrigin).to_lonlat({east, north});
    char text[64];
    std::snprintf(text, sizeof text, "[%.9f, %.9f]", place.latitude_deg, place.longitude_deg);
    return text;
  }

  TemporaryDirectory folder_;
};

TEST_F(FaceTargets, OfAnObjectOfAnyScene) {
  const Mission roof = mesh("{object: town_hall, part: roof}");
  testing::expect_wording(roof.target.name);
  ASSERT_EQ(roof.target.parts.size(), 1U);
  EXPECT_EQ(area_of(roof.target), 100);
  EXPECT_EQ(normal_of(roof.target), Vec3::UnitZ());
  const Mission south = mesh("{object: town_hall, part: facade, facing: south, offset: 0.5}");
  testing::expect_wording(south.target.name);
  EXPECT_NEAR(area_of(south.target), 120, 1e-9);
  EXPECT_TRUE(normal_of(south.target).isApprox(-Vec3::UnitY()));
  EXPECT_EQ(make_target_frame(south.target).origin.y(), -5.5) << "an offset moves it outward";
  for (const char* same :
       {"{object: town_hall, part: facade, facing: 200}", "{object: town_hall, part: facade, nearest: [25, -40, 3]}"}) {
    EXPECT_EQ(mesh(same).target.parts, south.target.parts);
  }
  const Mission all = mesh("{name: walls, object: town_hall, part: facade}");
  EXPECT_EQ(all.target.name, "walls");
  EXPECT_EQ(all.target.parts.size(), 4U) << "all of them must be seen";
  EXPECT_EQ(run_mission(all).volume.outcome, Outcome::no_common_view);
  const Result result = run_mission(south);
  EXPECT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  EXPECT_TRUE(result.volume.notes.empty());
}

TEST_F(FaceTargets, OfAMap) {
  const Mission hall = map("{osm: way/1, part: facade, facing: east}");
  testing::expect_wording(hall.target.name);
  EXPECT_NEAR(area_of(hall.target), 20 * 12 - 20 * 6, 0.2) << "half of it is covered";
  for (const std::vector<Vec3>& part : hall.target.parts) {
    for (const Vec3& corner : part) EXPECT_GE(corner.z(), 6);
  }
  EXPECT_EQ(run_mission(hall).volume.outcome, Outcome::computed);
  const Mission roof = map("{osm: way/1, part: roof}");
  EXPECT_EQ(roof.target.parts.size(), 1U);
  // A building that is built as its parts.
  EXPECT_EQ(mission_hash(map("{osm: Town Hall, part: roof, name: a}")),
            mission_hash(map("{osm: way/1, part: roof, name: a}")));
  EXPECT_EQ(mission_hash(map("{osm: SCHOOL, part: roof, name: a}")),
            mission_hash(map("{osm: way/3, part: roof, name: a}")))
      << "a building by its name, with its parts";
  const Mission school = map("{osm: way/3, part: roof}");
  EXPECT_EQ(school.target.name, "way/3, roof");
  EXPECT_NEAR(area_of(school.target), 200, 0.5);
  EXPECT_EQ(school.target.parts.size(), 2U);
  const Mission west = map("{osm: way/3, part: facade, facing: west}");
  EXPECT_NEAR(area_of(west.target), 10 * 9 + 10 * 6, 0.5);
  const std::string place = at(55, 5);
  const Mission there = map("{at: " + place + ", part: roof}"), named = map("{object: Town Hall, part: roof}");
  EXPECT_EQ(there.target.name, "way/5, roof");
  const Mission east = map("{at: " + place + ", part: facade, facing: east}");
  EXPECT_NEAR(area_of(east.target), 150, 0.5);
  EXPECT_EQ(named.target.parts, roof.target.parts);
}

TEST_F(FaceTargets, InTheCoordinatesOfTheMission) {
  const geo::LonLat place = geo::LocalFrame(kOrigin).to_lonlat({0, -40});
  char text[64];
  std::snprintf(text, sizeof text, "[%.9f, %.9f, 3]", place.longitude_deg, place.latitude_deg);
  const std::string scene = "{osm: city.osm, center: [48.1374, 11.5755], radius: 200}\ncrs: EPSG:4326";
  write_bytes(folder_ / "mission.yaml", "target: {osm: way/1, part: facade, nearest: " + std::string(text) +
                                            "}\nsensor: {max_range: 60}\nscene: " + scene + "\n");
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  EXPECT_LT(normal_of(mission.target).y(), -0.99);
}

TEST_F(FaceTargets, AreWrittenAsTheyAreRead) {
  for (const char* target : {"{object: town_hall, part: roof}", "{object: town_hall, part: facade, facing: northwest}",
                             "{name: wall, object: town_hall, part: facade, nearest: [1, 2, 3.5], offset: 0.25}",
                             "{object: town_hall, part: facade, facing: -20.5}"}) {
    const MissionFile first = file(target, "{mesh: city.obj}");
    const MissionFile again = read_mission_text(mission_text(first, folder_.path()), folder_ / "again.yaml");
    const FaceTarget &read = faces_of(again), &written = faces_of(first);
    EXPECT_EQ(read.object, written.object);
    EXPECT_EQ(read.kind, written.kind);
    EXPECT_EQ(read.facing_deg, written.facing_deg);
    EXPECT_EQ(read.nearest, written.nearest);
    EXPECT_EQ(again.targets[0].target.name, first.targets[0].target.name);
    EXPECT_EQ(again.targets[0].target.offset_m, first.targets[0].target.offset_m);
    EXPECT_EQ(mission_hash(resolve_mission(again)), mission_hash(resolve_mission(first)));
  }
  const MissionFile at_place = file("{at: " + at(0, 0) + ", part: roof}", "{osm: city.osm}");
  const MissionFile again = read_mission_text(mission_text(at_place, folder_.path()), folder_ / "again.yaml");
  EXPECT_EQ(faces_of(again).at_deg, faces_of(at_place).at_deg);
}

TEST_F(FaceTargets, HaveTheHashOfTheSamePolygons) {
  const std::string roof = mission_hash(mesh("{object: town_hall, part: roof}"));
  const Mission south = mesh("{object: town_hall, part: facade, facing: south}");
  EXPECT_NE(mission_hash(south), roof);
  Mission other = south;
  other.target.front_by_order = true;
  EXPECT_NE(mission_hash(other), mission_hash(south));
  Mission drawn = mesh("{vertices: [[20, -5, 12], [30, -5, 12], [30, 5, 12], [20, 5, 12]]}");
  drawn.target.parts = mesh("{object: town_hall, part: roof}").target.parts;
  EXPECT_EQ(mission_hash(drawn), roof);
}

TEST_F(FaceTargets, ThatAreNone) {
  expect_refused("{object: twon_hall, part: roof}", ErrorCode::object_missing);
  expect_refused("{osm: way/12, part: roof}", ErrorCode::object_missing, "{osm: city.osm}");
  expect_refused("{osm: Town Hal, part: roof}", ErrorCode::map_object_missing, "{osm: city.osm}");
  expect_refused("{object: ground, part: facade}", ErrorCode::face_missing);
  expect_refused("{object: town_hall, part: roof, facing: south}", ErrorCode::face_missing);
  expect_refused("{osm: way/2, part: facade, facing: west}", ErrorCode::face_missing, "{osm: city.osm}");
  expect_refused("{at: " + at(0, 40) + ", part: roof}", ErrorCode::object_missing, "{osm: city.osm}");
  const std::string place = at(0, 0);  // "[latitude, longitude]"
  const std::size_t comma = place.find(", ");
  const std::string swapped =
      "[" + place.substr(comma + 2, place.size() - comma - 3) + ", " + place.substr(1, comma - 1) + "]";
  expect_refused("{at: " + swapped + ", part: roof}", ErrorCode::object_missing, "{osm: city.osm}");
}

TEST_F(FaceTargets, KeysThatDoNotFit) {
  expect_refused("{object: town_hall}", ErrorCode::missing_key);
  expect_refused("{part: roof}", ErrorCode::missing_key);
  expect_refused("{osm: way/1, facing: south}", ErrorCode::missing_key, "{osm: city.osm}");
  expect_refused("{object: town_hall, part: floor}", ErrorCode::unknown_choice);
  expect_refused("{object: town_hall, part: facade, facing: sout}", ErrorCode::unknown_choice);
  expect_refused("{object: town_hall, part: facade, facing: 400}", ErrorCode::value_out_of_range);
  expect_refused("{object: town_hall, part: facade, facing: [1, 2]}", ErrorCode::unknown_choice);
  expect_refused("{object: town_hall, part: facade, facing: east, nearest: [1, 2, 3]}", ErrorCode::conflicting_keys);
  expect_refused("{object: town_hall, osm: way/1, part: roof}", ErrorCode::conflicting_keys);
  expect_refused("{osm: way/1, part: roof}", ErrorCode::not_applicable);
  expect_refused("{object: town_hall, part: roof, front: [0, 0, 1]}", ErrorCode::conflicting_keys);
  expect_refused("{object: town_hall, part: roof, point: [0, 0, 1]}", ErrorCode::conflicting_keys);
  const std::string place = "{at: [48.1, 11.5], part: roof}";
  testing::expect_error([&] { mesh(place); }, ErrorCode::not_georeferenced, "mission.yaml");
}

class CliFaces : public testing::Cli {};

TEST_F(CliFaces, ComputeQueryAndVerifyAFacade) {
  write("mission.yaml",
        std::string(testing::kScene) + "target: {object: block, part: facade, facing: west}\n" + testing::kSensor);
  output_of({"compute", "mission.yaml", "-o", "wall.ply"});
  output_of({"verify", "mission.yaml", "wall.ply", "--points", "2000"});
  write("points.csv", "x,y,z\n0,0,6\n40,0,6\n");
  const std::string answers = output_of({"query", "mission.yaml", "points.csv"});
  EXPECT_NE(answers.find("0,0,6,true,"), std::string::npos) << answers;
  EXPECT_NE(answers.find("40,0,6,false,"), std::string::npos) << answers;
  expect_bad_mission(std::string(testing::kScene) + testing::kSensor + "target: {object: blok, part: roof}\n",
                     "mission.yaml:3:");
}

// All four walls of a building: nobody sees them from one position, and that needs no computation.
TEST_F(FaceTargets, SeveralFacesAreCountedAndRefusedEarlyWhereTheyFaceAway) {
  const auto has = [](const std::vector<Warning>& notes, WarningCode code) {
    return std::any_of(notes.begin(), notes.end(), [&](const Warning& note) { return note.code == code; });
  };
  const Mission walls = mesh("{object: town_hall, part: facade}");
  ASSERT_TRUE(has(walls.notes, WarningCode::faces_together));
  std::vector<std::string> words;
  for (const Warning& note : walls.notes) words.push_back(note.text);
  testing::expect_wording(words);
  const Result none = run_mission(walls);
  EXPECT_EQ(none.volume.outcome, Outcome::no_common_view);
  EXPECT_EQ(none.volume.counts.candidate_blockers, 0U) << "a volume of a part was computed";
  EXPECT_TRUE(has(none.volume.notes, WarningCode::faces_together));
  testing::expect_wording({none.volume.reason, none.volume.hint});
  ASSERT_TRUE(none.volume.provenance);
  EXPECT_EQ(none.volume.provenance->target.parts.size(), walls.target.parts.size());
  EXPECT_EQ(none.volume.lift_m.size(), walls.target.parts.size());

  EXPECT_FALSE(has(mesh("{object: town_hall, part: facade, facing: west}").notes, WarningCode::faces_together));
  EXPECT_FALSE(has(mesh("{object: town_hall, part: roof}").notes, WarningCode::faces_together));
  write_bytes(folder_ / "each.yaml",
              "scene: {mesh: city.obj}\nsensor: {max_range: 60}\ncombine: each\n"
              "target: {object: town_hall, part: facade}\n");
  const Mission each = resolve_mission(read_mission(folder_ / "each.yaml"));
  EXPECT_FALSE(has(each.notes, WarningCode::faces_together));
  for (const Result& one : run_missions(each)) EXPECT_EQ(one.volume.outcome, Outcome::computed) << one.volume.reason;
}

TEST_F(FaceTargets, TwoWallsOfACornerAreSeenFromTheCorner) {
  write_bytes(folder_ / "corner.yaml",
              "scene: {mesh: city.obj}\nsensor: {max_range: 60}\ntargets:\n"
              "  - {object: town_hall, part: facade, facing: west}\n"
              "  - {object: town_hall, part: facade, facing: south}\n");
  const Result corner = run_mission(resolve_mission(read_mission(folder_ / "corner.yaml")));
  EXPECT_EQ(corner.volume.outcome, Outcome::computed) << corner.volume.reason;
  for (const Vec3& vertex : corner.volume.mesh.vertices) {
    EXPECT_LT(vertex.x(), 20 + 1e-6);
    EXPECT_LT(vertex.y(), -5 + 1e-6);
  }
}

// What is hidden, or out of range, may be another target than the faces.
TEST_F(FaceTargets, AdviseOnFacesOnlyWhereNothingElseMayBeTheReason) {
  const auto of_targets = [&](const std::string& more) {
    write_bytes(folder_ / "corner.yaml",
                "scene: {mesh: city.obj}\nsensor: {max_range: 60}\ntargets:\n"
                "  - {object: town_hall, part: facade, facing: southwest}\n" +
                    more);
    return run_mission(resolve_mission(read_mission(folder_ / "corner.yaml"))).volume;
  };
  EXPECT_EQ(of_targets("").outcome, Outcome::computed);
  const Volume none = of_targets("  - {vertices: [[90, 90, 0], [95, 90, 0], [95, 95, 0]]}\n");
  EXPECT_EQ(none.outcome, Outcome::no_common_view);
  EXPECT_TRUE(std::any_of(none.notes.begin(), none.notes.end(),
                          [](const Warning& note) { return note.code == WarningCode::faces_together; }));
  EXPECT_EQ(none.hint.find("facing:"), std::string::npos) << none.hint;
}

// From one place and a little round it: more than nothing, and less than anyone would fly to.
TEST_F(FaceTargets, SaysThatAVolumeIsNextToNothing) {
  write_bytes(folder_ / "small.yaml",
              "scene: {mesh: city.obj}\nsensor: {max_range: 60}\ntarget: {object: town_hall, part: roof}\n"
              "navigation: {keep_in: [{min: [25, 0, 30], max: [25.5, 0.5, 30.5]}]}\n");
  const Mission small = resolve_mission(read_mission(folder_ / "small.yaml"));
  const Result result = run_mission(small);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  EXPECT_NEAR(enclosed_volume(result.volume.mesh), 0.125, 1e-9);
  const auto is_small = [](const Warning& note) { return note.code == WarningCode::volume_small; };
  const auto note = std::find_if(result.volume.notes.begin(), result.volume.notes.end(), is_small);
  ASSERT_NE(note, result.volume.notes.end());
  testing::expect_wording(note->text);
  Mission tiny_world = small;  // a volume that is small because all is
  tiny_world.sensor.max_range_m = 2;
  const std::vector<Warning> notes = mission_warnings(tiny_world, &result.volume);
  EXPECT_TRUE(std::none_of(notes.begin(), notes.end(), is_small));
}

}  // namespace
}  // namespace vantage
