// Targets of a single point: the exact engine, the check and queries against rays.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "support/aimed_check.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/ray_caster.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

constexpr double kBall = 4 * std::numbers::pi / 3;

Target point(const Vec3& place, const std::optional<Vec3>& front = std::nullopt) {
  Target target;
  target.name = "camera";
  target.parts[0] = {place};
  target.front = front;
  return target;
}

Volume volume_of(const Scene& scene, const Target& target, double range, double tolerance = 0.01) {
  return compute_visibility(PreparedTarget(PreparedScene(scene), target, {range}), {.tolerance_m = tolerance});
}

/// Volume by rays: within range, before the first hit, on the front.
double ray_volume(const Scene& scene, const Volume& volume, double range, std::size_t count = 200000) {
  const TargetFrame& frame = volume.frame;
  const RayCaster rays(scene.mesh, frame.origin);
  return radial_volume(
      [&](const Vec3& d) { return !frame.all_sides && d.dot(frame.normal) <= 0 ? 0.0 : rays.first_hit(d, range); },
      count);
}

VerifyReport verified(const Scene& scene, const Target& target, const Volume& volume, double range) {
  Target raised = target;
  raised.offset_m += volume.lift_m.at(0);
  return verify_volume(scene, raised, {range}, {}, volume.mesh, {.points = 8000});
}

void expect_right(const Scene& scene, const Target& target, double range) {
  const Volume volume = volume_of(scene, target, range);
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures measures = measure(volume.mesh);
  EXPECT_TRUE(measures.closed && measures.oriented);
  EXPECT_EQ(measures.euler, 2);
  EXPECT_EQ(measures.pieces, 1U);
  const double expected = ray_volume(scene, volume, range);
  EXPECT_NEAR(measures.volume_m3, expected, 1e-3 * expected);
  const VerifyReport report = verified(scene, target, volume, range);
  EXPECT_EQ(report.over_claimed, 0U) << report.worst_over_cause << ' ' << report.worst_over_depth_m << " m at "
                                     << report.worst_over_point.transpose();
  EXPECT_LE(report.under_claimed, report.points / 1000)
      << report.worst_under_depth_m << " m at " << report.worst_under_point.transpose();
}

TEST(PointTarget, AloneIsABall) {
  SceneBuilder builder;
  builder.ground("far below", 10, -500);
  const Volume volume = volume_of(builder, point({1e5, 2, 3}), 50, 0.001);
  const MeshMeasures measures = measure(volume.mesh);
  EXPECT_TRUE(measures.closed && measures.oriented);
  EXPECT_EQ(measures.euler, 2);
  EXPECT_LE(measures.volume_m3, kBall * 125000);
  EXPECT_NEAR(measures.volume_m3, kBall * 125000, kBall * 125000 * 3 * 0.001 / 50);
  ASSERT_EQ(volume.causes.size(), 1U) << "no wall is left between the halves";
  EXPECT_EQ(volume.causes[0].kind, CauseKind::range);
  EXPECT_NEAR(volume.causes[0].area_m2, 4 * std::numbers::pi * 2500, 1);
  EXPECT_EQ(volume.lift_m.at(0), 0);
  EXPECT_TRUE(volume.frame.all_sides);
}

TEST(PointTarget, OverGroundBesideABlock) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  expect_right(builder, point({0, 0, 3}), 60);
  expect_right(builder, point({10, 0, 25}), 60);
  expect_right(builder, point({4.9, 5.2, 0.05}), 60);
}

TEST(PointTarget, OnTheGround) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  for (const double z : {0.0, -1e-3, -1e-6, 1e-9, 5e-7, 1e-4, 1e-3, 1.9e-3}) {
    SCOPED_TRACE(z);
    const Target target = point({0, 0, z});
    const Volume volume = volume_of(builder, target, 60);
    EXPECT_GE(volume.frame.origin.z(), 0.9e-6);
    for (const Cause& cause : volume.causes) EXPECT_NE(cause.kind, CauseKind::target_plane) << cause.name;
    expect_right(builder, target, 60);
  }
}

TEST(PointTarget, OnRoofsOfAnySlope) {
  Random random(11);
  for (const double slope : {0.0, 1e-7, 1e-5, 1e-3, 0.1, 0.5, 1.0, 1.7}) {
    SCOPED_TRACE(slope);
    SceneBuilder builder;
    builder.ground("ground", 100, -20);
    builder.polygon("roof", {{-8, -6, -8 * slope}, {8, -6, 8 * slope}, {8, 6, 8 * slope}, {-8, 6, -8 * slope}});
    builder.box("chimney", {2, 1, -5}, {3, 2, 9});
    const double x = random.uniform(-3, 1), y = random.uniform(-3, 0);
    expect_right(builder, point({x, y, x * slope}), 60);
  }
}

TEST(PointTarget, OnARidge) {
  SceneBuilder builder;
  builder.ground("ground", 100, -20);
  builder.polygon("west", {{-8, -6, -4}, {0, -6, 0}, {0, 6, 0}, {-8, 6, -4}});
  builder.polygon("east", {{0, -6, 0}, {8, -6, -4}, {8, 6, -4}, {0, 6, 0}});
  expect_right(builder, point({0, 0.3, 0}), 60);
}

TEST(PointTarget, UnderABridge) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("deck", {-40, -4, 6}, {40, 4, 7});
  expect_right(builder, point({0, 0, 5.95}), 60);
  expect_right(builder, point({0, 0, 5.95}, Vec3(0, 0, -1)), 60);
}

TEST(PointTarget, FrontIsAHalfSpace) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  for (const Vec3& front : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(1, -2, 0.5)}) {
    expect_right(builder, point({0, 0, 8}, front), 60);
  }
  // On the facade, in its plane but for rounding.
  for (const double off : {0.0, 1e-7, -1e-4}) expect_right(builder, point({5 + off, 0, 8}, Vec3(-1, 0, 0)), 60);
  expect_right(builder, point({5, 1, 8}, Vec3(-1, 0.7, 0)), 60);
}

TEST(PointTarget, RandomCities) {
  Random random(5);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const Scene city = random_city(random, 30, 3);
    const double z = random.chance(0.3) ? 0 : random.uniform(0.01, 30);
    expect_right(city, point({random.uniform(-1, 1), random.uniform(-1, 1), z}), random.uniform(20, 120));
  }
}

/// Many-cornered plates, a millimetre or so over the ground: seen from the point, the shadows of their far edges are
/// hardly wider than what the engine snaps together.
Scene plates(Random& random, int count) {
  SceneBuilder builder;
  builder.ground("ground", 400);
  for (int k = 0; k < count; ++k) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), away = random.uniform(15, 120);
    const Vec3 centre(away * std::cos(angle), away * std::sin(angle), random.uniform(0.5e-3, 5e-3));
    builder.polygon("plate " + std::to_string(k),
                    random_target(random, random.integer(4, 16), random.uniform(2, 8), centre, Vec3::UnitZ()).parts[0]);
  }
  return builder;
}

TEST(PointTarget, NothingHiddenIsClaimedBesideEdges) {
  Random random(31);
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(round);
    const Scene scene = plates(random, 12);
    const double range = 700, height = random.uniform(20, 80);
    const Volume volume = volume_of(scene, point({random.uniform(-5, 5), random.uniform(-5, 5), height}), range, 0.5);
    ASSERT_EQ(volume.outcome, Outcome::computed);
    const AimedReport report = look_beside_edges(scene, volume, range, 20000, random);
    EXPECT_GT(report.looks, 5000U);
    EXPECT_LE(report.worst_share, 1e-6) << report.worst_depth << " m deep at " << report.worst_place.transpose();
  }
}

TEST(PointTarget, FarFromTheOrigin) {
  SceneBuilder builder;
  const Vec3 far(580000, 4785000, 100);
  builder.box("tower", far + Vec3(5, -5, -10), far + Vec3(15, 5, 20));
  builder.box("slab", far + Vec3(-50, -50, -11), far + Vec3(50, 50, -10));
  expect_right(builder, point(far), 60);
  expect_right(builder, point(far - Vec3(0, 0, 10)), 60);
}

// The halves of a point's volume meet in a plane: their rims are one curve, as neither side may stick out of it alone.
TEST(PointTarget, HalvesMeetWithoutAWall) {
  Random random(911);
  const std::array<std::pair<double, Vec3>, 4> worlds = {
      {{1, Vec3::Zero()}, {1e-3, Vec3::Zero()}, {1e3, Vec3::Zero()}, {1, Vec3(4e5, 5e6, 100)}}};
  for (const auto& [scale, origin] : worlds) {
    for (int draw = 0; draw < 25; ++draw) {
      SCOPED_TRACE(::testing::Message() << scale << " m, draw " << draw);
      SceneBuilder scene;
      for (int i = 0; i < 6; ++i) {
        // Across the plane, above it and below; some begin in it.
        const Vec3 at(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-15, 15));
        const Vec3 size(random.uniform(1, 9), random.uniform(1, 9), random.uniform(1, 9));
        const double bottom = random.integer(0, 2) == 0 ? 0 : at.z();
        if (std::abs(at.x() + size.x() / 2) < 7 && std::abs(at.y() + size.y() / 2) < 7) continue;
        scene.box("box", origin + scale * Vec3(at.x(), at.y(), bottom),
                  origin + scale * Vec3(at.x() + size.x(), at.y() + size.y(), bottom + size.z()));
      }
      const Volume volume = volume_of(scene, point(origin), 40 * scale, 0.01 * scale);
      ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
      const MeshMeasures m = measure(volume.mesh);
      EXPECT_TRUE(m.closed && m.oriented && m.pieces == 1) << m.pieces << " pieces";
      EXPECT_EQ(m.euler, 2);
      double area = 0;
      for (const Cause& cause : volume.causes) {
        EXPECT_NE(cause.kind, CauseKind::target_plane);
        area += cause.area_m2;
      }
      EXPECT_NEAR(area, m.area_m2, 1e-9 * m.area_m2);
      EXPECT_NEAR(m.volume_m3, ray_volume(scene, volume, 40 * scale, 20000), 0.02 * m.volume_m3);
    }
  }
}

TEST(PointTarget, OnAWallNeedsAFront) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  for (const double off : {0.0, 1e-6, -1e-6, 1e-4, -1.5e-3, 1.5e-3}) {
    SCOPED_TRACE(off);
    const Error error = testing::expect_error(
        [&] {
          volume_of(builder, point({5 + off, 0, 8}), 60);
        },
        ErrorCode::target_pierced, "\"camera\", at (5.000, ");
    EXPECT_EQ(error.object(), 1U) << "the block";
    EXPECT_NE(error.fix().find("front: [-1.000, 0.000, 0.000]"), std::string::npos) << error.fix();
  }
  expect_right(builder, point({4.997, 0, 8}), 60);
}

TEST(PointTarget, UnderTheGround) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  const Volume volume = volume_of(builder, point({0, 0, -4}), 60);
  EXPECT_EQ(volume.outcome, Outcome::computed);
  ASSERT_EQ(volume.notes.size(), 1U);
  EXPECT_EQ(volume.notes[0].code, WarningCode::target_underground);
  EXPECT_NE(volume.notes[0].text.find("z = 0.00"), std::string::npos) << volume.notes[0].text;
  expect_right(builder, point({0, 0, -4}), 60);
}

TEST(PointTarget, WithinASmallCrate) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("crate", {-0.05, -0.05, 0.01}, {0.05, 0.05, 0.09});
  const Volume volume = volume_of(builder, point({0, 0, 0.05}), 60);
  EXPECT_EQ(volume.outcome, Outcome::computed);
  EXPECT_NEAR(enclosed_volume(volume.mesh), 0.1 * 0.1 * 0.08, 0.1 * 0.1 * 0.08 * 0.05);
  const auto covered = std::ranges::find(volume.notes, WarningCode::target_covered, &Warning::code);
  ASSERT_NE(covered, volume.notes.end());
  testing::expect_wording(covered->text);
}

TEST(PointTarget, ForbidsNoSideToQueries) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  const PreparedScene scene(builder);
  const auto answers =
      query_points(PreparedTarget(scene, point({0, 0, 3}), {60}), {},
                   {{0, 0, 20}, {0, 0, 1}, {-10, 0, 1}, {0, 0, -5}, {20, 0, 3}, {0, 0, 70}, {0, 0, 3}});
  for (const PointAnswer& answer : answers) EXPECT_FALSE(answer.behind_target);
  EXPECT_TRUE(answers[0].inside);
  EXPECT_NEAR(answers[0].margin_m, 43, 1e-6);
  EXPECT_TRUE(answers[1].inside);
  EXPECT_NEAR(answers[1].margin_m, 1, 1e-6) << "down to the ground";
  EXPECT_TRUE(answers[2].inside);
  EXPECT_NEAR(answers[2].margin_m, std::hypot(15, 3) - std::hypot(10, 2), 1e-5);
  EXPECT_FALSE(answers[3].inside);
  EXPECT_EQ(answers[3].blocked_by, std::vector<std::string>{"ground"});
  EXPECT_NEAR(answers[3].margin_m, -5, 1e-6);
  EXPECT_EQ(answers[4].blocked_by, std::vector<std::string>{"block"});
  EXPECT_NEAR(answers[4].margin_m, -15, 1e-5);
  EXPECT_TRUE(answers[5].out_of_range);
  EXPECT_TRUE(answers[6].inside) << "the point itself";
  const auto front =
      query_points(PreparedTarget(scene, point({0, 0, 3}, Vec3(0, 0, 1)), {60}), {}, {{0, 0, 20}, {0, 0, 1}});
  EXPECT_TRUE(front[0].inside);
  EXPECT_TRUE(front[1].behind_target);
  EXPECT_FALSE(front[1].inside);
}

TEST(PointTarget, QueriesAgreeWithRays) {
  Random random(21);
  int inside = 0, outside = 0;
  for (int round = 0; round < 6; ++round) {
    const Scene city = random_city(random, 30, 3);
    const PreparedScene prepared(city);
    const Target target =
        point({random.uniform(-1, 1), random.uniform(-1, 1), round < 2 ? 0 : random.uniform(0.01, 30)});
    const double range = 80;
    const TargetFrame frame = compute_visibility(PreparedTarget(prepared, target, {range})).frame;
    const RayCaster rays(city.mesh, frame.origin);
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) points.push_back(frame.origin + random.direction() * random.uniform(0.01, 90));
    const auto answers = query_points(PreparedTarget(prepared, target, {range}), {}, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 way = points[i] - frame.origin;
      const double seen = rays.first_hit(way.normalized(), range), margin = seen - way.norm();
      if (answers[i].inside) {
        EXPECT_GE(margin, -1e-9) << points[i].transpose();
      } else {
        EXPECT_LE(answers[i].margin_m, 1e-9);
        EXPECT_TRUE(answers[i].out_of_range || !answers[i].blocked_by.empty());
      }
      // But for silhouettes, which the micrometres of the engine's triangle pass on either side.
      if (answers[i].inside != (margin >= 0) && std::abs(margin) > 1e-6) ++outside;
      inside += answers[i].inside;
    }
  }
  EXPECT_GT(inside, 2000);
  EXPECT_LE(outside, 2) << "answers that rays contradict";
}

TEST(PointTarget, VerifyFindsWhatIsWrong) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("block", {5, -5, 0}, {15, 5, 20});
  const Target target = point({0, 0, 3});
  Volume volume = volume_of(builder, target, 60);
  for (Vec3& v : volume.mesh.vertices) v = Vec3(0, 0, 3) + 1.01 * (v - Vec3(0, 0, 3));
  VerifyReport report = verified(builder, target, volume, 60);
  EXPECT_GT(report.over_claimed, report.points / 20);
  EXPECT_NEAR(report.over_claim_bound, 0.03, 0.02) << "three percent of the volume";
  for (Vec3& v : volume.mesh.vertices) v = Vec3(0, 0, 3) + 0.9 * (v - Vec3(0, 0, 3));
  report = verified(builder, target, volume, 60);
  EXPECT_EQ(report.over_claimed, 0U);
  EXPECT_GT(report.under_claimed, report.points / 20);
  // Below a point that lies on the ground nothing sees it, with the lift and without.
  const Volume ball = volume_of(SceneBuilder().ground("far below", 10, -500), point({0, 0, 0}), 60);
  for (const double lift : {0.0, 4e-5}) {
    Target raised = point({0, 0, lift});
    report = verify_volume(builder, raised, {60}, {}, ball.mesh, {.points = 4000});
    EXPECT_GT(report.over_claimed, 1000U);
    EXPECT_EQ(report.worst_over_cause, "ground");
  }
  report = verify_volume(builder, point({0, 0, 3}, Vec3(0, 0, 1)), {60}, {}, ball.mesh, {.points = 4000});
  EXPECT_GT(report.over_claimed, 1000U);
}

class HeavyPointCharlotte : public ::testing::Test {};

TEST_F(HeavyPointCharlotte, AgreesWithRays) {
  VANTAGE_REQUIRE_SHARED("charlotte/targets.json");
  const Scene scene = read_scene(shared_data("charlotte/uptownCharlotte.obj"), {.up = UpAxis::y});
  std::ifstream stream(shared_data("charlotte/targets.json"));
  const auto json = nlohmann::json::parse(stream);
  int tried = 0;
  for (const auto& group : json) {
    for (const auto& region : group.at("regions")) {
      const auto p = region.at("points").at(0).get<std::vector<double>>();
      SCOPED_TRACE(::testing::Message() << "point " << p[0] << ", " << p[1] << ", " << p[2]);
      expect_right(scene, point({p[0], -p[1], p[2]}), 300);
      ++tried;
    }
  }
  EXPECT_GE(tried, 5);
}

/// Points at random in real scenes, some of them on the ground. VANTAGE_HEAVY_POINT_TARGETS: how many in each.
TEST(HeavyPointCities, NothingHiddenIsClaimedBesideEdges) {
  VANTAGE_REQUIRE_SHARED("mesh/munich_merged.ply");
  const char* given = std::getenv("VANTAGE_HEAVY_POINT_TARGETS");
  const std::size_t count = given ? std::strtoull(given, nullptr, 10) : 2;
  constexpr std::array<const char*, 6> kFiles = {
      "battcave/battcave.obj",    "mesh/etoile_merged.ply",        "mesh/munich_merged.ply",
      "mesh/florence_merged.ply", "charlotte/uptownCharlotte.obj", "mesh/simple_street_canyon_merged.ply"};
  constexpr std::array<double, 6> kHeights = {80, 0.0021, 30, 1.7, 12.3, 0};
  Random random(77);
  double worst = 0;
  for (const std::string file : kFiles) {
    const Scene scene = read_scene(shared_data(file), {.up = file.ends_with(".obj") ? UpAxis::y : UpAxis::z});
    const PreparedScene prepared(scene);
    const Box box = bounding_box(scene.mesh);
    std::size_t made = 0;
    for (std::size_t tried = 0; made < count && tried < 100 * count; ++tried) {
      Vec3 place = random.in_box(box);
      place *= 0.7;
      place.z() = kHeights[made % kHeights.size()];
      std::optional<Volume> volume;
      try {
        volume = compute_visibility(PreparedTarget(prepared, point(place), {700}), {.tolerance_m = 0.1});
      } catch (const Error& error) {
        ASSERT_EQ(error.kind(), ErrorKind::input) << error.what();
        continue;  // on a wall
      }
      if (volume->outcome != Outcome::computed || volume->mesh.triangles.size() < 1000) continue;
      ++made;
      const AimedReport report = look_beside_edges(scene, *volume, 700, 40000, random);
      EXPECT_LE(report.worst_share, 1e-6) << file << ", point " << place.transpose() << ": " << report.worst_depth
                                          << " m deep at " << report.worst_place.transpose();
      worst = std::max(worst, report.worst_share);
    }
    EXPECT_EQ(made, count) << file;
  }
  std::cout << "worst: " << worst << " of the distance\n";
}

/// Where a wall hides the point, and a smaller triangle in its place let the volume in all the same.
TEST(HeavyPointCities, WallsAtSomeHundredMetresHide) {
  VANTAGE_REQUIRE_SHARED("mesh/munich_merged.ply");
  const auto expect_hidden = [](const Scene& scene, const Target& target, const Vec3& from) {
    const Volume volume = volume_of(scene, target, 700);
    EXPECT_LE(MeshProbe(volume).depth(from), 1e-6 * (from - volume.frame.origin).norm()) << from.transpose();
  };
  const Scene charlotte = read_scene(shared_data("charlotte/uptownCharlotte.obj"), {.up = UpAxis::y});
  expect_hidden(charlotte, point({281, 126, 2}, Vec3(0, 0, 1)), {468.878090305, -268.854384524, 9.1805406575});
  const Scene munich = read_scene(shared_data("mesh/munich_merged.ply"));
  expect_hidden(munich, point({-108, -93, 30}), {447.619981061, -127.869535869, 16.2904927705});
  expect_hidden(munich,
                point({16.321704014479643, -41.75726387038288, 80},
                      Vec3(-1.2736493271062752, 0.7564951393812008, 1.0298586434986376)),
                {-167.240870851, 340.049377576, 11.7889321797});
}

}  // namespace
}  // namespace vantage::testing
