// A mission that is moved to map coordinates, turned, scaled, or whose triangles are split and shuffled asks for the
// same volume: for every limit of the sensor and of navigation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::MeshProbe;
using testing::Random;
using testing::SceneBuilder;

constexpr double kRangeOfMoved = 40, kToleranceOfMoved = 0.1;  // metres, before scaling

struct World {
  Scene scene;
  Target target;
  Sensor sensor;
  Navigation navigation;
};

/// Turns, scales, then shifts.
struct Motion {
  const char* name;
  double scale = 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();

  Vec3 of(const Vec3& point) const { return scale * (turn * point) + shift; }
  double of_z(double z) const { return scale * z + shift.z(); }
};

Mesh moved(Mesh mesh, const Motion& motion) {
  for (Vec3& vertex : mesh.vertices) vertex = motion.of(vertex);
  return mesh;
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

// All members are named: a limit that is added does not compile here before it is moved, and drawn below.
Navigation moved(const Navigation& navigation, const Motion& motion) {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  Navigation result;
  if (altitude) result.altitude = {motion.of_z(altitude->min_m), motion.of_z(altitude->max_m)};
  const auto any_moved = [&](const Zone& zone) {
    return zone.is_box ? Zone(moved(zone.box(), motion)) : moved(zone, motion);
  };
  for (const Zone& zone : keep_in) result.keep_in.push_back(any_moved(zone));
  for (const Zone& zone : keep_out) result.keep_out.push_back(any_moved(zone));
  for (const KeepInMesh& mesh : meshes) result.meshes.push_back({moved(mesh.mesh, motion), mesh.name});
  if (above_ground) result.above_ground = moved(*above_ground, motion);
  if (clearance) {
    result.clearance = {motion.scale * clearance->distance_m,
                        std::make_shared<const Mesh>(moved(*clearance->obstacles, motion))};
  }
  return result;
}

Sensor moved(const Sensor& sensor, const Motion& motion) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor;
  Sensor result;
  result.max_range_m = motion.scale * max_range_m;
  result.min_range_m = motion.scale * min_range_m;
  result.incidence_deg = incidence_deg;
  result.camera = camera;
  result.mount = mount;
  if (mount.yaw_deg) {  // clockwise from north
    const double turned = std::atan2(motion.turn(1, 0), motion.turn(0, 0)) * 180 / std::numbers::pi;
    result.mount.yaw_deg = std::remainder(*mount.yaw_deg - turned, 360.0);
  }
  if (pixel) result.pixel = {motion.scale * pixel->size_m, pixel->kind};
  if (sun) result.sun = {motion.turn * sun->direction, sun->exclude_deg};
  if (link) result.link = {link->frequency_ghz / motion.scale, link->clear};
  result.visible = visible;
  return result;
}

World moved(const World& world, const Motion& motion) {
  World result = world;
  result.scene.mesh = moved(world.scene.mesh, motion);
  for (std::vector<Vec3>& part : result.target.parts) {
    for (Vec3& corner : part) corner = motion.of(corner);
  }
  if (world.target.front) result.target.front = motion.turn * *world.target.front;
  result.sensor = moved(world.sensor, motion);
  result.navigation = moved(world.navigation, motion);
  return result;
}

/// Each triangle in two along its first side, in any order, with corners of its own, any of them first.
Mesh split_and_shuffled(const Mesh& mesh, Random& random, std::vector<std::uint32_t>& object_of) {
  std::vector<std::pair<std::array<Vec3, 3>, std::uint32_t>> parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k], middle = (a + b) / 2;
    const std::uint32_t object = object_of.empty() ? 0 : object_of[t];
    parts.push_back({{a, middle, c}, object});
    parts.push_back({{middle, b, c}, object});
  }
  for (std::size_t i = parts.size(); i > 1; --i) {
    std::swap(parts[i - 1], parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  }
  Mesh result;
  object_of.clear();
  for (auto& [corners, object] : parts) {
    std::rotate(corners.begin(), corners.begin() + random.integer(0, 2), corners.end());
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.insert(result.vertices.end(), corners.begin(), corners.end());
    result.triangles.push_back({first, first + 1, first + 2});
    object_of.push_back(object);
  }
  return result;
}

World split_and_shuffled(const World& world, Random& random) {
  World result = world;
  result.scene.mesh = split_and_shuffled(world.scene.mesh, random, result.scene.object_of);
  std::vector<std::uint32_t> unused;
  if (const auto& clearance = world.navigation.clearance) {
    result.navigation.clearance->obstacles =
        std::make_shared<const Mesh>(split_and_shuffled(*clearance->obstacles, random, unused));
  }
  if (world.navigation.above_ground && world.navigation.above_ground->ground.surface) {
    result.navigation.above_ground->ground.surface = std::make_shared<const Mesh>(
        split_and_shuffled(*world.navigation.above_ground->ground.surface, random, unused));
  }
  return result;
}

/// Blocks of odd sizes about the target, and a sheet over some of it.
Scene draw_scene(Random& random) {
  SceneBuilder builder;
  for (int i = 0; i < 4; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), away = random.uniform(9, 24);
    const Vec3 low(away * std::cos(angle), away * std::sin(angle), random.uniform(-2, 3));
    builder.box("block", low, low + random.point(2, 14));
  }
  const Vec3 at = random.point(-12, 12).cwiseProduct(Vec3(1, 1, 0)) + Vec3(0, 0, 16);
  builder.polygon("sheet", {at, at + random.point(-5, 5), at + random.point(-5, 5)});
  return builder;
}

Pinhole camera(double half_width, double half_height) {
  return {half_width, half_height, 4000, 3000, 2000 / half_width};
}

/// What turns a limit allows.
enum class Turns { all, about_z, quarters };

struct Limit {
  const char* name;
  Turns turns;
  /// So much, of the range, may the surfaces of two volumes be apart: that facets of the limit stand off from it.
  double apart;
  bool has_proof;
  std::function<void(World&, Random&)> add;
};

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

const std::vector<Limit>& limits() {
  static const std::vector<Limit> kLimits = {
      {"max_range", Turns::all, 0, true, [](World&, Random&) {}},
      {"min_range", Turns::all, 2e-3, true, [](World& w, Random& r) { w.sensor.min_range_m = r.uniform(6, 20); }},
      {"incidence", Turns::all, 2e-3, true, [](World& w, Random& r) { w.sensor.incidence_deg = r.uniform(30, 80); }},
      // Of a camera that turns, the proof of the frame often stays open, after minutes.
      {"frame", Turns::about_z, 2e-2, false,
       [](World& w, Random& r) {
         w.sensor.camera = camera(r.uniform(0.15, 0.4), r.uniform(0.12, 0.3));
         if (r.chance(0.7)) w.sensor.mount = {{}, -90, r.uniform(-60, 0), r.uniform(-60, 60)};
       }},
      {"fixed frame", Turns::about_z, 2e-3, true,
       [](World& w, Random& r) {
         w.sensor.camera = camera(0.7, 0.6);
         w.sensor.mount = {r.uniform(0, 360), -60, -60, r.uniform(-20, 20)};
       }},
      {"pixel, worst", Turns::all, 2e-2, false,
       [](World& w, Random& r) {
         w.sensor.camera = camera(0.5, 0.4);
         w.sensor.pixel = {r.uniform(20, 45) / 4000, PixelLimit::Kind::worst};
       }},
      {"pixel, perpendicular", Turns::all, 2e-2, false,
       [](World& w, Random& r) {
         w.sensor.camera = camera(0.5, 0.4);
         w.sensor.pixel = {r.uniform(20, 35) / 4000, PixelLimit::Kind::perpendicular};
       }},
      {"sun", Turns::all, 2e-3, true,
       [](World& w, Random& r) {
         w.sensor.sun = SunLimit{r.direction() + Vec3(0, 0, 1), r.uniform(10, 50)};
       }},
      {"link", Turns::all, 2e-2, false,
       [](World& w, Random& r) {
         w.target.parts = {{Vec3(0, 0, 0.7)}};
         w.target.front.reset();
         w.sensor.link = {r.uniform(1, 30), r.uniform(0.3, 1)};
       }},
      {"visible", Turns::all, 1e-2, false,
       [](World& w, Random&) {
         w.sensor.visible = VisibleShare{0.6, 4};
       }},
      {"altitude", Turns::about_z, 0, true,
       [](World& w, Random& r) {
         w.navigation.altitude = {r.uniform(1, 6), 21.3};
       }},
      {"above ground", Turns::about_z, 0, true,
       [](World& w, Random& r) {
         w.navigation.above_ground = {3, r.uniform(12, 25), Ground{-1.7}};
       }},
      {"above terrain", Turns::about_z, 0, true,
       [](World& w, Random& r) {
         w.navigation.above_ground = {3, r.uniform(12, 25), Ground{0, draw_terrain(r)}};
       }},
      {"keep_in", Turns::quarters, 0, true,
       [](World& w, Random& r) {
         w.navigation.keep_in = {Box{r.point(-22, -2), r.point(4, 25)}, Box{r.point(-30, -20), r.point(-8, 9)}};
       }},
      {"keep_in zones", Turns::about_z, 0, true,
       [](World& w, Random& r) {
         w.navigation.keep_in = {draw_zone(r)};
         w.navigation.keep_in[0].holes = {{{-4, -3}, {6, -2}, {1, 5}}};
       }},
      {"keep_out", Turns::quarters, 0, true,
       [](World& w, Random& r) {
         w.navigation.keep_out = {Box{r.point(-14, 2), r.point(5, 19)}};
       }},
      {"keep_out zones", Turns::about_z, 0, false,  // there is no proof of heights above terrain
       [](World& w, Random& r) {
         w.navigation.keep_out = {draw_zone(r)};
         w.navigation.keep_out[0].above_ground = {2, r.uniform(9, 20), Ground{0, draw_terrain(r)}};
       }},
      {"meshes", Turns::all, 0, true,
       [](World& w, Random& r) {
         w.navigation.meshes = {{testing::make_box_mesh(r.point(-25, -3), r.point(5, 30)), "airspace"}};
       }},
      {"clearance", Turns::all, 0.16 * 3.1 / kRangeOfMoved, true,
       [](World& w, Random& r) {
         w.navigation.clearance = {r.uniform(0.5, 3.1), obstacles_of(w.scene)};
       }},
  };
  return kLimits;
}

Eigen::Matrix3d draw_turn(Turns turns, Random& random) {
  if (turns == Turns::quarters) {
    Eigen::Matrix3d quarter;
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return random.chance(0.5) ? quarter : Eigen::Matrix3d(quarter * quarter);
  }
  const Vec3 axis = turns == Turns::all ? random.direction() : Vec3::UnitZ();
  return Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), axis).toRotationMatrix();
}

class MovedLimits : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Limit& limit() const { return limits()[GetParam()]; }

  World draw(Random& random) const {
    World world;
    world.scene = draw_scene(random);
    const int corners = random.integer(3, 6);
    const double radius = random.uniform(1, 3);
    world.target = testing::random_target(random, corners, radius, Vec3::Zero(), Vec3(0, 0, 1));
    world.target.front = Vec3(0, 0, 1);
    world.sensor.max_range_m = kRangeOfMoved;
    limit().add(world, random);
    return world;
  }

  /// Whether a draw has an obstacle in the target.
  static bool is_pierced(const World& world) {
    try {
      PreparedTarget(PreparedScene(world.scene), world.target, world.sensor);
      return false;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::target_pierced) throw;
      return true;
    }
  }

  Volume compute(const World& world, double scale) const {
    const PreparedTarget target(PreparedScene(world.scene), world.target, world.sensor);
    return compute_volume(target, world.navigation, {.tolerance_m = scale * kToleranceOfMoved});
  }

  /// No point inside, deeper than is stated, is outside for PointQuery, and the proof agrees.
  void expect_right(const World& world, const Volume& volume, Random& random) const;
  /// The two are within the stated bound of each other, and of the same size.
  void expect_same(const Volume& base, const Volume& other, const Motion& motion, Random& random) const;
};

void MovedLimits::expect_right(const World& world, const Volume& volume, Random& random) const {
  EXPECT_EQ(first_open_edge(volume.mesh), "");
  const MeshProbe probe(volume);
  const Vec3 centre = make_target_frame(world.target).origin;
  const double largest = std::max(probe.bounds().min.cwiseAbs().maxCoeff(), probe.bounds().max.cwiseAbs().maxCoeff());
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * largest;
  std::vector<Vec3> points;
  for (int i = 0; i < 400 && points.size() < 120; ++i) {
    const auto t = static_cast<std::size_t>(random.integer(0, static_cast<int>(volume.mesh.triangles.size()) - 1));
    const auto& [a, b, c] = volume.mesh.triangles[t];
    const auto& v = volume.mesh.vertices;
    const double u = random.uniform(0, 1);
    const Vec3 on = v[a] + u * (v[b] - v[a]) + random.uniform(0, 1 - u) * (v[c] - v[a]);
    const Vec3 normal = (v[b] - v[a]).cross(v[c] - v[a]);
    if (!(normal.norm() > 0)) continue;
    const double depth = 1e-6 * (on - centre).norm() + rounding;
    const Vec3 inside = on - 2 * depth * normal.normalized();
    if (probe.holds(inside) && probe.depth(inside) > depth) points.push_back(inside);
  }
  EXPECT_GT(points.size(), 20u);
  const PreparedTarget target(PreparedScene(world.scene), world.target, world.sensor);
  const std::vector<PointAnswer> answers = query_points(target, world.navigation, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(answers[i].inside) << points[i].transpose() << ", " << probe.depth(points[i]) << " m inside: "
                                   << (answers[i].outside_of.empty() ? "sight" : answers[i].outside_of[0]);
  }
  if (!limit().has_proof) return;
  const ProofReport report =
      prove_volume(world.scene, world.target, world.sensor, world.navigation, volume.mesh, {.lift_m = volume.lift_m});
  for (const ClaimProof& claim : report.claims) {
    EXPECT_EQ(claim.verdict, ProofVerdict::proved) << claim.name << ": " << claim.text;
  }
}

void MovedLimits::expect_same(const Volume& base, const Volume& other, const Motion& motion, Random& random) const {
  const double apart = 2 * kToleranceOfMoved + limit().apart * kRangeOfMoved;
  const double size = enclosed_volume(base.mesh);
  const double found = enclosed_volume(other.mesh) / (motion.scale * motion.scale * motion.scale);
  EXPECT_NEAR(size, found, apart * surface_area(base.mesh)) << "cubic metres";
  const MeshProbe one(base), two(other);
  for (int i = 0; i < 150; ++i) {
    const Vec3 p = random.in_box(one.bounds());
    const double depth = one.depth(p), depth_there = two.depth(motion.of(p)) / motion.scale;
    if (std::abs(depth) > apart || std::abs(depth_there) > apart) {
      EXPECT_GT(depth * depth_there, 0) << p.transpose();
    }
  }
}

TEST_P(MovedLimits, AskForTheSameVolume) {
  SCOPED_TRACE(limit().name);
  Random random(1009 + GetParam());
  int computed = 0;
  for (int draw_number = 0; draw_number < 3; ++draw_number) {
    const World world = draw(random);
    if (is_pierced(world)) continue;
    const Volume base = compute(world, 1);
    if (base.outcome != Outcome::computed) continue;
    ++computed;
    expect_right(world, base, random);
    const World split = split_and_shuffled(world, random);
    const Volume of_split = compute(split, 1);
    ASSERT_EQ(of_split.outcome, Outcome::computed) << of_split.reason;
    expect_right(split, of_split, random);
    expect_same(base, of_split, {"split"}, random);
    const Eigen::Matrix3d turn = draw_turn(limit().turns, random);
    const Vec3 map(-3e6, 4.7e6, 0), other_map(5.8e5 + 0.1, 4.785e6 + 0.2, 1000.3);
    const std::vector<Motion> motions = {
        {"map", 1, Eigen::Matrix3d::Identity(), map},
        {"turned, map", 1, turn, other_map},
        {"turned", 1, turn, Vec3::Zero()},
        {"small", 1e-3, turn, Vec3::Zero()},
        {"small, map", 0.1, turn, map},  // smaller: see what volume.h says of roundings
        {"large", 1e2, Eigen::Matrix3d::Identity(), other_map},
        {"huge", 1e4, turn, Vec3::Zero()}};
    for (const Motion& motion : motions) {
      SCOPED_TRACE(motion.name);
      const World there = moved(world, motion);
      if (there.sensor.link && there.sensor.link->frequency_ghz > 3000) continue;  // none is higher
      const Volume volume = compute(there, motion.scale);
      ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
      expect_right(there, volume, random);
      expect_same(base, volume, motion, random);
    }
  }
  EXPECT_GT(computed, 0);
}

INSTANTIATE_TEST_SUITE_P(All, MovedLimits, ::testing::Range(std::size_t{0}, limits().size()));

}  // namespace
}  // namespace vantage
