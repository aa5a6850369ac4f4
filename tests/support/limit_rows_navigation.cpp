#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "support/limit_rows.h"
#include "support/solids.h"

namespace vantage::testing {
namespace {

Zone draw_zone(Random& random) {
  Zone zone;
  const int count = random.integer(3, 7);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, share = random.uniform(10, 30);
    zone.outer.emplace_back(3 + share * std::cos(angle), share * std::sin(angle) - 4);
  }
  zone.min_z_m = random.uniform(-5, 5);
  zone.max_z_m = random.uniform(12, 30);
  zone.name = "drawn";
  return zone;
}

std::shared_ptr<const Mesh> draw_terrain(Random& random) {
  constexpr std::uint32_t kPosts = 5;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kPosts; ++i) {
    for (std::uint32_t k = 0; k < kPosts; ++k)
      mesh.vertices.emplace_back(25.0 * i - 50, 25.0 * k - 50, random.uniform(-4, 0));
  }
  for (std::uint32_t i = 0; i + 1 < kPosts; ++i) {
    for (std::uint32_t k = 0; k + 1 < kPosts; ++k) {
      const std::uint32_t a = kPosts * i + k, b = a + kPosts;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return std::make_shared<const Mesh>(std::move(mesh));
}

/// Of quarter turns.
Box moved(const Box& box, const Motion& motion) {
  Box result;
  result.extend(motion.of(box.min));
  result.extend(motion.of(box.max));
  return result;
}

AboveGround moved(const AboveGround& limit, const Motion& motion) {
  AboveGround result = limit;
  result.min_m *= motion.scale;
  result.max_m *= motion.scale;
  result.ground.plane_z_m = motion.of_z(limit.ground.plane_z_m);
  if (limit.ground.surface) {
    result.ground.surface = std::make_shared<const Mesh>(moved(*limit.ground.surface, motion));
  }
  return result;
}

Zone moved(const Zone& zone, const Motion& motion) {
  Zone result = zone;
  const auto move = [&](Zone::Ring& ring) {
    for (Eigen::Vector2d& p : ring) p = motion.of({p.x(), p.y(), 0}).head<2>();
  };
  move(result.outer);
  for (Zone::Ring& hole : result.holes) move(hole);
  result.min_z_m = motion.of_z(zone.min_z_m);
  result.max_z_m = motion.of_z(zone.max_z_m);
  if (zone.above_ground) result.above_ground = moved(*zone.above_ground, motion);
  return result;
}

void move_zones(std::vector<Zone>& zones, const Motion& motion) {
  for (Zone& zone : zones) zone = zone.is_box ? Zone(moved(zone.box(), motion)) : moved(zone, motion);
}

void expect_same_zones(const std::vector<Zone>& found, const std::vector<Zone>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].outer, expected[i].outer);
    EXPECT_EQ(found[i].holes, expected[i].holes);
    EXPECT_EQ(found[i].min_z_m, expected[i].min_z_m);
    EXPECT_EQ(found[i].max_z_m, expected[i].max_z_m);
    EXPECT_EQ(found[i].name, expected[i].name);
    EXPECT_EQ(found[i].is_box, expected[i].is_box);
    ASSERT_EQ(found[i].above_ground.has_value(), expected[i].above_ground.has_value());
    if (found[i].above_ground) {
      EXPECT_EQ(found[i].above_ground->min_m, expected[i].above_ground->min_m);
      EXPECT_EQ(found[i].above_ground->max_m, expected[i].above_ground->max_m);
    }
  }
}

}  // namespace

// ---- altitude ----

template <>
LimitSample sample_of<Limit::altitude>() {
  LimitSample sample;
  sample.limit = Limit::altitude;
  sample.add = [](LimitWorld& w) { w.navigation.altitude = {4, 25}; };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 0, 30};
  sample.outside_of = {"altitude max"};
  sample.text = "altitude: [4, 25]";
  sample.is_flat = true;
  sample.is_refuted = true;
  sample.bounds_outer = true;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.altitude = {5, 3}; };
  sample.wrong_code = ErrorCode::limits_reversed;
  sample.wrong_text = "altitude: [5, 3]";
  sample.draws = {
      {"altitude", Turns::about_z, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.altitude = {r.uniform(1, 6), 21.3};
       }},
  };
  return sample;
}

template <>
void move<Limit::altitude>(Navigation::Altitude& limit, const Motion& motion) {
  limit = {motion.of_z(limit.min_m), motion.of_z(limit.max_m)};
}

template <>
void change_soups_of<Limit::altitude>(Navigation::Altitude& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::altitude>(const Navigation::Altitude& found, const Navigation::Altitude& expected) {
  EXPECT_EQ(found.min_m, expected.min_m);
  EXPECT_EQ(found.max_m, expected.max_m);
}

// ---- above_ground ----

template <>
LimitSample sample_of<Limit::above_ground>() {
  LimitSample sample;
  sample.limit = Limit::above_ground;
  sample.add = [](LimitWorld& w) { w.navigation.above_ground = {4, 25, Ground{-2}}; };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 0, 30};
  sample.outside_of = {"agl max"};
  sample.text = "altitude: {agl: [4, 25]}, ground: -2";
  sample.is_flat = true;
  sample.is_refuted = true;
  sample.bounds_outer = true;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.above_ground = AboveGround{5, 3, Ground{-2}}; };
  sample.wrong_code = ErrorCode::limits_reversed;
  sample.wrong_text = "altitude: {agl: [5, 3]}, ground: -2";
  sample.draws = {
      {"above ground", Turns::about_z, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.above_ground = {3, r.uniform(12, 25), Ground{-1.7}};
       }},
      {"above terrain", Turns::about_z, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.above_ground = {3, r.uniform(12, 25), Ground{0, draw_terrain(r)}};
       }},
  };
  return sample;
}

template <>
void move<Limit::above_ground>(AboveGround& limit, const Motion& motion) {
  limit = moved(limit, motion);
}

template <>
void change_soups_of<Limit::above_ground>(AboveGround& limit, const ChangeMesh& change) {
  if (limit.ground.surface) limit.ground.surface = std::make_shared<const Mesh>(change(*limit.ground.surface));
}

template <>
void expect_same<Limit::above_ground>(const AboveGround& found, const AboveGround& expected) {
  EXPECT_EQ(found.min_m, expected.min_m);
  EXPECT_EQ(found.max_m, expected.max_m);
}

// ---- keep_in ----

template <>
LimitSample sample_of<Limit::keep_in>() {
  LimitSample sample;
  sample.limit = Limit::keep_in;
  sample.add = [](LimitWorld& w) {
    w.navigation.keep_in = {Box{{-20, -20, 0}, {20, 20, 40}}};
    w.navigation.keep_in[0].name = "0";
  };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 30, 20};
  sample.outside_of = {"keep_in"};
  sample.text = "keep_in: [{min: [-20, -20, 0], max: [20, 20, 40]}]";
  sample.is_flat = true;
  sample.is_refuted = true;
  sample.bounds_outer = true;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.keep_in = {Box{{0, 9, 0}, {1, 2, 3}}}; };
  sample.wrong_code = ErrorCode::limits_reversed;
  sample.wrong_text = "keep_in: [{min: [0, 9, 0], max: [1, 2, 3]}]";
  sample.draws = {
      {"keep_in", Turns::quarters, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.keep_in = {Box{r.point(-22, -2), r.point(4, 25)}, Box{r.point(-30, -20), r.point(-8, 9)}};
       }},
      {"keep_in zones", Turns::about_z, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.keep_in = {draw_zone(r)};
         w.navigation.keep_in[0].holes = {{{-4, -3}, {6, -2}, {1, 5}}};
       }},
  };
  return sample;
}

template <>
void move<Limit::keep_in>(std::vector<Zone>& limit, const Motion& motion) {
  move_zones(limit, motion);
}

template <>
void change_soups_of<Limit::keep_in>(std::vector<Zone>& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::keep_in>(const std::vector<Zone>& found, const std::vector<Zone>& expected) {
  expect_same_zones(found, expected);
}

// ---- keep_out ----

template <>
LimitSample sample_of<Limit::keep_out>() {
  LimitSample sample;
  sample.limit = Limit::keep_out;
  sample.add = [](LimitWorld& w) {
    w.navigation.keep_out = {Box{{-15, -15, 12}, {15, 15, 40}}};
    w.navigation.keep_out[0].name = "0";
  };
  sample.kept = {0, 0, 10};
  sample.broken = {0, 0, 20};
  sample.outside_of = {"keep_out zone 0"};
  sample.text = "keep_out: [{min: [-15, -15, 12], max: [15, 15, 40]}]";
  sample.is_flat = true;
  sample.is_refuted = true;
  sample.bounds_outer = true;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.keep_out = {Box{{0, 0, 0}, {1, 0, 3}}}; };
  sample.wrong_code = ErrorCode::limits_empty;
  sample.wrong_text = "keep_out: [{min: [0, 0, 0], max: [1, 0, 3]}]";
  sample.draws = {
      {"keep_out", Turns::quarters, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.keep_out = {Box{r.point(-14, 2), r.point(5, 19)}};
       }},
      {"keep_out zones", Turns::about_z, 0, false,  // there is no proof of heights above terrain
       [](LimitWorld& w, Random& r) {
         w.navigation.keep_out = {draw_zone(r)};
         w.navigation.keep_out[0].above_ground = {2, r.uniform(9, 20), Ground{0, draw_terrain(r)}};
       }},
  };
  return sample;
}

template <>
void move<Limit::keep_out>(std::vector<Zone>& limit, const Motion& motion) {
  move_zones(limit, motion);
}

template <>
void change_soups_of<Limit::keep_out>(std::vector<Zone>& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::keep_out>(const std::vector<Zone>& found, const std::vector<Zone>& expected) {
  expect_same_zones(found, expected);
}

// ---- meshes ----

template <>
LimitSample sample_of<Limit::meshes>() {
  LimitSample sample;
  sample.limit = Limit::meshes;
  sample.add = [](LimitWorld& w) {
    w.navigation.meshes = {{make_box_mesh({-20, -20, 0}, {20, 20, 40}), "airspace.obj"}};
  };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 30, 20};
  sample.outside_of = {"mesh airspace.obj"};
  sample.text = "meshes: [airspace.obj]";
  sample.is_flat = true;
  sample.is_refuted = true;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.meshes = {{Mesh(), "airspace.obj"}}; };
  sample.wrong_code = ErrorCode::mesh_empty;
  sample.wrong_text = "";
  sample.draws = {
      {"meshes", Turns::all, 0, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.meshes = {{make_box_mesh(r.point(-25, -3), r.point(5, 30)), "airspace"}};
       }},
  };
  return sample;
}

template <>
void move<Limit::meshes>(std::vector<KeepInMesh>& limit, const Motion& motion) {
  for (KeepInMesh& mesh : limit) mesh.mesh = moved(std::move(mesh.mesh), motion);
}

template <>
void change_soups_of<Limit::meshes>(std::vector<KeepInMesh>& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::meshes>(const std::vector<KeepInMesh>& found, const std::vector<KeepInMesh>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].name, expected[i].name);
}

// ---- clearance ----

template <>
LimitSample sample_of<Limit::clearance>() {
  LimitSample sample;
  sample.limit = Limit::clearance;
  sample.add = [](LimitWorld& w) { w.navigation.clearance = {10, obstacles_of(w.scene)}; };
  sample.kept = {0, 0, 20};
  sample.broken = {25, 0, 6};
  sample.outside_of = {"clearance"};
  sample.text = "clearance: 10";
  sample.is_flat = false;
  sample.is_refuted = true;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) { w.navigation.clearance = {-2, obstacles_of(w.scene)}; };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "clearance: -2";
  sample.draws = {
      {"clearance", Turns::all, 0.16 * 3.1 / kRangeOfDraws, true,
       [](LimitWorld& w, Random& r) {
         w.navigation.clearance = {r.uniform(0.5, 3.1), obstacles_of(w.scene)};
       }},
  };
  return sample;
}

template <>
void move<Limit::clearance>(Clearance& limit, const Motion& motion) {
  limit = {motion.scale * limit.distance_m, std::make_shared<const Mesh>(moved(*limit.obstacles, motion))};
}

template <>
void change_soups_of<Limit::clearance>(Clearance& limit, const ChangeMesh& change) {
  limit.obstacles = std::make_shared<const Mesh>(change(*limit.obstacles));
}

template <>
void expect_same<Limit::clearance>(const Clearance& found, const Clearance& expected) {
  EXPECT_EQ(found.distance_m, expected.distance_m);
}

}  // namespace vantage::testing
