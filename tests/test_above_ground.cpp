// Limits by the height above the ground: the cut, the answers for points and the check, against heights by brute force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/grounds.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/ground.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::above;
using testing::first_open_edge;
using testing::GroundCase;
using testing::Heights;
using testing::heights_at;
using testing::holds;
using testing::kGroundCases;
using testing::make_hemisphere;
using testing::make_hills;
using testing::Random;
using testing::slack;
using testing::walls_inside;

TEST(AboveGround, TheCutIsWhatTheHeightsSay) {
  Random random(31);
  for (const GroundCase& at : kGroundCases) {
    SCOPED_TRACE(at.scale);
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    const Navigation navigation =
        above(make_hills(random, 50 * at.scale, 6 * at.scale, 12, at.origin), 4 * at.scale, 25 * at.scale);
    const Volume cut = cut_to_navigation(dome, navigation);
    ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
    EXPECT_EQ(first_open_edge(cut.mesh), "");
    const double rounding = 1e-9 * at.scale + 1e-15 * at.origin.cwiseAbs().maxCoeff() * 8;
    int inside = 0;
    for (int i = 0; i < 1500; ++i) {
      const Vec3 offset = random.in_box({Vec3(-60, -60, -5), Vec3(60, 60, 40)});
      const Vec3 p = at.origin + at.scale * offset;
      const double by = slack(*navigation.above_ground, p);
      if (std::abs(by) < rounding || !holds(dome.mesh, p)) continue;
      EXPECT_EQ(holds(cut.mesh, p), by > 0) << p.transpose() << " keeps the limit by " << by;
      inside += by > 0;
    }
    EXPECT_GT(inside, 100);
  }
}

TEST(AboveGround, NoVertexLeavesTheBand) {
  Random random(7);
  for (const GroundCase& at : kGroundCases) {
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    const Navigation navigation =
        above(make_hills(random, 50 * at.scale, 6 * at.scale, 12, at.origin), 4 * at.scale, 25 * at.scale);
    const Volume cut = cut_to_navigation(dome, navigation);
    const double rounding = 1e-9 * at.scale + 1e-15 * at.origin.cwiseAbs().maxCoeff() * 8;
    for (const Vec3& v : cut.mesh.vertices) {
      // At the border of the ground rounding decides whether there is some: a little further in there is.
      const Vec3 inward = v + 1e-9 * (at.origin - v);
      EXPECT_GT(slack(*navigation.above_ground, {inward.x(), inward.y(), v.z()}), -1e-6 * at.scale - rounding)
          << v.transpose();
    }
  }
}

TEST(AboveGround, AnEndThatLimitsNothingRoundsNothing) {
  Random random(91);
  for (const GroundCase& at : kGroundCases) {
    SCOPED_TRACE(at.scale);
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    const Mesh ground = make_hills(random, 50 * at.scale, 6 * at.scale, 12, at.origin);
    const Volume cut = cut_to_navigation(dome, above(ground, 4 * at.scale, 200 * at.scale));
    ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
    const double size_m3 = enclosed_volume(cut.mesh);
    const double low_m3 = enclosed_volume(cut_to_navigation(dome, above(ground, -200 * at.scale, 25 * at.scale)).mesh);
    for (const double far_m : {1e4, 1e9, 1e15, 1e300}) {
      const Volume other = cut_to_navigation(dome, above(ground, 4 * at.scale, far_m));
      EXPECT_NEAR(enclosed_volume(other.mesh), size_m3, 1e-12 * size_m3) << "up to " << far_m;
      const Volume under = cut_to_navigation(dome, above(ground, -far_m, 25 * at.scale));
      EXPECT_NEAR(enclosed_volume(under.mesh), low_m3, 1e-12 * low_m3) << "from " << -far_m << ": " << under.reason;
      const Volume none = cut_to_navigation(dome, above(ground, far_m, 2 * far_m));
      EXPECT_EQ(none.mesh.triangles.size(), 0U) << "from " << far_m;
    }
  }
}

TEST(AboveGround, OfPiecesOverEachOtherAllCount) {
  Random random(5);
  Mesh ground = make_hills(random, 50, 3, 6, Vec3::Zero());
  const Mesh bridge = make_hills(random, 20, 2, 3, Vec3(10, 5, 12));
  testing::append(ground, bridge);
  const Volume dome = make_hemisphere(Vec3::Zero(), 60);
  const Navigation navigation = above(ground, 4, 25);
  const Volume cut = cut_to_navigation(dome, navigation);
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(first_open_edge(cut.mesh), "");
  int inside = 0, between = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in_box({Vec3(-50, -50, 0), Vec3(50, 50, 40)});
    const double by = slack(*navigation.above_ground, p);
    if (std::abs(by) < 1e-9 || !holds(dome.mesh, p)) continue;
    EXPECT_EQ(holds(cut.mesh, p), by > 0) << p.transpose() << " keeps the limit by " << by;
    inside += by > 0;
    const Heights heights = heights_at(*navigation.above_ground->ground.surface, p);
    between += heights.any && heights.highest > p.z() && heights.lowest < p.z();
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(between, 20);
  EXPECT_EQ(walls_inside(cut, Vec3::Zero(), 50), 0);
}

/// The same for a zone with the plan [-30, 30] by [-20, 20]: how far from its border a point is, positive inside of a
/// zone to stay in, negative inside of one to stay out of.
double zone_slack(const Zone& zone, bool is_kept, const Vec3& p, const Vec3& origin) {
  const Vec3 at = p - origin;
  const double beside = std::min(30 - std::abs(at.x()), 20 - std::abs(at.y()));
  const Heights heights = heights_at(*zone.above_ground->ground.surface, p);
  const auto& [min_m, max_m, ground] = *zone.above_ground;
  if (is_kept) {
    if (!heights.any) return -INFINITY;
    return std::min({beside, p.z() - heights.highest - min_m, heights.lowest + max_m - p.z()});
  }
  if (!heights.any) return -beside;
  return -std::min({beside, p.z() - heights.lowest - min_m, heights.highest + max_m - p.z()});
}

TEST(AboveGround, ZonesHaveHeightsToo) {
  Random random(71);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000.1, 4785000.2, 1000.3)}) {
    Mesh ground = make_hills(random, 25, 3, 6, origin);  // ends inside of the zone
    for (const bool has_bridge : {false, true}) {
      if (has_bridge) testing::append(ground, make_hills(random, 10, 2, 3, origin + Vec3(8, 5, 9)));
      const auto surface = std::make_shared<const Mesh>(ground);
      for (const auto& [min_m, max_m] : {std::pair{4.0, 20.0}, {-INFINITY, 12.0}, {6.0, 1e15}}) {
        Zone zone;
        for (const auto& [x, y] : {std::pair{-30, -20}, {30, -20}, {30, 20}, {-30, 20}}) {
          zone.outer.emplace_back(origin.x() + x, origin.y() + y);
        }
        zone.name = "z";
        zone.above_ground = {min_m, max_m, Ground{0, surface}};
        for (const bool is_kept : {true, false}) {
          SCOPED_TRACE(::testing::Message() << origin.x() << has_bridge << min_m << is_kept);
          Navigation navigation;
          (is_kept ? navigation.keep_in : navigation.keep_out) = {zone};
          const Volume dome = make_hemisphere(origin, 60);
          const Volume cut = cut_to_navigation(dome, navigation);
          ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
          EXPECT_EQ(first_open_edge(cut.mesh), "");
          const PreparedTarget target(PreparedScene(Scene()), Target::point(origin), Sensor{.max_range_m = 500});
          PointQuery query(target, navigation);
          int inside = 0, outside = 0;
          for (int i = 0; i < 300; ++i) {
            const Vec3 p = origin + random.in_box({Vec3(-40, -40, 0), Vec3(40, 40, 40)});
            const double by = zone_slack(zone, is_kept, p, origin);
            if (std::abs(by) < 1e-6 || !holds(dome.mesh, p)) continue;
            EXPECT_EQ(holds(cut.mesh, p), by > 0) << (p - origin).transpose() << " by " << by;
            EXPECT_EQ(query.answer(std::vector<Vec3>{p})[0].outside_of.empty(), by > 0) << by;
            (by > 0 ? inside : outside) += 1;
          }
          EXPECT_GT(inside, 5);
          EXPECT_GT(outside, 5);
        }
      }
    }
  }
}

TEST(AboveGround, APlaneGoesOnForEver) {
  const Volume dome = make_hemisphere(Vec3(0, 0, 100), 60);
  Navigation navigation, altitude;
  navigation.above_ground = {10, 30, Ground{98}};
  altitude.altitude = {108, 128};
  const Volume cut = cut_to_navigation(dome, navigation), expected = cut_to_navigation(dome, altitude);
  EXPECT_EQ(cut.mesh.vertices, expected.mesh.vertices);
  std::vector<std::string> names;
  for (const Cause& cause : cut.causes) names.push_back(cause.name);
  EXPECT_NE(std::find(names.begin(), names.end(), "agl min"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "agl max"), names.end());
}

TEST(AboveGround, WhereThereIsNoGroundNothingIsLeft) {
  Random random(3);
  const Volume dome = make_hemisphere(Vec3::Zero(), 60);
  const Volume cut = cut_to_navigation(dome, above(make_hills(random, 10, 1, 3, Vec3(500, 0, 0)), 4, 25));
  EXPECT_EQ(cut.outcome, Outcome::outside_limits);
  testing::expect_wording(cut.reason + "\n" + cut.hint);
  const Volume high = cut_to_navigation(dome, above(make_hills(random, 100, 1, 3, Vec3(0, 0, 0)), 400, 425));
  EXPECT_EQ(high.outcome, Outcome::outside_limits);
  testing::expect_wording(high.reason + "\n" + high.hint);
}

TEST(AboveGround, WrongLimitsAreRefused) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 60);
  const auto refused = [&](const Navigation& navigation) { cut_to_navigation(dome, navigation); };
  Random random(3);
  const Mesh hills = make_hills(random, 10, 1, 3, Vec3::Zero());
  testing::expect_error([&] { refused(above(hills, 5, 4)); }, ErrorCode::limits_reversed, "navigation.altitude.agl");
  Mesh broken = hills;
  broken.triangles.push_back({0, 1, 1000});
  testing::expect_error([&] { refused(above(broken, 4, 5)); }, ErrorCode::index_out_of_range, "ground");
  broken = hills;
  broken.vertices[3].z() = NAN;
  testing::expect_error([&] { refused(above(broken, 4, 5)); }, ErrorCode::coordinate_not_finite, "ground");
}

/// Hills with a wall on them, and a target over a hill top.
struct World {
  Scene scene;
  Target target;
  Navigation navigation;
};

World make_world(Random& random, const Vec3& origin) {
  World world;
  world.scene.mesh = make_hills(random, 50, 4, 10, origin);
  world.scene.object_of.assign(world.scene.mesh.triangles.size(), 0);
  world.scene.objects = {{"hills", "", ObjectKind::ground}, {"wall", "", ObjectKind::wall}};
  const auto first = static_cast<std::uint32_t>(world.scene.mesh.vertices.size());
  for (const Vec3& v : {Vec3(8, -10, 0), Vec3(8, 10, 0), Vec3(8, 10, 14), Vec3(8, -10, 14)}) {
    world.scene.mesh.vertices.push_back(origin + v);
  }
  world.scene.mesh.triangles.push_back({first, first + 1, first + 2});
  world.scene.mesh.triangles.push_back({first, first + 2, first + 3});
  world.scene.object_of.insert(world.scene.object_of.end(), 2, 1);
  world.target = Target::polygon({origin + Vec3(-1, -1, 6), origin + Vec3(1, -1, 6), origin + Vec3(0, 1, 6)});
  world.navigation.above_ground = {5, 30, *ground_of(world.scene)};
  return world;
}

TEST(AboveGround, PointsAreAnsweredAsTheMeshSays) {
  Random random(11);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000.1, 4785000.2, 1000.3)}) {
    const World world = make_world(random, origin);
    const PreparedScene scene(world.scene);
    const PreparedTarget target(scene, world.target, Sensor{.max_range_m = 60});
    const Volume volume = compute_volume(target, world.navigation);
    ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
    std::vector<Vec3> points;
    for (int i = 0; i < 3000; ++i) points.push_back(origin + random.in_box({Vec3(-60, -60, 6), Vec3(60, 60, 60)}));
    PointQuery query(target, world.navigation);
    const std::vector<PointAnswer> answers = query.answer(points);
    int inside = 0, at_edge = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(std::abs(answers[i].margin_m) > 0.05)) continue;  // the range is a sphere, but not of the mesh
      EXPECT_EQ(answers[i].inside, holds(volume.mesh, points[i])) << (points[i] - origin).transpose();
      inside += answers[i].inside;
      at_edge += std::count(answers[i].outside_of.begin(), answers[i].outside_of.end(), "ground edge") > 0;
      // What the margin says is so: a little before it nothing changes along the line to the centre, behind it does.
      if (!std::isfinite(answers[i].margin_m) || !answers[i].inside) continue;
      const Vec3 line = target.frame(0).origin - points[i], to_centre = line.normalized();
      const double margin = answers[i].margin_m;
      if (margin > 0.9 * line.norm()) continue;  // the target, where the line ends, is no boundary
      const std::vector<PointAnswer> near =
          query.answer(std::vector<Vec3>{points[i] + 0.99 * margin * to_centre, points[i] - 0.99 * margin * to_centre,
                                         points[i] + 1.01 * margin * to_centre, points[i] - 1.01 * margin * to_centre});
      EXPECT_TRUE(near[0].inside && near[1].inside);
      EXPECT_FALSE(near[2].inside && near[3].inside);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(at_edge, 100);
  }
}

TEST(AboveGround, VerifyFindsWhatIsNotCut) {
  Random random(13);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000.1, 4785000.2, 1000.3)}) {
    const World world = make_world(random, origin);
    const PreparedScene scene(world.scene);
    const PreparedTarget target(scene, world.target, Sensor{.max_range_m = 60});
    const auto judged = [&](const Navigation& cut_to) {
      const Volume volume = compute_volume(target, cut_to);
      VerifyOptions options;
      options.points = 3000;
      options.lift_m = volume.lift_m;
      return verify_volume(world.scene, world.target, Sensor{.max_range_m = 60}, world.navigation, volume.mesh,
                           options);
    };
    const VerifyReport right = judged(world.navigation);
    EXPECT_EQ(right.over_claimed, 0u);
    EXPECT_EQ(right.under_claimed, 0u);
    EXPECT_GT(right.inside, 300u);
    EXPECT_GT(judged({}).over_claimed, 100u);
    for (const int end : {0, 1}) {
      Navigation loose = world.navigation;
      (end == 0 ? loose.above_ground->min_m : loose.above_ground->max_m) += end == 0 ? -1 : 1;
      const VerifyReport report = judged(loose);
      EXPECT_GT(report.over_claimed, 0u) << "end " << end;
      Navigation tight = world.navigation;
      (end == 0 ? tight.above_ground->min_m : tight.above_ground->max_m) += end == 0 ? 1 : -1;
      EXPECT_GT(judged(tight).under_claimed, 0u) << "end " << end;
    }
  }
}

TEST(AboveGround, VerifyJudgesZones) {
  Random random(73);
  const Vec3 origin(580000.1, 4785000.2, 1000.3);
  const World world = make_world(random, origin);
  const PreparedTarget target(PreparedScene(world.scene), world.target, Sensor{.max_range_m = 60});
  Zone zone;
  for (const auto& [x, y] : {std::pair{-30, -20}, {30, -20}, {30, 20}, {-30, 20}}) {
    zone.outer.emplace_back(origin.x() + x, origin.y() + y);
  }
  for (const bool is_kept : {true, false}) {
    const auto with_heights = [&](double min_m, double max_m) {
      Navigation navigation;
      Zone& added = (is_kept ? navigation.keep_in : navigation.keep_out).emplace_back(zone);
      added.above_ground = {min_m, max_m, world.navigation.above_ground->ground};
      return navigation;
    };
    const auto judged = [&](double min_m, double max_m) {
      const Volume volume = compute_volume(target, with_heights(min_m, max_m));
      VerifyOptions options;
      options.points = 3000;
      options.lift_m = volume.lift_m;
      return verify_volume(world.scene, world.target, Sensor{.max_range_m = 60}, with_heights(5, 30), volume.mesh,
                           options);
    };
    EXPECT_EQ(judged(5, 30).over_claimed, 0u);
    EXPECT_EQ(judged(5, 30).under_claimed, 0u);
    const VerifyReport wider = judged(4, 31), narrower = judged(6, 29);
    EXPECT_GT((is_kept ? wider : narrower).over_claimed, 0u);
    EXPECT_GT((is_kept ? narrower : wider).under_claimed, 0u);
  }
}

/// Two triangles named "field", two named "dam" over them, without a word on what is ground.
constexpr const char* kField =
    "v -50 -50 0\nv 50 -50 0\nv 50 50 8\nv -50 50 8\no field\nf 1 2 3\nf 1 3 4\n"
    "v -50 40 20\nv 50 40 20\nv 50 45 20\no dam\nf 5 6 7\n";

class AboveGroundMission : public ::testing::Test {
 protected:
  AboveGroundMission() { testing::write_bytes(folder_ / "field.obj", kField); }

  MissionFile read(const std::string& navigation) const {
    const std::string text =
        "scene: {mesh: field.obj}\ntarget: {vertices: [[0, 0, 6], [2, 0, 6], [0, 2, 6]]}\nsensor: {max_range: 40}\n"
        "navigation: " +
        navigation + "\n";
    return read_mission_text(text, folder_ / "mission.yaml");
  }
  Mission resolve(const std::string& navigation) const { return resolve_mission(read(navigation)); }

  testing::TemporaryDirectory folder_;
};

TEST_F(AboveGroundMission, TheGroundIsAnObjectOrAPlane) {
  const Mission named = resolve("{altitude: {agl: [5, 30], z: [0, 25]}, ground: field}");
  ASSERT_TRUE(named.navigation.above_ground && named.navigation.above_ground->ground.surface);
  EXPECT_EQ(named.navigation.above_ground->ground.surface->triangles.size(), 2u);
  EXPECT_EQ(named.navigation.altitude->max_m, 25);
  const Mission plane = resolve("{altitude: {agl: [5, 30]}, ground: 1.5}");
  EXPECT_FALSE(plane.navigation.above_ground->ground.surface);
  EXPECT_EQ(plane.navigation.above_ground->ground.plane_z_m, 1.5);
  // "1.5" in quotes is a name.
  testing::expect_error([&] { resolve("{altitude: {agl: [5, 30]}, ground: '1.5'}"); }, ErrorCode::object_missing,
                        "mission.yaml:4:");
  testing::expect_error([&] { resolve("{altitude: {agl: [5, 30]}, ground: feild}"); }, ErrorCode::object_missing,
                        "mission.yaml:4:");
}

TEST_F(AboveGroundMission, ASceneOfTerrainAloneIsGroundAsAWhole) {
  const Mission mission = resolve("{altitude: {agl: [5, 30]}, clearance: 2, ground: all}");
  ASSERT_TRUE(mission.navigation.above_ground && mission.navigation.above_ground->ground.surface);
  EXPECT_EQ(mission.navigation.above_ground->ground.surface->triangles, mission.scene().mesh.triangles);
  EXPECT_EQ(mission.navigation.clearance->obstacles->triangles.size(), 3u);  // the clearance is kept from terrain
  // An object of that name is what is meant.
  testing::write_bytes(folder_ / "field.obj", std::string(kField).replace(std::string(kField).find("field"), 5, "all"));
  const Mission named = resolve("{altitude: {agl: [5, 30]}, ground: all}");
  EXPECT_EQ(named.navigation.above_ground->ground.surface->triangles.size(), 2u);
}

TEST_F(AboveGroundMission, AMeshThatDoesNotSayWhatIsGroundIsRefused) {
  testing::expect_error([&] { resolve("{altitude: {agl: [5, 30]}}"); }, ErrorCode::ground_missing, "mission.yaml:4:");
}

TEST_F(AboveGroundMission, WrongKeysAreRefused) {
  const auto refuse = [&](const std::string& navigation, ErrorCode code) {
    testing::expect_error([&] { read(navigation); }, code, "mission.yaml:4:");
  };
  refuse("{altitude: {agl: [30, 5]}}", ErrorCode::limits_reversed);
  refuse("{altitude: {agl: [5, 5]}}", ErrorCode::limits_empty);
  refuse("{altitude: {agl: 5}}", ErrorCode::wrong_type);
  refuse("{altitude: {}}", ErrorCode::nothing_given);
  refuse("{altitude: {alg: [5, 30]}}", ErrorCode::unknown_key);
  refuse("{altitude: {z: [5, 30]}, ground: 0}", ErrorCode::not_applicable);
  const std::string zone = "keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], ";
  refuse("{" + zone + "agl: [30, 5]}]}", ErrorCode::limits_reversed);
  refuse("{" + zone + "agl: [5, 5]}]}", ErrorCode::limits_empty);
  refuse("{" + zone + "agl: 5}]}", ErrorCode::wrong_type);
  refuse("{" + zone + "agl: [5, 30], heights: any}]}", ErrorCode::conflicting_keys);
}

TEST_F(AboveGroundMission, TextAndHashHoldAllOfIt) {
  std::set<std::string> hashes, texts;
  for (const char* navigation :
       {"{altitude: [5, 30]}", "{altitude: {z: [5, 31]}}", "{altitude: {agl: [5, 30]}, ground: 0}",
        "{altitude: {agl: [5, 30]}, ground: 1}", "{altitude: {agl: [5, 30]}, ground: field}",
        "{altitude: {agl: [5, 30]}, ground: dam}", "{altitude: {agl: [5, 30], z: [0, 20]}, ground: dam}",
        "{keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], agl: [0, 20]}], ground: dam}",
        "{keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], agl: [0, 20], z: [0, 10]}], ground: dam}"}) {
    const MissionFile mission = read(navigation);
    const std::string text = mission_text(mission, mission.file.parent_path());
    const MissionFile again = read_mission_text(text, mission.file);
    EXPECT_EQ(mission_text(again, mission.file.parent_path()), text);
    EXPECT_EQ(mission_hash(resolve_mission(again)), mission_hash(resolve_mission(mission)));
    hashes.insert(mission_hash(resolve_mission(mission)));
    texts.insert(text);
  }
  EXPECT_EQ(hashes.size(), 9u);
  EXPECT_EQ(texts.size(), 9u);
}

TEST(AboveGroundMap, OverTerrainTheVolumeKeepsItsHeights) {
  VANTAGE_REQUIRE_SHARED("osm/monaco.osm.pbf");
  VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
  const std::string text = "scene: {osm: '" + testing::shared_data("osm/monaco.osm.pbf").string() + "', terrain: '" +
                           testing::shared_data("osm-terrain/N43E007.hgt.zip").string() +
                           "', center: [43.7384, 7.4246], radius: 350, without: [trees]}\n"
                           "target: {center: [43.7386, 7.4250], width: 6, length: 6, offset: 30}\n"
                           "sensor: {max_range: 200}\nnavigation: {altitude: {agl: [60, 120]}}\n";
  const Mission mission = resolve_mission(read_mission_text(text, "mission.yaml"));
  const auto& limit = *mission.navigation.above_ground;
  ASSERT_TRUE(limit.ground.surface);
  EXPECT_GT(limit.ground.surface->triangles.size(), 100u);
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  double lowest = INFINITY, highest = -INFINITY;
  for (const Vec3& v : result.volume.mesh.vertices) {
    const Heights heights = heights_at(*limit.ground.surface, v);
    if (!heights.any) continue;
    lowest = std::min(lowest, v.z() - heights.highest);
    highest = std::max(highest, v.z() - heights.lowest);
  }
  EXPECT_NEAR(lowest, 60, 1e-9);
  EXPECT_NEAR(highest, 120, 1e-9);
  VerifyOptions options;
  options.points = 1000;
  options.lift_m = result.volume.lift_m;
  const VerifyReport report =
      verify_volume(mission.scene(), mission.target, mission.sensor, mission.navigation, result.volume.mesh, options);
  EXPECT_TRUE(report.is_right()) << report.worst_over_cause;
  EXPECT_EQ(report.under_claimed, 0u);
}

TEST(Ground, IsWhatTheSceneSaysItIs) {
  Random random(2);
  Scene scene;
  scene.mesh = make_hills(random, 10, 1, 3, Vec3::Zero());
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects = {{"hills", "", ObjectKind::other}};
  EXPECT_FALSE(ground_of(scene));
  EXPECT_EQ(ground_of(scene, 0).surface->triangles.size(), scene.mesh.triangles.size());
  testing::expect_error([&] { ground_of(scene, 1); }, ErrorCode::value_out_of_range, "ground");
  scene.objects[0].kind = ObjectKind::ground;
  ASSERT_TRUE(ground_of(scene) && ground_of(scene)->surface);
  for (Vec3& vertex : scene.mesh.vertices) vertex.z() = 3;
  EXPECT_TRUE(ground_of(scene)->surface) << "level triangles of an unknown source end where they end";
  scene.georeference.emplace().vertical = kFlatGround;
  ASSERT_FALSE(ground_of(scene)->surface) << "the flat ground of a map does not end";
  EXPECT_EQ(ground_of(scene)->plane_z_m, 3);
}

}  // namespace
}  // namespace vantage
