// The clearance from obstacles: the cut, the answers for points and the check, against distances by brute force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/internals.h"
#include "support/obstacles.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"
#include "verify/obstacle_probe.h"

namespace vantage {
namespace {

using testing::Case;
using testing::distance;
using testing::first_open_edge;
using testing::holds;
using testing::kBesideEdges;
using testing::kCases;
using testing::keeping;
using testing::make_hemisphere;
using testing::make_town;
using testing::Random;
using testing::SceneBuilder;

// Preparing a scene drops what is narrower than its largest extent can be rounded by.
TEST(ClearanceLimit, IsKeptFromASpeckBesideAWallOfAnySize) {
  for (const Case& at : kCases) {
    for (const double wall_m : {1.0, 1e2, 1e4, 1e6}) {
      for (const double speck_m : {1e-16, 1e-13, 1e-9, 1e-3}) {
        SCOPED_TRACE(std::to_string(at.scale) + " wall " + std::to_string(wall_m) + " speck " +
                     std::to_string(speck_m));
        const auto place = [&](double x, double y, double z) { return Vec3(at.origin + at.scale * Vec3(x, y, z)); };
        const auto obstacles = std::make_shared<Mesh>();
        obstacles->vertices = {place(3, 3, 6),        place(3 + speck_m, 3, 6), place(3, 3 + speck_m, 6),
                               place(30, -wall_m, 0), place(30, wall_m, 0),     place(30, 0, wall_m)};
        obstacles->triangles = {{0, 1, 2}, {3, 4, 5}};
        Navigation navigation;
        navigation.clearance = {2 * at.scale, obstacles};
        const Volume cut = cut_to_navigation(make_hemisphere(at.origin, 35 * at.scale, 32, 8), navigation);
        ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
        EXPECT_FALSE(holds(cut.mesh, place(3, 3, 4.01)));
        EXPECT_FALSE(holds(cut.mesh, place(3, 3, 6.001)));
        EXPECT_TRUE(holds(cut.mesh, place(3, 3, 2)));
      }
    }
  }
}

// Booleans round to a part of the largest coordinate: with the whole of such a triangle in them sight was claimed from
// 4e-7 m beside a shadow.
TEST(ClearanceLimit, OfATriangleFarLargerThanTheVolumeCostsNoPrecision) {
  Random random(5);
  for (int round = 0; round < 24; ++round) {
    const double range = std::array{0.1, 10.0, 100.0}[static_cast<std::size_t>(round % 3)];
    const double far = range * std::pow(10, random.uniform(5, 6.5));
    SceneBuilder builder;
    builder.polygon("ground", {{-far, -far, -0.3 * range}, {far, -far, -0.3 * range}, {0, far, -0.3 * range}});
    for (int i = 0; i < 4; ++i) {
      const Vec3 at = range * Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(0.3, 0.5));
      builder.polygon("roof", {at, at + range * Vec3(0.1, 0, 0), at + range * Vec3(0, 0.1, 0.02)});
    }
    const Scene scene = builder;
    const Target target = Target::point({0, 0, 0.02 * range});
    const Sensor sensor{.max_range_m = range};
    Navigation navigation;
    navigation.clearance = Clearance{.distance_m = 0.005 * range, .obstacles = obstacles_of(scene)};
    const Volume volume =
        compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), navigation, {.tolerance_m = 0.01 * range});
    const ProofReport report = prove_volume(scene, target, sensor, navigation, volume.mesh, {.lift_m = volume.lift_m});
    for (const ClaimProof& claim : report.claims) {
      EXPECT_NE(claim.verdict, ProofVerdict::wrong) << "round " << round << ": " << claim.text;
    }
  }
}

// A triangle of 556 km that is 10 micrometres wide: its normal, of rounded differences, was off by so much that a point
// 2.02 m away, nearly over it, was said to be nearer than 2 m.
TEST(ClearanceLimit, OfALongSliverIsNotTakenForLess) {
  const auto obstacles = std::make_shared<Mesh>();
  obstacles->vertices = {{-217783.2636958597, 55083.14226547446, -163677.38823644427},
                         {217756.87473871495, -55079.55276912332, 163713.70223210863},
                         {-13.194476467964437, 1.7947581192826134, 18.156998378535143}};
  obstacles->triangles = {{0, 1, 2}};
  Navigation navigation;
  navigation.clearance = Clearance{2, obstacles};
  const Vec3 point(-23.160455658615472, 4.453905735856816, 8.146349940796853);  // 2.0205165 m, by exact numbers
  const Scene scene = SceneBuilder().ground("ground", 100, -1);
  const PreparedTarget target(PreparedScene(scene), Target::point({0, 0, 0}), Sensor{.max_range_m = 40});
  EXPECT_TRUE(query_points(target, navigation, {point})[0].outside_of.empty());
  EXPECT_FALSE(verify::ObstacleProbe(*navigation.clearance).is_too_near(point, 0));
  EXPECT_TRUE(verify::ObstacleProbe(*navigation.clearance).is_too_near(point, 0.0103));
  navigation.clearance->distance_m = 2.0206;
  EXPECT_EQ(query_points(target, navigation, {point})[0].outside_of, std::vector<std::string>{"clearance"});
}

TEST(ClearanceLimit, ObstaclesAreAllOfASceneWithoutObjects) {
  Scene scene;
  scene.mesh = testing::make_box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), 12u);
  scene.object_of.assign(11, 0);
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::array_sizes_differ);
  scene.object_of.assign(12, 0);
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), 12u);
  scene.object_of[5] = 1;
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::index_out_of_range);
  EXPECT_EQ(testing::code_of([&] { ground_of(scene); }), ErrorCode::index_out_of_range);
  scene.object_of[5] = 0;
  scene.mesh.triangles[3][1] = 8;
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::index_out_of_range);
  const auto surface = std::make_shared<Mesh>(scene.mesh);
  EXPECT_EQ(testing::code_of([&] { GroundLevels({0, surface}); }), ErrorCode::index_out_of_range);
}

// Blocks that stand askew, far from the origin: their hulls are made of coordinates that are rounded there.
TEST(ClearanceLimit, IsKeptFromTurnedBlocksAtMapCoordinates) {
  Random random(2243);
  const Vec3 origin(-3e6, 4.7e6, 0);
  constexpr double kAsked = 2.01;
  for (int round = 0; round < 5; ++round) {
    SCOPED_TRACE(round);
    Mesh blocks;
    for (int block = 0; block < 6; ++block) {
      const Vec3 half(random.uniform(1, 6), random.uniform(1, 6), random.uniform(2, 14));
      const Vec3 at = 25 * Vec3(std::cos(block), std::sin(block), 0) + random.point(-3, 3);
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 1.5), Vec3::UnitZ()).toRotationMatrix();
      Mesh box = testing::make_box_mesh(-half, half);
      for (Vec3& vertex : box.vertices) vertex = origin + at + turn * vertex;
      testing::append(blocks, box);
    }
    Navigation navigation;
    navigation.clearance = {kAsked, std::make_shared<const Mesh>(blocks)};
    const Volume cut = cut_to_navigation(make_hemisphere(origin, 60), navigation);
    ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
    EXPECT_EQ(first_open_edge(cut.mesh), "");
    constexpr double kRounding = 1e-7;
    for (const auto& [a, b, c] : cut.mesh.triangles) {
      const Vec3 &p = cut.mesh.vertices[a], &q = cut.mesh.vertices[b], &r = cut.mesh.vertices[c];
      for (const Vec3& on : {p, Vec3((p + q) / 2), Vec3((p + q + r) / 3)}) {
        ASSERT_GT(distance(on, blocks), kAsked - kRounding) << (on - origin).transpose();
      }
    }
  }
}

TEST(ClearanceLimit, IsExactOverAFlatWallAndBoundedBesideItsEdge) {
  Scene scene;
  scene.objects = {{"wall", "", ObjectKind::wall}};
  scene.mesh = {{{10, -200, -200}, {10, 200, -200}, {10, 200, 20}, {10, -200, 20}}, {{0, 1, 2}, {0, 2, 3}}};
  scene.object_of = {0, 0};
  Navigation navigation = keeping(scene, 5);
  navigation.altitude = {0, 15};
  const Volume cut = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), navigation);
  Box before;
  for (const Vec3& v : cut.mesh.vertices) {
    if (v.x() < 10) before.extend(v);
  }
  EXPECT_NEAR(before.max.x(), 5, 1e-9);
  double nearest_above = INFINITY;
  const Volume over = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), keeping(scene, 5));
  for (const Vec3& v : over.mesh.vertices) nearest_above = std::min(nearest_above, distance(v, scene.mesh));
  double highest = 0;
  for (const Vec3& v : over.mesh.vertices) {
    if (std::abs(v.x() - 10) < 4 && v.z() < 26) highest = std::max(highest, distance(v, scene.mesh));
  }
  EXPECT_GT(nearest_above, 5 - 1e-9);
  EXPECT_LT(highest, 5 * (1 + kBesideEdges));
  EXPECT_GT(highest, 5);
  bool is_told = false;
  for (const Cause& cause : over.causes) is_told = is_told || (cause.name == "clearance" && cause.area_m2 > 100);
  EXPECT_TRUE(is_told);
}

TEST(ClearanceLimit, PointsAreAnsweredByTheirDistance) {
  Random random(47);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000.1, 4785000.2, 1000.3)}) {
    const Scene town = make_town(random, 1, origin);
    const PreparedScene scene(town);
    const Target at = Target::polygon({origin + Vec3(-1, -1, 31), origin + Vec3(1, -1, 31), origin + Vec3(0, 1, 31)});
    Target down = at;
    down.front = Vec3(0, 0, -1);
    const PreparedTarget target(scene, down, Sensor{.max_range_m = 60});
    const Navigation navigation = keeping(town, 4);
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) points.push_back(origin + random.in_box({Vec3(-40, -40, 0), Vec3(40, 40, 30)}));
    PointQuery query(target, navigation);
    const std::vector<PointAnswer> answers = query.answer(points);
    int inside = 0, too_near = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double far = distance(points[i], *navigation.clearance->obstacles);
      const std::vector<std::string>& names = answers[i].outside_of;
      const bool is_near = std::find(names.begin(), names.end(), "clearance") != names.end();
      if (std::abs(far - 4) > 1e-6) {
        EXPECT_EQ(is_near, far < 4) << far;
      }
      inside += answers[i].inside;
      too_near += is_near;
      const Vec3 line = target.frame(0).origin - points[i], to_centre = line.normalized();
      const double margin = answers[i].margin_m;
      if (!answers[i].inside || !(margin > 0.01) || margin > 0.9 * line.norm()) continue;
      const std::vector<PointAnswer> near = query.answer(
          std::vector<Vec3>{points[i] + (1 - 1e-6) * margin * to_centre, points[i] - (1 - 1e-6) * margin * to_centre,
                            points[i] + (1 + 1e-6) * margin * to_centre, points[i] - (1 + 1e-6) * margin * to_centre});
      EXPECT_TRUE(near[0].inside && near[1].inside);
      EXPECT_FALSE(near[2].inside && near[3].inside);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(too_near, 100);
  }
}

TEST(ClearanceLimit, VerifyFindsWhatIsTooNear) {
  Random random(53);
  const Scene town = make_town(random, 1, Vec3::Zero());
  Target at = Target::polygon({Vec3(-1, -1, 31), Vec3(1, -1, 31), Vec3(0, 1, 31)});
  at.front = Vec3(0, 0, -1);
  const PreparedTarget target(PreparedScene(town), at, Sensor{.max_range_m = 60});
  const auto judged = [&](const Navigation& cut_to) {
    const Volume volume = compute_volume(target, cut_to);
    VerifyOptions options;
    options.points = 6000;
    options.lift_m = volume.lift_m;
    return verify_volume(town, at, Sensor{.max_range_m = 60}, keeping(town, 4), volume.mesh, options);
  };
  const VerifyReport right = judged(keeping(town, 4));
  EXPECT_EQ(right.over_claimed, 0u) << right.worst_over_cause;
  EXPECT_EQ(right.under_claimed, 0u);
  EXPECT_GT(right.inside, 500u);
  EXPECT_GT(judged({}).over_claimed, 100u);
  const VerifyReport loose = judged(keeping(town, 3.9));
  EXPECT_GT(loose.over_claimed, 0u);
  EXPECT_EQ(loose.worst_over_cause, "clearance");
  EXPECT_GT(judged(keeping(town, 5)).under_claimed, 0u);
}

TEST(ClearanceLimit, LeavesNothingOfWhatItCovers) {
  Random random(3);
  const Scene town = make_town(random, 1, Vec3::Zero());
  const Volume none = cut_to_navigation(make_hemisphere(Vec3::Zero(), 20), keeping(town, 100));
  EXPECT_EQ(none.outcome, Outcome::outside_limits);
  testing::expect_wording(none.reason + "\n" + none.hint);
}

TEST(ClearanceLimit, WrongOnesAreRefused) {
  Random random(3);
  const Scene town = make_town(random, 1, Vec3::Zero());
  const Volume dome = make_hemisphere(Vec3::Zero(), 20);
  for (const double distance : {0.0, -1.0, 2e9, static_cast<double>(INFINITY), static_cast<double>(NAN)}) {
    testing::expect_error([&] { cut_to_navigation(dome, keeping(town, distance)); }, ErrorCode::value_out_of_range,
                          "navigation.clearance");
  }
  Navigation navigation;
  navigation.clearance = {4, nullptr};
  testing::expect_error([&] { cut_to_navigation(dome, navigation); }, ErrorCode::nothing_given, "navigation.clearance");
}

/// Without a word on what is ground.
constexpr const char* kBlocks =
    "v -50 -50 0\nv 50 -50 0\nv 50 50 0\no field\nf 1 2 3\n"
    "v 5 5 0\nv 9 5 0\nv 9 5 8\no block\nf 4 5 6\n";

class ClearanceMission : public ::testing::Test {
 protected:
  ClearanceMission() { testing::write_bytes(folder_ / "blocks.obj", kBlocks); }

  MissionFile read(const std::string& navigation) const {
    const std::string text =
        "scene: {mesh: blocks.obj}\ntarget: {vertices: [[0, 0, 6], [2, 0, 6], [0, 2, 6]]}\nsensor: {max_range: 40}\n"
        "navigation: " +
        navigation + "\n";
    return read_mission_text(text, folder_ / "mission.yaml");
  }
  Mission resolve(const std::string& navigation) const { return resolve_mission(read(navigation)); }

  testing::TemporaryDirectory folder_;
};

TEST_F(ClearanceMission, IsFromAllOrFromAllButTheNamedGround) {
  const Mission all = resolve("{clearance: 3}");
  EXPECT_EQ(all.navigation.clearance->distance_m, 3);
  EXPECT_EQ(all.navigation.clearance->obstacles->triangles.size(), 2u);
  ASSERT_EQ(all.notes.size(), 1u);
  EXPECT_EQ(all.notes[0].code, WarningCode::clearance_from_all);
  const Mission named = resolve("{clearance: 3, ground: field}");
  EXPECT_EQ(named.navigation.clearance->obstacles->triangles.size(), 1u);
  EXPECT_TRUE(named.notes.empty());
  testing::expect_error([&] { resolve("{clearance: 3, ground: feild}"); }, ErrorCode::object_missing,
                        "mission.yaml:4:");
}

TEST_F(ClearanceMission, WrongKeysAreRefused) {
  const auto refuse = [&](const std::string& navigation, ErrorCode code) {
    testing::expect_error([&] { read(navigation); }, code, "mission.yaml:4:");
  };
  refuse("{clearance: 0}", ErrorCode::value_out_of_range);
  refuse("{clearance: -2}", ErrorCode::value_out_of_range);
  refuse("{clearance: near}", ErrorCode::not_a_number);
  refuse("{clearence: 3}", ErrorCode::unknown_key);
  refuse("{clearance: 3, ground: 0}", ErrorCode::not_applicable);
}

TEST_F(ClearanceMission, TextAndHashHoldAllOfIt) {
  std::set<std::string> hashes, texts;
  for (const char* navigation :
       {"{clearance: 3}", "{clearance: 4}", "{clearance: 3, ground: field}", "{altitude: [1, 2]}"}) {
    const MissionFile mission = read(navigation);
    const std::string text = mission_text(mission, mission.file.parent_path());
    const MissionFile again = read_mission_text(text, mission.file);
    EXPECT_EQ(mission_text(again, mission.file.parent_path()), text);
    EXPECT_EQ(mission_hash(resolve_mission(again)), mission_hash(resolve_mission(mission)));
    hashes.insert(mission_hash(resolve_mission(mission)));
    texts.insert(text);
  }
  EXPECT_EQ(hashes.size(), 4u);
  EXPECT_EQ(texts.size(), 4u);
}

TEST(ClearanceMap, AVolumeAmongHousesKeepsItsDistance) {
  VANTAGE_REQUIRE_SHARED("osm/monaco.osm.pbf");
  const std::string text = "scene: {osm: '" + testing::shared_data("osm/monaco.osm.pbf").string() +
                           "', center: [43.7384, 7.4246], radius: 300}\n"
                           "target: {center: [43.7386, 7.4250], width: 6, length: 6, offset: 30}\n"
                           "sensor: {max_range: 150}\nnavigation: {clearance: 10}\n";
  const Mission mission = resolve_mission(read_mission_text(text, "mission.yaml"));
  EXPECT_TRUE(mission.notes.empty() || mission.notes[0].code != WarningCode::clearance_from_all);
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  const Mesh& obstacles = *mission.navigation.clearance->obstacles;
  double nearest = INFINITY;
  for (std::size_t i = 0; i < result.volume.mesh.vertices.size(); i += 50) {
    nearest = std::min(nearest, distance(result.volume.mesh.vertices[i], obstacles));
  }
  EXPECT_GT(nearest, 10 - 1e-6);
  VerifyOptions options;
  options.points = 2000;
  options.lift_m = result.volume.lift_m;
  const VerifyReport report =
      verify_volume(mission.scene(), mission.target, mission.sensor, mission.navigation, result.volume.mesh, options);
  EXPECT_TRUE(report.is_right()) << report.worst_over_cause;
  EXPECT_EQ(report.under_claimed, 0u);
}

/// Upright walls over an L, with its floor and ceiling.
Mesh make_l_room(double in, double low, double high) {
  const std::vector<Vec3> corners = {{2 - in, 2 - in, 0}, {2 - in, 10 - in, 0}, {in, 10 - in, 0},
                                     {in, in, 0},         {10 - in, in, 0},     {10 - in, 2 - in, 0}};
  Mesh mesh;
  for (const double z : {low, high}) {
    for (const Vec3& corner : corners) mesh.vertices.push_back(corner + z * Vec3::UnitZ());
  }
  for (std::uint32_t k = 1; k < 5; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({6, 6 + k, 7 + k});
  }
  for (std::uint32_t a = 0; a < 6; ++a) {
    const std::uint32_t b = (a + 1) % 6;
    mesh.triangles.push_back({a, b, b + 6});
    mesh.triangles.push_back({a, b + 6, a + 6});
  }
  return mesh;
}

/// The middle of its box lies outside of the room.
TEST(ClearanceLimit, LeavesTheRoomThatAMeshIsIn) {
  const auto room = std::make_shared<const Mesh>(make_l_room(0, 0, 3));
  Navigation navigation;
  navigation.clearance = Clearance{0.3, room};
  const Volume cut = cut_to_navigation(volume_of_mesh(make_l_room(0.1, 0.1, 2.9), "a room"), navigation);
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(testing::first_open_edge(cut.mesh), "");
  const double area = 1.4 * 9.4 + 1.4 * 8;  // 0.3 m from all walls
  EXPECT_GT(enclosed_volume(cut.mesh), 0.999 * 2.4 * area);
  EXPECT_LT(enclosed_volume(cut.mesh), 2.4 * (area + 0.3 * 0.3));  // round the corner
}

}  // namespace
}  // namespace vantage
