// query_points against the mesh that compute_visibility makes of the same target.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "core/parallel.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

Scene walls() {
  Scene scene;
  scene.objects = named({"east wall", "roof"});
  scene.mesh.vertices = {{10, -5, 0},   {10, 5, 0},   {10, 5, 8},  {10, -5, 8},
                         {-20, -4, 12}, {-8, -4, 12}, {-8, 4, 12}, {-20, 4, 12}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  scene.object_of = {0, 0, 1, 1};
  return scene;
}

Target square() {
  Target target;
  target.parts[0] = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  return target;
}

TEST(Query, NamesWhatHidesAndByHowMuch) {
  const PreparedScene scene(walls());
  const auto answers = query_points(PreparedTarget(scene, square(), {50}), {},
                                    {{0, 0, 20}, {20, 0, 1}, {-30, 0, 20}, {0, 0, 60}, {0, 0, -1}});
  EXPECT_TRUE(answers[0].inside);
  // Straight up the range ends where the corners are 50 m away.
  EXPECT_NEAR(answers[0].margin_m, std::sqrt(50.0 * 50 - 50) - 20, 1e-9);
  EXPECT_FALSE(answers[1].inside);
  EXPECT_EQ(answers[1].blocked_by, std::vector<std::string>{"east wall"});
  EXPECT_NEAR(answers[1].margin_m, std::hypot(10, 0.5) - std::hypot(20, 1), 1e-9);
  EXPECT_EQ(answers[2].blocked_by, std::vector<std::string>{"roof"});
  EXPECT_TRUE(answers[3].out_of_range);
  EXPECT_TRUE(answers[4].behind_target);
  EXPECT_LT(answers[4].margin_m, 0);
}

TEST(Query, NamesTheLimitsThatArePassed) {
  Navigation navigation;
  navigation.altitude = {5, 30};
  navigation.keep_in = {Box{Vec3(-10, -10, 0), Vec3(10, 10, 40)}};
  navigation.keep_out = {Box{Vec3(-1, -1, 15), Vec3(1, 1, 25)}};
  const PreparedScene scene(walls());
  const auto answers = query_points(PreparedTarget(scene, square(), {50}), navigation,
                                    {{0, 0, 10}, {0, 0, 20}, {0, 0, 35}, {0, 12, 20}, {0, 3, 2}});
  EXPECT_TRUE(answers[0].inside);
  EXPECT_EQ(answers[1].outside_of, std::vector<std::string>{"keep_out zone 0"});
  EXPECT_EQ(answers[2].outside_of, std::vector<std::string>{"altitude max"});
  EXPECT_EQ(answers[3].outside_of, std::vector<std::string>{"keep_in"});
  EXPECT_EQ(answers[4].outside_of, std::vector<std::string>{"altitude min"});
}

TEST(Query, LimitsBoundTheMargin) {
  Navigation navigation;
  navigation.altitude = {5, 30};
  navigation.keep_out = {Box{Vec3(-1, -1, 15), Vec3(1, 1, 25)}};
  const PreparedScene scene(walls());
  const auto margin = [&](const Vec3& point) {
    return query_points(PreparedTarget(scene, square(), {50}), navigation, {point})[0].margin_m;
  };
  EXPECT_NEAR(margin({0, 0, 7}), 2, 1e-9);
  EXPECT_NEAR(margin({0, 0, 14}), 1, 1e-9);
  EXPECT_NEAR(margin({0, 0, 29}), 1, 1e-9);
  EXPECT_NEAR(margin({0, 0, 26}), 1, 1e-9);
  EXPECT_NEAR(margin({0, 0, 2}), -3, 1e-9);
  EXPECT_NEAR(margin({0, 0, 33}), -3, 1e-9);
  EXPECT_NEAR(margin({0, 0, 80}), -50, 1e-9);
  EXPECT_NEAR(margin({0, 0, 16}), -1, 1e-9);
  EXPECT_NEAR(margin({0, 0, 23}), -2, 1e-9);
  EXPECT_NEAR(margin({0, 0, -4}), -9, 1e-9) << "behind the target";
  EXPECT_NEAR(margin({0, 0, 0}), -5, 1e-9) << "at its centre";
  EXPECT_NEAR(margin({0, 0, 30}), 0, 1e-9) << "on the limit";
  EXPECT_NEAR(margin({0, 4, 8}), std::hypot(4, 8) * 3 / 8, 1e-9) << "obliquely";
  // Along the ground the line is never high enough.
  EXPECT_EQ(margin({0, 30, 1}), -INFINITY);
}

TEST(Query, BoxesAndMeshesBoundTheMargin) {
  const PreparedScene scene(walls());
  Navigation boxes;  // two that touch are one
  boxes.keep_in = {Box{Vec3(-9, -9, 10), Vec3(9, 9, 20)}, Box{Vec3(-9, -9, 20), Vec3(9, 9, 32)},
                   Box{Vec3(30, 30, 1), Vec3(31, 31, 2)}};
  Navigation meshes;
  meshes.meshes = {{testing::make_box_mesh(Vec3(-9, -9, 10), Vec3(9, 9, 32)), "zone"},
                   {testing::make_box_mesh(Vec3(-40, -40, -1), Vec3(40, 40, 40)), "all"}};
  for (const Navigation& navigation : {boxes, meshes}) {
    const std::vector<Vec3> points = {{0, 0, 18}, {0, 0, 30}, {0, 0, 4}, {0, 0, 35}, {0, 0, -1}, {0, 20, 4}};
    const auto answers = query_points(PreparedTarget(scene, square(), {50}), navigation, points);
    const std::vector<double> expected = {8, 2, -6, -3, -11, -INFINITY};
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(answers[i].inside, i < 2) << points[i].transpose();
      if (std::isfinite(expected[i])) {
        EXPECT_NEAR(answers[i].margin_m, expected[i], 1e-9) << points[i].transpose();
      } else {
        EXPECT_EQ(answers[i].margin_m, expected[i]) << points[i].transpose();
      }
    }
  }
}

/// All kinds of limits.
Navigation some_limits() {
  Navigation navigation;
  navigation.altitude = {4, 38};
  navigation.keep_in = {Box{Vec3(-40, -40, 0), Vec3(5, 40, 45)}, Box{Vec3(-5, -25, 2), Vec3(45, 25, 30)}};
  navigation.keep_out = {Box{Vec3(-20, 5, 0), Vec3(-5, 15, 20)}, Box{Vec3(6, -12, 8), Vec3(20, -2, 50)}};
  navigation.meshes = {{testing::make_box_mesh(Vec3(-35, -30, -10), Vec3(40, 30, 60)), "zone"}};
  for (int v = 4; v < 8; ++v) navigation.meshes[0].mesh.vertices[v].x() += 10;  // slanted sides
  return navigation;
}

TEST(Query, TheMarginIsWhereTheAnswerChanges) {
  const PreparedScene scene(walls());
  const unsigned seed = 20240818;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> side(-50, 50), up(-10, 50);
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.emplace_back(side(random), side(random), up(random));
  for (const Navigation& navigation : {Navigation(), some_limits()}) {
    const auto answers = query_points(PreparedTarget(scene, square(), {50}), navigation, points);
    constexpr double kStep = 1e-6;
    std::vector<Vec3> before, beyond;  // two a point: away from the target's centre and towards it
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double margin = std::isfinite(answers[i].margin_m) ? std::abs(answers[i].margin_m) : 1000;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 away = sign * points[i].normalized();
        before.push_back(points[i] + away * std::max(margin - kStep, 0.0));
        beyond.push_back(points[i] + away * (margin + kStep));
      }
    }
    const auto same = query_points(PreparedTarget(scene, square(), {50}), navigation, before);
    const auto other = query_points(PreparedTarget(scene, square(), {50}), navigation, beyond);
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_inside = answers[i].inside, has_boundary = std::isfinite(answers[i].margin_m);
      inside += is_inside;
      EXPECT_EQ(same[2 * i].inside, is_inside) << points[i].transpose();
      const bool reaches_target = points[i].norm() <= answers[i].margin_m;  // where the line ends
      if (!reaches_target) {
        EXPECT_EQ(same[2 * i + 1].inside, is_inside) << points[i].transpose();
      }
      EXPECT_EQ(other[2 * i].inside != is_inside || other[2 * i + 1].inside != is_inside, has_boundary)
          << points[i].transpose() << " margin " << answers[i].margin_m;
    }
    EXPECT_GT(inside, 200);
  }
}

TEST(Query, AgreesWithTheMesh) {
  const PreparedScene scene(walls());
  const Volume whole = compute_visibility(PreparedTarget(scene, square(), {50}), {0.05, 0});
  const unsigned seed = 20240817;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> side(-50, 50), up(0.01, 50);
  std::vector<Vec3> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(side(random), side(random), up(random));
  for (const Navigation& navigation : {Navigation(), some_limits()}) {
    const Volume volume = cut_to_navigation(whole, navigation);
    const auto answers = query_points(PreparedTarget(scene, square(), {50}), navigation, points);
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(answers[i].margin_m) < 0.1) continue;  // the mesh's own tolerance
      double winding = 0;
      for (const Triangle& t : volume.mesh.triangles) {
        const Vec3 a = volume.mesh.vertices[t[0]] - points[i], b = volume.mesh.vertices[t[1]] - points[i],
                   c = volume.mesh.vertices[t[2]] - points[i];
        winding += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
      }
      EXPECT_EQ(answers[i].inside, winding > std::numbers::pi) << points[i].transpose();
      EXPECT_EQ(answers[i].inside, answers[i].margin_m > 0) << points[i].transpose();
      inside += answers[i].inside;
    }
    EXPECT_GT(inside, 100);
  }
}

/// Triangles, small and large, many of them degenerate on purpose: standing on the target's plane or a hair above it,
/// nearly in it, thin as needles, doubled, or touching the target's edge.
Scene soup(testing::Random& random, double scale, const Vec3& at) {
  Scene scene;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Vec3& v : {a, b, c}) scene.mesh.vertices.push_back(at + scale * v);
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
    scene.object_of.push_back(static_cast<std::uint32_t>(random.integer(0, 11)));
  };
  for (int i = 0; i < 12; ++i) scene.objects.push_back({"object " + std::to_string(i % 9)});  // some share a name
  const auto small = [&] { return random.uniform(-6, 6); };
  for (int i = 0; i < 240; ++i) {
    const double turn = random.uniform(0, 2 * std::numbers::pi), hair = std::pow(10.0, random.uniform(-9, -2));
    const Vec3 o = random.uniform(17, 60) * Vec3(std::cos(turn), std::sin(turn), 0), up(0, 0, 1);
    const Vec3 along(small(), small(), 0), high = random.uniform(0, 25) * up;
    switch (i % 6) {
      case 0:  // a wall on the ground
        add(o, o + along, o + along + high);
        break;
      case 1:  // one that floats a hair above it
        add(o + hair * up, o + along + hair * up, o + along + high);
        break;
      case 2:  // nearly in the target's plane
        add(o + hair * up, o + along, o + Vec3(small(), small(), hair));
        break;
      case 3:  // a needle
        add(o + high, o + along + high, o + along + Vec3(hair, 0, 1));
        break;
      case 4:  // a roof
        add(o + 9 * up, o + along + 9 * up, o + Vec3(small(), small(), 9));
        break;
      default:  // anything
        add(o + small() * up, o + along, o + Vec3(small(), small(), small()));
    }
  }
  add({5, -5, 0}, {5, 5, 0}, {7, 0, 4});  // leans on the target's edge
  return scene;
}

/// Bit for bit, but for the answers' order, which is the points'.
void expect_same(const PointAnswer& a, const PointAnswer& b, const Vec3& point) {
  EXPECT_EQ(a.inside, b.inside) << point.transpose();
  EXPECT_EQ(a.margin_m, b.margin_m) << point.transpose();
  EXPECT_EQ(a.blocked_by, b.blocked_by) << point.transpose();
  EXPECT_EQ(a.out_of_range, b.out_of_range) << point.transpose();
  EXPECT_EQ(a.behind_target, b.behind_target) << point.transpose();
  EXPECT_EQ(a.outside_of, b.outside_of) << point.transpose();
}

class QueryAtScale : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(QueryAtScale, ManyPointsGetTheBitsOfEachAlone) {
  const auto [scale, shift] = GetParam();
  testing::Random random(20240819);
  const Vec3 at(shift, -shift, shift / 1e4);
  for (int round = 0; round < 3; ++round) {
    const PreparedScene scene(soup(random, scale, at));
    Target target;
    target.offset_m = round == 2 ? 1e-7 * scale : 0;
    const Target given = square();
    for (const Vec3& v : given.parts[0]) target.parts[0].push_back(at + scale * v);
    std::vector<Vec3> points;
    for (int i = 0; i < 400; ++i) {
      const double reach = i % 4 == 3 ? 300 : 60;  // some far out of range
      Vec3 point = reach * random.point(-1, 1);
      point.z() = i % 8 == 0 ? 1e-8 : std::abs(point.z());
      points.emplace_back(at + scale * point);
    }
    for (int i = 0; i < 40; ++i) points.emplace_back(at + scale * 50 * Vec3(random.uniform(-1, 1), i % 2, i % 3 * 0.5));
    points.push_back(at);
    const std::size_t first_of_bundle = points.size();
    for (int i = 0; i < 300; ++i) {  // narrow ones, so that cells become small
      const Vec3 middle = points[static_cast<std::size_t>(i) % 6] - at;
      points.emplace_back(at + random.uniform(0.2, 1.2) * (middle + 1e-3 * middle.norm() * random.point(-1, 1)));
    }
    const Sensor sensor{50 * scale};
    PointQuery query(PreparedTarget(scene, target, sensor));
    for (int i = 0; i < 200; ++i) query.answer(std::span(points).subspan(first_of_bundle));
    const auto answers = query.answer(points);
    std::size_t inside = 0, blocked = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      expect_same(answers[i], query_points(PreparedTarget(scene, target, sensor), {}, {points[i]})[0], points[i]);
      inside += answers[i].inside;
      blocked += answers[i].blocked_by.size();
    }
    EXPECT_GT(inside, 10U);
    EXPECT_GT(blocked, 100U);
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, QueryAtScale,
                         ::testing::Values(std::tuple(1e-3, 0.0), std::tuple(0.1, 0.0), std::tuple(1.0, 0.0),
                                           std::tuple(1.0, 5e6), std::tuple(100.0, 0.0), std::tuple(100.0, 5e6)));

TEST(Query, PointsSeenFromAllSidesAndTargetsInPartsGetTheSameBits) {
  testing::Random random(20240820);
  const PreparedScene scene(soup(random, 1, Vec3::Zero()));
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(random.point(-60, 60));
  Target two;
  two.parts = {{{-5, -5, 0}, {0, -5, 0}, {0, 5, 0}, {-5, 5, 0}}, {{0, -5, 0}, {5, -5, 0}, {0, 5, 0}}};
  for (const Target& target : {Target::point({0, 0, 4}), two}) {
    const PreparedTarget prepared(scene, target, {50});
    PointQuery query(prepared, some_limits());
    query.answer(points);
    const auto answers = query.answer(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      PointQuery fresh(prepared, some_limits());
      expect_same(answers[i], fresh.answer({&points[i], 1})[0], points[i]);
      bool sees_all = true;
      for (std::size_t part = 0; part < target.parts.size(); ++part) {
        sees_all = sees_all && query_points(prepared.part(part), some_limits(), {points[i]})[0].inside;
      }
      EXPECT_EQ(answers[i].inside, sees_all);
    }
  }
}

TEST(Query, ThreadsChangeNoBit) {
  testing::Random random(7);
  const PreparedScene scene(soup(random, 1, Vec3::Zero()));
  std::vector<Vec3> points;
  for (int i = 0; i < 4000; ++i) points.push_back(random.point(-60, 60));
  std::vector<std::vector<PointAnswer>> answers(2);
  for (const int threads : {1, 4}) {
    parallel::with_threads(threads, [&] {
      answers[threads == 1 ? 0 : 1] = query_points(PreparedTarget(scene, square(), {50}), some_limits(), points);
    });
  }
  for (std::size_t i = 0; i < points.size(); ++i) expect_same(answers[0][i], answers[1][i], points[i]);
}

TEST(Query, TellsTheMarginHoweverFarAway) {
  const PreparedScene scene(walls());
  Navigation zone;
  zone.meshes = {{testing::make_box_mesh(Vec3(-9, -9, 0), Vec3(9, 9, 32)), "zone"}};
  for (const double far : {1e9, 1e149, 1e151, 1e155, 1e200, 1.7e308}) {
    const auto answers =
        query_points(PreparedTarget(scene, square(), {50}), zone, {{0, 0, far}, {far, 0, 1}, {0, 0, -far}});
    EXPECT_NEAR(answers[0].margin_m / -far, 1, 1e-7) << far;
    EXPECT_TRUE(answers[0].out_of_range);
    EXPECT_FALSE(answers[0].behind_target);
    EXPECT_EQ(answers[0].outside_of, std::vector<std::string>{"mesh zone"});
    EXPECT_EQ(answers[1].blocked_by, std::vector<std::string>{"east wall"}) << far;
    EXPECT_NEAR(answers[1].margin_m / -far, 1, 1e-7) << far;
    EXPECT_NEAR(answers[2].margin_m / -far, 1, 1e-7) << far;
    EXPECT_TRUE(answers[2].behind_target);
  }
  const double most = std::numeric_limits<double>::max();
  for (const double sign : {1.0, -1.0}) {
    const auto answer = query_points(PreparedTarget(scene, square(), {50}), {}, {Vec3(most, most, sign * most)})[0];
    EXPECT_TRUE(std::isfinite(answer.margin_m)) << answer.margin_m;
    EXPECT_LT(answer.margin_m, -1e308);
    EXPECT_EQ(answer.behind_target, sign < 0);
  }
}

TEST(Query, RefusesNoPartsAndRangesWithoutBound) {
  const PreparedScene scene(walls());
  EXPECT_THROW(PointQuery(PreparedTarget(scene, {}, {50}), {}), Error);
  EXPECT_THROW(PointQuery(PreparedTarget(scene, {square()}, {1e10}), {}), Error);
  EXPECT_THROW(PointQuery(PreparedTarget(scene, {square()}, {NAN}), {}), Error);
}

TEST(Query, RefusesPointsThatAreNotNumbers) {
  EXPECT_THROW(query_points(PreparedTarget(PreparedScene(walls()), square(), {50}), {}, {{NAN, 0, 0}}), Error);
}

TEST(Query, OutOfReachOfEveryone) {
  const auto answers = query_points(PreparedTarget(PreparedScene(walls()), square(), {6}), {}, {{0, 0, 1}});
  EXPECT_TRUE(answers[0].out_of_range);
  EXPECT_FALSE(answers[0].inside);
  EXPECT_EQ(answers[0].margin_m, -INFINITY);
}

}  // namespace
}  // namespace vantage
