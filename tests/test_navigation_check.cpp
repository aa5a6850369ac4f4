// Limits that are wrong in themselves are refused by all who take them, with the same code and the same words.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct WrongLimit {
  std::string what;
  ErrorCode code;
  Navigation navigation;
};

Zone zone_of(const Zone::Ring& outer, double low, double high) {
  Zone zone;
  zone.outer = outer;
  zone.min_z_m = low;
  zone.max_z_m = high;
  zone.name = "z";
  return zone;
}

std::vector<WrongLimit> wrong_limits() {
  const Zone::Ring square = {{0, 0}, {9, 0}, {9, 9}, {0, 9}}, bow_tie = {{0, 0}, {9, 9}, {9, 0}, {0, 9}};
  const Mesh cube = make_box_mesh({-9, -9, -9}, {9, 9, 9});
  Mesh open = cube, inside_out = cube, crossing = cube, beyond = cube, nowhere = cube;
  open.triangles.pop_back();
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  append(crossing, make_box_mesh({-8, -8, -8}, {8, 8, 12}));
  beyond.triangles[0][0] = 99;
  nowhere.vertices[3].y() = kNaN;
  const auto shared = [](const Mesh& mesh) { return std::make_shared<const Mesh>(mesh); };

  std::vector<WrongLimit> cases;
  const auto add = [&](const std::string& what, ErrorCode code, const std::function<void(Navigation&)>& set) {
    Navigation navigation;
    set(navigation);
    cases.push_back({what, code, navigation});
  };
  const auto band = [&](double low, double high, ErrorCode code) {
    add("altitude", code, [&](Navigation& n) { n.altitude = {low, high}; });
    add("agl", code, [&](Navigation& n) { n.above_ground = AboveGround{low, high, {0, nullptr}}; });
    add("keep_in", code, [&](Navigation& n) { n.keep_in = {Box{{0, 0, low}, {1, 1, high}}}; });
    add("keep_out", code, [&](Navigation& n) { n.keep_out = {Box{{0, 0, low}, {1, 1, high}}}; });
  };
  band(5, 3, ErrorCode::limits_reversed);
  band(5, 5, ErrorCode::limits_empty);
  band(kNaN, 5, ErrorCode::value_out_of_range);
  band(0, kInfinity, ErrorCode::value_out_of_range);
  const auto zone = [&](const Zone& wrong, ErrorCode code) {
    add("keep_in", code, [&](Navigation& n) { n.keep_in = {wrong}; });
    add("keep_out", code, [&](Navigation& n) { n.keep_out = {wrong}; });
  };
  zone(zone_of(square, 5, 3), ErrorCode::limits_reversed);
  zone(zone_of(square, 5, 5), ErrorCode::limits_empty);
  zone(zone_of(square, kNaN, 5), ErrorCode::value_out_of_range);
  zone(zone_of(bow_tie, 0, 5), ErrorCode::zone_not_simple);
  zone(zone_of({{0, 0}, {1, 0}}, 0, 5), ErrorCode::zone_not_simple);
  zone(zone_of({{0, 0}, {9, 0}, {9, kNaN}}, 0, 5), ErrorCode::coordinate_not_finite);
  Zone askew = Box{{0, 0, 0}, {1, 1, 1}}, pierced = askew, triangle = askew;  // they say that they are boxes
  askew.outer[1].y() = 0.5;
  pierced.holes = {{{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}}};
  triangle.outer.pop_back();
  for (const Zone& wrong : {askew, pierced, triangle}) zone(wrong, ErrorCode::value_out_of_range);
  add("zones", ErrorCode::value_out_of_range, [&](Navigation& n) {
    n.keep_in.assign(Navigation::kMostZones / 2, zone_of(square, 0, 5));
    n.keep_out.assign(Navigation::kMostZones / 2 + 1, zone_of(square, 0, 5));
  });
  Zone above = zone_of(square, 0, 50);
  above.above_ground = AboveGround{9, 5, {0, nullptr}};
  zone(above, ErrorCode::limits_reversed);
  above.above_ground = AboveGround{5, 9, {0, shared(beyond)}};
  zone(above, ErrorCode::index_out_of_range);
  const auto mesh = [&](const Mesh& wrong, ErrorCode code) {
    add("mesh", code, [&](Navigation& n) { n.meshes = {{wrong, "airspace.ply"}}; });
  };
  mesh(open, ErrorCode::mesh_not_closed);
  mesh(inside_out, ErrorCode::mesh_inside_out);
  mesh(crossing, ErrorCode::mesh_intersects_itself);
  mesh(beyond, ErrorCode::index_out_of_range);
  mesh(nowhere, ErrorCode::coordinate_not_finite);
  mesh({}, ErrorCode::mesh_empty);
  for (const double distance : {0.0, -1.0, kNaN, kInfinity}) {
    add("clearance", ErrorCode::value_out_of_range, [&](Navigation& n) { n.clearance = {distance, shared(cube)}; });
  }
  add("clearance", ErrorCode::nothing_given, [&](Navigation& n) { n.clearance = Clearance{2, nullptr}; });
  add("clearance", ErrorCode::index_out_of_range, [&](Navigation& n) { n.clearance = {2, shared(beyond)}; });
  add("clearance", ErrorCode::coordinate_not_finite, [&](Navigation& n) { n.clearance = {2, shared(nowhere)}; });
  add("agl", ErrorCode::value_out_of_range, [&](Navigation& n) {
    n.above_ground = AboveGround{1, 5, {kNaN, nullptr}};
  });
  add("agl", ErrorCode::index_out_of_range, [&](Navigation& n) {
    n.above_ground = AboveGround{1, 5, {0, shared(beyond)}};
  });
  add("agl", ErrorCode::coordinate_not_finite, [&](Navigation& n) {
    n.above_ground = AboveGround{1, 5, {0, shared(nowhere)}};
  });
  return cases;
}

/// A square on open ground, and a box over it for a volume.
struct Yard {
  Scene scene;
  Target target = Target::polygon({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  Sensor sensor{.max_range_m = 60};
  Mesh volume = make_box_mesh({-4, -4, 1}, {4, 4, 9});

  Yard() {
    scene.mesh.vertices = {{-99, -99, 0}, {99, -99, 0}, {99, 99, 0}, {-99, 99, 0}};
    scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.object_of = {0, 0};
    scene.objects = {{"ground", "", ObjectKind::ground}};
  }
};

TEST(NavigationCheck, AllRefuseTheSameLimitsInTheSameWords) {
  const Yard yard;
  const PreparedTarget target(PreparedScene(yard.scene), yard.target, yard.sensor);
  const Volume made = volume_of_mesh(yard.volume, "box");
  const std::vector<std::pair<std::string, std::function<void(const Navigation&)>>> takers = {
      {"cut_to_navigation", [&](const Navigation& n) { cut_to_navigation(made, n); }},
      {"cut_to_limits", [&](const Navigation& n) { cut_to_limits(made, target, n); }},
      {"compute_volume", [&](const Navigation& n) { compute_volume(target, n); }},
      {"PointQuery", [&](const Navigation& n) { PointQuery(target, n); }},
      {"query_points",
       [&](const Navigation& n) {
         query_points(target, n, {{0, 0, 5}});
       }},
      {"ViewsQuery", [&](const Navigation& n) { ViewsQuery({{target}}, n); }},
      {"verify_volume",
       [&](const Navigation& n) { verify_volume(yard.scene, yard.target, yard.sensor, n, yard.volume); }},
      {"verify_volume of views",
       [&](const Navigation& n) { verify_volume(yard.scene, {{yard.target}}, yard.sensor, n, yard.volume); }},
      {"prove_volume",
       [&](const Navigation& n) { prove_volume(yard.scene, yard.target, yard.sensor, n, yard.volume); }},
      {"prove_maximal",
       [&](const Navigation& n) { prove_maximal(yard.scene, yard.target, yard.sensor, n, yard.volume, {}); }},
  };
  for (const WrongLimit& wrong : wrong_limits()) {
    const Error expected = error_of([&] { check_navigation(wrong.navigation); });
    EXPECT_EQ(expected.code(), wrong.code) << wrong.what << ": " << expected.what();
    for (const auto& [name, take] : takers) {
      try {
        take(wrong.navigation);
        ADD_FAILURE() << name << " takes " << wrong.what << ": " << expected.what();
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), expected.what()) << name;
        EXPECT_EQ(error.code(), expected.code()) << name;
      }
    }
  }
}

TEST(NavigationCheck, BoxesAreRefusedInEachAxis) {
  for (const bool is_kept_in : {true, false}) {
    for (int axis = 0; axis < 3; ++axis) {
      Box box{{0, 0, 0}, {9, 9, 9}};
      const auto code = [&](double low, double high) {
        box.min[axis] = low;
        box.max[axis] = high;
        Navigation navigation;
        (is_kept_in ? navigation.keep_in : navigation.keep_out) = {box};
        return code_of([&] { check_navigation(navigation); });
      };
      EXPECT_EQ(code(4, 4), ErrorCode::limits_empty) << axis;
      EXPECT_EQ(code(5, 4), ErrorCode::limits_reversed) << axis;
      EXPECT_EQ(code(kNaN, 4), ErrorCode::value_out_of_range) << axis;
      EXPECT_EQ(code(4, 5), std::nullopt) << axis;
    }
  }
}

// The advice can be copied.
TEST(NavigationCheck, WhatIsReversedIsShownTheRightWayRound) {
  const auto fix_of = [](const std::function<void(Navigation&)>& set) {
    Navigation navigation;
    set(navigation);
    return expect_error([&] { check_navigation(navigation); }, ErrorCode::limits_reversed).fix();
  };
  const auto shows = [](const std::string& fix, const char* pair) { return fix.find(pair) != std::string::npos; };
  EXPECT_TRUE(shows(fix_of([](Navigation& n) { n.altitude = {5, 3}; }), "[3, 5]"));
  EXPECT_TRUE(shows(fix_of([](Navigation& n) {
                      n.above_ground = AboveGround{120.5, 30, {0, nullptr}};
                    }),
                    "[30, 120.5]"));
  EXPECT_TRUE(shows(fix_of([](Navigation& n) { n.keep_in = {Box{{0, 9, 0}, {1, 2, 3}}}; }), "y = 2"));
  EXPECT_TRUE(shows(fix_of([](Navigation& n) {
                      n.keep_out = {zone_of({{0, 0}, {9, 0}, {9, 9}}, 7, 1)};
                    }),
                    "z: [1, 7]"));
}

TEST(NavigationCheck, WhatIsRightIsTaken) {
  Navigation navigation;
  check_navigation(navigation);
  navigation.altitude = {0, 50};
  navigation.keep_out = {zone_of({{0, 0}, {9, 0}, {9, 9}}, -kInfinity, kInfinity)};
  navigation.keep_out[0].above_ground = AboveGround{-kInfinity, 20, {0, nullptr}};
  navigation.meshes = {{make_box_mesh({-9, -9, -9}, {9, 9, 9}), "airspace.ply"}};
  navigation.above_ground =
      AboveGround{1, 5, {kNaN, std::make_shared<const Mesh>(make_box_mesh({0, 0, 0}, {1, 1, 1}))}};
  check_navigation(navigation);
  bool was_asked = false;
  expect_code(
      [&] {
        check_navigation(navigation, [&](std::string_view, double) {
          was_asked = true;
          return false;
        });
      },
      ErrorCode::cancelled);
  EXPECT_TRUE(was_asked);
}

// A mission file says where, and the rest is the same.
TEST(NavigationCheck, MissionFilesAreToldTheSame) {
  const auto told = [](const std::string& navigation) {
    const std::string text = "target: {point: [0, 0, 5]}\nsensor: {max_range: 30}\nnavigation: {" + navigation + "}\n";
    return error_of([&] { read_mission_text(text, "mission.yaml", SceneSource()); });
  };
  const auto checked = [](const std::function<void(Navigation&)>& set) {
    Navigation navigation;
    set(navigation);
    return error_of([&] { check_navigation(navigation); });
  };
  const auto expect_same = [&](const std::string& text, const std::function<void(Navigation&)>& set) {
    const Error memory = checked(set), file = told(text);  // in this order, as their words are noted
    EXPECT_EQ(file.code(), memory.code());
    EXPECT_EQ(file.problem(), memory.problem());
    EXPECT_EQ(file.fix(), memory.fix());
    EXPECT_EQ(file.where().rfind("mission.yaml:3:", 0), 0u) << file.where();
  };
  expect_same("altitude: [5, 3]", [](Navigation& n) { n.altitude = {5, 3}; });
  expect_same("altitude: [5, 5]", [](Navigation& n) { n.altitude = {5, 5}; });
  expect_same("altitude: {agl: [5, 3]}", [](Navigation& n) { n.above_ground = AboveGround{5, 3, {0, nullptr}}; });
  expect_same("keep_in: [{min: [0, 9, 0], max: [1, 2, 3]}]", [](Navigation& n) {
    n.keep_in = {Box{{0, 9, 0}, {1, 2, 3}}};
  });
  expect_same("keep_out: [{min: [0, 0, 0], max: [1, 0, 3]}]", [](Navigation& n) {
    n.keep_out = {Box{{0, 0, 0}, {1, 0, 3}}};
  });
  expect_same("clearance: -2", [](Navigation& n) { n.clearance = {-2, std::make_shared<const Mesh>()}; });
}

}  // namespace
}  // namespace vantage::testing
