// What a mission's notes say of missions that can only be nonsense, and that they say nothing of ordinary ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "app/scene_warnings.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/scene_source.h"

namespace vantage {
namespace {

using app::scene_warnings;
using testing::TemporaryDirectory;
using testing::write_bytes;

/// Boxes on ground, turned about z, z up.
struct Boxes {
  std::vector<Vec3> vertices;
  std::vector<std::vector<std::size_t>> faces;

  void box(const Vec3& centre, const Vec3& half, double turn_deg = 0) {
    const double turn = turn_deg * std::numbers::pi / 180;
    const std::size_t first = vertices.size() + 1;
    for (int i = 0; i < 8; ++i) {
      const double x = (i & 1 ? 1 : -1) * half.x(), y = (i & 2 ? 1 : -1) * half.y(), z = (i & 4 ? 1 : -1) * half.z();
      vertices.emplace_back(centre.x() + std::cos(turn) * x - std::sin(turn) * y,
                            centre.y() + std::sin(turn) * x + std::cos(turn) * y, centre.z() + z);
    }
    for (const auto& face : std::vector<std::vector<std::size_t>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
      faces.push_back({});
      for (const std::size_t corner : face) faces.back().push_back(first + corner);
    }
  }
  void ground(double half, double z = 0) {
    const std::size_t first = vertices.size() + 1;
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      vertices.emplace_back(half * x, half * y, z);
    }
    faces.push_back({first, first + 1, first + 2, first + 3});
  }

  /// OBJ; with y up when asked for.
  std::string text(bool y_up = false, double scale = 1, const Vec3& offset = Vec3::Zero()) const {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(17);
    for (const Vec3& v : vertices) {
      const Vec3 p = scale * v + offset;
      if (y_up) {
        out << "v " << p.x() << " " << p.z() << " " << -p.y() << "\n";
      } else {
        out << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
      }
    }
    for (const auto& face : faces) {
      out << "f";
      for (const std::size_t corner : face) out << " " << corner;
      out << "\n";
    }
    return out.str();
  }
};

Boxes city(double turn_deg) {
  Boxes boxes;
  boxes.ground(300);
  testing::Random random(97);
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      if (i == 0 && j == 0) continue;
      const double height = random.uniform(4, 20);
      boxes.box({60.0 * i, 60.0 * j, height / 2}, {15, 12, height / 2}, turn_deg + random.uniform(-3, 3));
    }
  }
  return boxes;
}

std::string text_of(const std::vector<Vec3>& points) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  for (const Vec3& p : points)
    out << (&p == points.data() ? "[" : ", ") << "[" << p.x() << ", " << p.y() << ", " << p.z() << "]";
  return out.str() + "]";
}

std::vector<Vec3> square(double half, const Vec3& centre = Vec3::Zero()) {
  return {centre + Vec3(-half, -half, 0), centre + Vec3(half, -half, 0), centre + Vec3(half, half, 0),
          centre + Vec3(-half, half, 0)};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class MissionWarnings : public ::testing::Test {
 protected:
  /// The notes of the computed volume.
  std::vector<Warning> notes(const std::string& obj, const std::string& target, double range,
                             const std::string& scene = "", const std::string& more = "") {
    write_bytes(folder_ / "scene.obj", obj);
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    text << "scene: {mesh: scene.obj" << scene << "}\ntarget: {" << target << "}\nsensor: {max_range: " << range
         << "}\nmethod: exact\nexact: {tolerance: " << range / 50 << "}\n"
         << more;
    write_bytes(folder_ / "mission.yaml", text.str());
    return run_mission(resolve_mission(read_mission(folder_ / "mission.yaml"))).volume.notes;
  }
  static std::string vertices(const std::vector<Vec3>& points) { return "vertices: " + text_of(points); }

  TemporaryDirectory folder_;
};

TEST_F(MissionWarnings, ATargetOffTheSceneIsTold) {
  for (const double scale : {1e-3, 1e-2, 1.0, 1e2, 1e4}) {
    for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(4.5e5, 5e6, 0)}) {
      SCOPED_TRACE(scale);
      Boxes boxes;
      boxes.ground(1);
      boxes.box({0.5, 0.5, 0.1}, {0.1, 0.1, 0.1});
      const std::string obj = boxes.text(false, scale, offset);
      const auto at = [&](double x) {
        return vertices(square(0.1 * scale, offset + Vec3(x * scale, 0, 0.01 * scale)));
      };
      const std::vector<Warning> near = notes(obj, at(0), scale);
      EXPECT_TRUE(near.empty()) << near.front().text;
      EXPECT_TRUE(notes(obj, at(1.9), scale).empty());  // the ground's rim is within range
      const std::vector<Warning> far = notes(obj, at(14), scale);
      ASSERT_EQ(far.size(), 1u);
      EXPECT_EQ(far[0].code, WarningCode::range_beyond_scene) << far[0].text;
    }
  }
  const std::vector<Warning> far = notes(city(0).text(), vertices(square(5, {14300, 0, 0})), 100);
  ASSERT_EQ(far.size(), 1u);
  EXPECT_EQ(far[0].code, WarningCode::range_beyond_scene);
  EXPECT_TRUE(has(far[0].text, "14 km")) << far[0].text;  // from 300 m
  testing::expect_wording(far[0].text);
}

TEST_F(MissionWarnings, ASceneOnItsSideIsTold) {
  for (const double turn : {0.0, 20.0, 45.0}) {
    SCOPED_TRACE(turn);
    const Boxes boxes = city(turn);
    const std::string target = vertices(square(5, {0, 0, 30}));
    EXPECT_TRUE(notes(boxes.text(), target, 100).empty());
    EXPECT_TRUE(notes(boxes.text(true), target, 100, ", up: y").empty());
    const std::string beside = vertices(square(5, {0, 200, 0}));
    for (const bool y_up : {true, false}) {
      const std::vector<Warning> lying = notes(boxes.text(y_up), beside, 400, y_up ? "" : ", up: y");
      ASSERT_FALSE(lying.empty());
      EXPECT_EQ(lying[0].code, WarningCode::scene_on_its_side);
      EXPECT_TRUE(has(lying[0].text, y_up ? "scene.up: y" : "scene.up: z")) << lying[0].text;
      if (turn == 0) testing::expect_wording(lying[0].text);
    }
    const Error error = testing::expect_code([&] { notes(boxes.text(true), vertices(square(5)), 100); },
                                             ErrorCode::target_pierced);  // by the ground, which stands upright
    EXPECT_TRUE(has(error.fix(), "scene.up: y")) << error.what();
  }
}

TEST_F(MissionWarnings, WhatStandsUprightIsNoSceneOnItsSide) {
  Boxes facade;  // a front of windows alone
  for (int i = 0; i < 20; ++i) facade.box({4.0 * i, 0.1 * (i % 2), 15}, {2, 0.3, 15});
  EXPECT_TRUE(notes(facade.text(), vertices({{10, -5, 2}, {20, -5, 2}, {20, -5, 9}, {10, -5, 9}}), 40).empty());
  Boxes tower;
  tower.ground(60);
  tower.box({0, 0, 200}, {20, 20, 200}, 10);
  EXPECT_TRUE(notes(tower.text(), vertices(square(5, {40, 0, 0})), 100).empty());
  Boxes slab;  // 20 storeys, long and thin
  slab.ground(100);
  slab.box({0, 0, 60}, {80, 8, 60});
  EXPECT_TRUE(notes(slab.text(), vertices(square(5, {0, 40, 0})), 100).empty());
}

/// Houses without ground: their walls are more than their roofs, and corners stand on one level.
TEST_F(MissionWarnings, HousesAloneOnTheirSideAreTold) {
  testing::Random random(98);
  Boxes houses;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double height = i == 3 && j == 2 ? 32 : random.uniform(8, 24);
      houses.box({32.0 * i, 30.0 * j, height / 2}, {8, 6, height / 2}, random.uniform(-3, 3));  // 368 m long
    }
  }
  const std::string target = vertices(square(4, {15, 15, 40}));
  EXPECT_TRUE(notes(houses.text(), target, 60).empty());
  EXPECT_TRUE(notes(houses.text(true), target, 60, ", up: y").empty());
  const std::vector<Warning> lying = notes(houses.text(true), target, 60);
  ASSERT_FALSE(lying.empty());
  EXPECT_EQ(lying[0].code, WarningCode::scene_on_its_side);
  testing::expect_wording(lying[0].text);
  // Also where the file is only looked at.
  LoadedScene loaded;
  loaded.scene = read_scene(folder_ / "scene.obj");
  const std::vector<std::string> noted = notes_of(loaded);
  EXPECT_EQ(std::count(noted.begin(), noted.end(), lying[0].text), 1);
  EXPECT_EQ(notes_of(loaded), noted);  // kept from the first time

  Boxes row;  // a street front: long, and higher than deep
  for (int i = 0; i < 10; ++i) row.box({10.0 * i, 0, 15}, {5, 6, 15 - 0.3 * (i % 3)});
  EXPECT_TRUE(notes(row.text(), vertices(square(3, {20, 20, 2})), 40).empty());
}

TEST_F(MissionWarnings, ATargetInsideAHouseIsTold) {
  Boxes boxes;
  boxes.ground(60);
  boxes.box({20, 0, 5}, {6, 6, 5});
  std::string obj = boxes.text();
  obj.insert(obj.find("\nf ", obj.find("\nf ") + 1) + 1, "o house\n");  // an object of its own: it is closed
  for (const std::string& target : {std::string("point: [20, 0, 4]"), vertices(square(2, {20, 0, 4}))}) {
    for (const std::string place : {"", ", origin: [48.0, 11.0]"}) {
      const std::vector<Warning> inside = notes(obj, target, 40, place);
      ASSERT_EQ(inside.size(), 1u) << target;
      EXPECT_EQ(inside[0].code, WarningCode::target_inside);
      testing::expect_wording(inside[0].text);
    }
  }
  // Some of it: the middle is outside.
  notes(obj, "point: [0, 0, 2]", 40);
  write_bytes(folder_ / "mission.yaml",
              "scene: {mesh: scene.obj}\ntarget: {" + vertices(square(4, {28, 0, 4})) + "}\nsensor: {max_range: 40}\n");
  const std::vector<Warning> some = mission_warnings(resolve_mission(read_mission(folder_ / "mission.yaml")), nullptr);
  ASSERT_EQ(some.size(), 1u);
  EXPECT_EQ(some[0].code, WarningCode::target_inside);
  testing::expect_wording(some[0].text);
  // On its roof, before its wall, and beside it.
  EXPECT_TRUE(notes(obj, vertices(square(2, {20, 0, 10})), 40).empty());
  EXPECT_TRUE(
      notes(obj, vertices({{14, -2, 2}, {14, 2, 2}, {14, 2, 6}, {14, -2, 6}}) + ", front: [-1, 0, 0]", 40).empty());
  EXPECT_TRUE(notes(obj, "point: [0, 0, 2]", 40).empty());
}

/// Ground and all that stands on it may be one object.
TEST_F(MissionWarnings, ClosedPartsOfAnObjectAreTold) {
  Boxes boxes;
  boxes.ground(60);
  boxes.box({20, 0, 5}, {6, 6, 5});
  boxes.box({22, 2, 3}, {6, 6, 3});  // overlaps the other one
  boxes.box({-20, 0, 12}, {6, 6, 1});
  for (const Vec3& place : {Vec3(15, -5, 4), Vec3(20, 0, 4), Vec3(27, 7, 4)}) {
    const std::string list = text_of({place});
    const std::vector<Warning> inside = notes(boxes.text(), "point: " + list.substr(1, list.size() - 2), 40);
    ASSERT_EQ(inside.size(), 1u) << place.transpose();
    EXPECT_EQ(inside[0].code, WarningCode::target_inside);
  }
  EXPECT_TRUE(notes(boxes.text(), "point: [-20, 0, 4]", 40).empty());  // under the slab
  Boxes open;                                                          // a roof without floor
  open.ground(60);
  open.box({20, 0, 5}, {6, 6, 5});
  open.faces.erase(open.faces.begin() + 1);
  EXPECT_TRUE(notes(open.text(), "point: [20, 0, 4]", 40).empty());
}

/// What the note says to write is run, whatever the object is called.
TEST_F(MissionWarnings, TheAdviceForARoofCanBeFollowed) {
  Boxes boxes;
  boxes.ground(60);
  boxes.box({20, 0, 5}, {6, 6, 5});
  for (const std::string name :
       {"house", "it's \"A\", [no] {map}: #1", "12", "no",
        "a house with a name that is longer than what messages show of names, which is no more than sixty bytes"}) {
    for (const std::string place : {"", ", origin: [48.0, 11.0]"}) {
      SCOPED_TRACE(name + place);
      std::string obj = boxes.text();
      obj.insert(obj.find("\nf ", obj.find("\nf ") + 1) + 1, "o " + name + "\n");
      const std::vector<Warning> inside = notes(obj, "point: [20, 0, 4]", 40, place);
      ASSERT_EQ(inside.size(), 1u);
      const std::size_t begin = inside[0].text.find("write '") + 7, end = inside[0].text.rfind('\'');
      ASSERT_LT(begin, end) << inside[0].text;
      const std::string target = inside[0].text.substr(begin, end - begin);
      write_bytes(folder_ / "mission.yaml",
                  "scene: {mesh: scene.obj" + place + "}\n" + target + "\nsensor: {max_range: 40}\n");
      const Mission roof = resolve_mission(read_mission(folder_ / "mission.yaml"));
      ASSERT_FALSE(roof.target.parts.empty()) << target;
      for (const std::vector<Vec3>& part : roof.target.parts) {
        for (const Vec3& vertex : part) EXPECT_NEAR(vertex.z(), 10, 1e-9) << target;
      }
    }
  }
}

TEST_F(MissionWarnings, ALargePixelIsTold) {
  Boxes boxes;
  boxes.ground(60);
  const auto with_pixel = [&](const std::string& size) {
    write_bytes(folder_ / "scene.obj", boxes.text());
    write_bytes(
        folder_ / "mission.yaml",
        "scene: {mesh: scene.obj}\ntarget: {" + vertices(square(4)) +
            "}\nsensor: {camera: {width: 4000, height: 3000, focal_length: 24, sensor_width: 36}, pixel: {size: " +
            size + "}}\n");
    return mission_warnings(resolve_mission(read_mission(folder_ / "mission.yaml")), nullptr);
  };
  const std::vector<Warning> large = with_pixel("2");
  ASSERT_EQ(large.size(), 1u);
  EXPECT_EQ(large[0].code, WarningCode::pixel_in_metres);
  testing::expect_wording(large[0].text);
  EXPECT_TRUE(with_pixel("0.02").empty());
}

TEST_F(MissionWarnings, ATargetOnTheGroundLookedAtFromBelowIsTold) {
  const std::string down = ", front: [0, 0, -1]";
  Boxes flat;
  flat.ground(100);
  flat.box({30, 0, 5}, {5, 5, 5});
  const std::vector<Warning> under = notes(flat.text(), vertices(square(5)) + down, 50);
  ASSERT_EQ(under.size(), 1u);
  EXPECT_EQ(under[0].code, WarningCode::target_from_below);
  EXPECT_TRUE(has(under[0].text, "target.front")) << under[0].text;
  testing::expect_wording(under[0].text);
  EXPECT_TRUE(notes(flat.text(), vertices(square(5)), 50).empty());
  EXPECT_TRUE(notes(flat.text(), vertices(square(5)) + ", front: [0, 0, 1]", 50).empty());

  Boxes hills = flat;  // lower ground elsewhere
  hills.box({-300, 0, -50}, {50, 50, 10});
  EXPECT_EQ(notes(hills.text(), vertices(square(5)) + down, 50).size(), 1u);

  Boxes bridge = flat;  // its underside is looked at
  bridge.box({0, 0, 12}, {20, 6, 1});
  EXPECT_TRUE(notes(bridge.text(), vertices(square(4, {0, 0, 11})) + down, 50).empty());
}

TEST_F(MissionWarnings, AVolumeBelowAllOfTheSceneIsTold) {
  Boxes slab;
  slab.box({0, 0, 0.5}, {20, 20, 0.5});
  const std::string target = vertices({{28, 0, -2}, {32, 0, -2}, {30, 0, 3}}) + ", front: [0, 1, 0]";
  EXPECT_TRUE(notes(slab.text(), target, 40).empty());
  EXPECT_TRUE(notes(slab.text(), target, 40, "", "navigation: {altitude: [-20, 1]}\n").empty());
  const std::vector<Warning> below = notes(slab.text(), target, 40, "", "navigation: {altitude: [-20, -3]}\n");
  ASSERT_EQ(below.size(), 1u);
  EXPECT_EQ(below[0].code, WarningCode::volume_below_scene);
  testing::expect_wording(below[0].text);
}

TEST(MissionWarningsOfExamples, AreNone) {
  const auto notes_on = [](const char* file) {
    return run_mission(resolve_mission(read_mission(testing::source_folder() / file))).volume.notes;
  };
  EXPECT_EQ(notes_on("examples/plaza/mission.yaml"), std::vector<Warning>());
  const std::vector<Warning> town = notes_on("examples/town/mission.yaml");  // a house of the height "concrete"
  ASSERT_EQ(town.size(), 1U);
  EXPECT_EQ(town[0].code, WarningCode::scene_incomplete);
}

// Not computed: that takes long, and only what lies below the scene needs the volume.
TEST(MissionWarningsOfExamples, AreNoneInTheGallery) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  // VANTAGE_SHARED may be elsewhere; the missions name the folder beside the checkout.
  const std::filesystem::path beside = testing::source_folder() / ".." / "shared" / "data";
  if (!std::filesystem::exists(beside))
    GTEST_SKIP() << "needs " << beside.lexically_normal().string() << ": put it there";
  for (const char* folder : {"docs/gallery", "docs/maps", "docs/paper"}) {
    for (const auto& entry : std::filesystem::directory_iterator(testing::source_folder() / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      if (entry.path().stem() == "empire_state_outlines") continue;  // its map is made by a script
      const Mission mission = resolve_mission(read_mission(entry.path()));
      EXPECT_EQ(scene_warnings(mission, nullptr), std::vector<Warning>()) << entry.path();
    }
  }
}

TEST(MissionWarningsOfExamples, KnowRealCitiesThatLieOnTheirSide) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  const std::vector<std::pair<const char*, UpAxis>> cities = {
      {"charlotte/uptownCharlotte.obj", UpAxis::y}, {"battcave/battcave.obj", UpAxis::y},
      {"mesh/munich_merged.ply", UpAxis::z},        {"mesh/florence_merged.ply", UpAxis::z},
      {"mesh/etoile_merged.ply", UpAxis::z},        {"mesh/delft-3dfier.obj.gz", UpAxis::z}};
  for (const auto& [file, up] : cities) {
    LoadedScene right, wrong;
    right.scene = read_scene(testing::shared_data(file), {.up = up});
    wrong.scene = read_scene(testing::shared_data(file), {.up = up == UpAxis::y ? UpAxis::z : UpAxis::y});
    EXPECT_FALSE(app::on_its_side(right)) << file;
    EXPECT_TRUE(app::on_its_side(wrong)) << file;
  }
  for (const char* const file :
       {"mesh/simple_street_canyon_merged.ply", "mesh/tour_part_dieu_0.obj", "mesh/openfoam-buildings.obj.gz"}) {
    LoadedScene right;
    right.scene = read_scene(testing::shared_data(file));
    EXPECT_FALSE(app::on_its_side(right)) << file;
  }
}

}  // namespace
}  // namespace vantage
