// Scenes that are degenerate on purpose: needles, worlds of millimetres at map coordinates, many sheets about one axis.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "exact/blocker.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::MeshProbe;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

constexpr double kScales[] = {1e-3, 0.1, 1, 100, 1e4};

/// As map coordinates of 5e6 m are stored: in steps of a nanometre, 2^-30 m.
Vec3 on_map(const Vec3& p) { return (p * 0x1p+30).array().round() * 0x1p-30; }

// An edge that is not much longer than its ends are rounded points anywhere: planes about it must leave the polygon
// behind them all the same, also 40 km away.
TEST(ExactDegenerate, ANeedleLiesBehindAllPlanesOfItsBlocker) {
  Random random(734);
  constexpr double kRounding = 9e-9;  // at map coordinates
  for (const double scale : kScales) {
    const std::vector<Eigen::Vector2d> outline{{-0.5 * scale, -0.5 * scale},
                                               {0.5 * scale, -0.5 * scale},
                                               {0.5 * scale, 0.5 * scale},
                                               {-0.5 * scale, 0.5 * scale}};
    const target::LocalTarget local = target::make_local_target(outline, kRounding, kRounding);
    for (int draw = 0; draw < 2000; ++draw) {
      const Vec3 foot = scale * Vec3(random.uniform(0.6, 2), random.uniform(-2, 2), random.uniform(0.05, 0.2));
      const Vec3 top = foot + scale * (Vec3(0, 0, random.uniform(1, 4)) + 0.1 * random.direction());
      const double width = kRounding * std::pow(10, random.uniform(0, 2));
      const Vec3 across = width * random.direction();
      const std::vector<Vec3> needle{on_map(foot), on_map(top), on_map(top + across), on_map(foot + across)};
      std::vector<exact::Plane> planes;
      std::vector<Vec3> corners;
      if (!exact::BlockerBuilder(local).build(needle, planes, corners)) continue;
      for (const exact::Plane& plane : planes) {
        for (const Vec3& corner : needle) {
          ASSERT_GT((plane.dot(corner) - 1) / plane.norm(), -2 * kRounding) << "scale " << scale << " draw " << draw;
        }
      }
    }
  }
}

// The needle of a target is within rounding of a slope's plane. Which side of it the slope hides cannot be told; from
// high above both are seen.
TEST(ExactDegenerate, ASlopeThatContinuesANeedleHidesNothingHighAbove) {
  const double slack = 8.88e-9;
  const target::LocalTarget local = target::make_local_target(
      {{0.01724705894, -0.02589169374}, {-0.01895282019, 0.02849637058}, {0.004264403114, -0.006511692102}}, slack,
      slack);
  ASSERT_LT(local.clearance, 1e-4);
  const std::vector<Vec3> slope{{-0.1869262077, -0.04316223928, 3.384547481e-06},
                                {-0.1317795244, -0.1263070685, 3.385034854e-06},
                                {0.01788063847, -0.02705297753, 5.532276209e-10},
                                {-0.03726604478, 0.05609185171, 6.585378575e-11}};
  std::vector<exact::Plane> planes;
  std::vector<Vec3> corners;
  ASSERT_TRUE(exact::BlockerBuilder(local).build(slope, planes, corners));
  const Vec3 high(-0.0962, -0.0349, 0.0252);
  EXPECT_TRUE(
      std::any_of(planes.begin(), planes.end(), [&](const exact::Plane& plane) { return plane.dot(high) < 1; }));
}

// A triangle beside a needle, with all of the needle within rounding of its plane: nothing ended from above what it
// hides, and there was no volume. It hides a layer of nanometres.
TEST(ExactDegenerate, WhatLiesInTheTargetsPlaneHidesALayer) {
  Target needle = target_of({{499999.99495510344, 4999999.9301994443, 99.942981646086594},
                             {499999.99613478337, 4999999.9298631251, 99.943303084912046},
                             {500000.00504489656, 5000000.0698005557, 100.05701835391341}});
  needle.front = {-0.36353191520084172, -0.5734484645436051, 0.73416715068367755};
  SceneBuilder builder;
  builder.polygon("house", {{499999.83205584303, 5000000.0501678707, 99.956025855370271},
                            {500000.01330825617, 4999999.8558605872, 99.894004316215685},
                            {499999.86504813237, 4999999.7639174759, 99.748775913586513}});
  const Scene scene = builder;
  const Sensor sensor{0.15899459519379971};
  const ExactOptions options{0.004016045677832889};
  const PreparedScene prepared(scene), empty{Scene{}};
  const Volume volume = compute_visibility(PreparedTarget(prepared, needle, sensor), options);
  const Volume open = compute_visibility(PreparedTarget(empty, needle, sensor), options);
  ASSERT_EQ(volume.outcome, Outcome::computed);
  EXPECT_NEAR(enclosed_volume(volume.mesh) / enclosed_volume(open.mesh), 1, 1e-4);
}

/// Walls, plates and boxes beside and over a target, of a size of about 1.
Scene draw_things(Random& random) {
  SceneBuilder builder;
  for (int k = random.integer(2, 6); k > 0; --k) {
    const Vec3 foot(random.uniform(0.6, 2), random.uniform(-2, 2), 0), along(0.1, random.uniform(0.1, 2), 0);
    const double high = std::pow(10, random.uniform(-4, 0.5)), lean = random.uniform(0, 0.5) * high;
    builder.polygon("wall " + std::to_string(k),
                    {foot, foot + along, foot + along + Vec3(lean, 0, high), foot + Vec3(lean, 0, high)});
  }
  const double over = random.uniform(0.2, 2);
  builder.polygon("plate", {{-1, -0.2, over}, {-0.2, -0.3, over}, {0, 0.4, over + 0.1}});
  return builder;
}

// Vertices a few steps apart: mending narrow facets one by one went round in circles.
TEST(ExactDegenerate, LeavesNoFacetWithoutAreaInSmallWorldsAtMapCoordinates) {
  Random random(65);
  for (const double scale : {1e-3, 1e-2, 0.1}) {
    for (int draw = 0; draw < 40; ++draw) {
      const Eigen::AngleAxisd turn(random.uniform(0, 6), random.chance(0.5) ? Vec3::UnitZ() : random.direction());
      const auto place = [&](const Vec3& p) { return Vec3(Vec3(5e5, 5e6, 100) + scale * (turn * p)); };
      Scene scene = draw_things(random);
      for (Vec3& v : scene.mesh.vertices) v = place(v);
      const double s = random.chance(0.5) ? 0.5 : 1e-3;
      Target target = target_of({place({-0.5, -s, 0}), place({0.5, -s, 0}), place({0.5, s, 0}), place({-0.5, s, 0})});
      target.front = turn * Vec3::UnitZ();
      const Volume volume =
          compute_visibility(PreparedTarget(PreparedScene(scene), target, {6 * scale}), {0.02 * scale, 1});
      ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
      const MeshMeasures measures = measure(volume.mesh);
      EXPECT_TRUE(measures.closed && measures.oriented);
      for (const Triangle& t : volume.mesh.triangles) {
        const Vec3 &a = volume.mesh.vertices[t[0]], &b = volume.mesh.vertices[t[1]], &c = volume.mesh.vertices[t[2]];
        ASSERT_FALSE((b - a).cross(c - a).isZero(0)) << "scale " << scale << " draw " << draw;  // exact: few steps
      }
    }
  }
}

// Upright parapets on the very outline of a target, some halves of them a fraction of a micrometre off: their creases
// meet along the horizon at less than vertices are snapped.
TEST(ExactDegenerate, ParapetsOnTheOutlineAreTriangulated) {
  const double low = -2000, high = 408.75374914007614, middle = -795.62312542996199;
  Mesh parapets;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(parapets.vertices.size());
    parapets.vertices.insert(parapets.vertices.end(), {a, b, c});
    parapets.triangles.push_back({first, first + 1, first + 2});
  };
  const double x[] = {13307.391887659069,  7233.1546198381675,  -11011.666151382025, 1158.9173520157037,
                      -11011.666152531207, -18991.659651089198, -15001.662901810201, -26971.653140493399,
                      2646.9175448780315,  -2052.9031261388882, -6752.7237971558079};
  const double y[] = {18262.079981342653,  22676.70205749906,   35890.227574515789, 27091.324133656599,
                      35890.227574225362,  19359.450736861894,  27624.839155543632, 2828.6738950795661,
                      -37448.084788175984, -34479.837296726277, -31511.58980527657};
  const auto at = [&](int k, double z) { return Vec3(x[k], y[k], z); };
  add(at(0, low), at(0, high), at(1, middle));
  add(at(2, low), at(3, high), at(3, low));
  add(at(4, low), at(5, low), at(6, middle));
  add(at(5, low), at(5, high), at(6, middle));
  add(at(5, high), at(4, high), at(6, middle));
  add(at(7, low), at(7, high), at(5, high));
  add(at(7, low), at(5, high), at(5, low));
  add(at(8, low), at(8, high), at(9, middle));
  add(at(8, high), at(10, high), at(9, middle));
  add(at(10, high), at(10, low), at(9, middle));
  const Target target = target_of({{37538.014055220345, 512.56954173077247, 0},
                                   {25433.757455090414, 9402.4951169508331, 0},
                                   {13307.391887204547, 18262.07998071727, 0},
                                   {1158.9173515627517, 27091.324133030081, 0},
                                   {-11011.666151834979, 35890.227573889271, 0},
                                   {-18991.659650392969, 19359.450736525796, 0},
                                   {-26971.65313979717, 2828.6738947434733, 0},
                                   {-34951.646620047584, -13702.102951457715, 0},
                                   {-25552.005879412212, -19638.598886590607, 0},
                                   {-16152.364938310671, -25575.094504312339, 0},
                                   {-6752.7237967429828, -31511.589804622912, 0},
                                   {2646.9175452908585, -37448.084787522333, 0},
                                   {14768.657739445049, -25246.174710049927, 0},
                                   {26399.023242754876, -12592.623266965555, 0}});
  const PreparedScene scene(SceneBuilder().add("parapets", parapets));
  const Sensor sensor{121052.21472419453};
  const Volume volume = compute_visibility(PreparedTarget(scene, target, sensor), {616.66588597934594, 0});
  ASSERT_EQ(volume.outcome, Outcome::computed);
  EXPECT_TRUE(measure(volume.mesh).closed);
}

// A plane that passes the centre of a target thinner than the others do is known worse than those, which hide it.
TEST(ExactDegenerate, QueriesKnowWhatHidesATargetOfANanometre) {
  Random random(1506);
  for (const double scale : kScales) {
    const double thin = scale * 6e-10;
    const Target target = target_of({{0, -0.1 * scale, 0}, {0, 0.1 * scale, 0}, {thin, 0.1 * scale, 0}});
    SceneBuilder builder;
    builder.polygon("wall", {{-0.2 * scale, -0.3 * scale, 0},
                             {-0.2 * scale, 0.3 * scale, 0},
                             {-0.2 * scale, 0.3 * scale, 0.3 * scale},
                             {-0.2 * scale, -0.3 * scale, 0.3 * scale}});
    const PreparedScene scene(builder);
    std::vector<Vec3> behind;
    for (int k = 0; k < 200; ++k) {
      const double off = std::pow(10, random.uniform(-7, -1));
      behind.push_back(scale * Vec3(-0.2 - off, random.uniform(-0.1, 0.1), random.uniform(0.01, 0.15)));
    }
    for (const PointAnswer& answer : query_points(PreparedTarget(scene, target, {2 * scale}), {}, behind)) {
      EXPECT_FALSE(answer.inside) << "scale " << scale;
      EXPECT_EQ(answer.blocked_by, std::vector<std::string>{"wall"});
    }
  }
}

/// Open triangles, all of them with the corner `foot`; those of a fan share its axis too.
Scene sheets(Random& random, int count, bool fan) {
  const Vec3 foot(0.1, 0.2, 4), tip(5, 1, 8);
  Scene scene;
  scene.objects = {{"sheets"}};
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count, reach = random.uniform(1, 4);
    Vec3 along = random.direction();
    along.z() = std::abs(along.z());
    const Vec3 b = fan ? tip : Vec3(foot + random.uniform(5, 20) * along);
    const Vec3 c = fan ? Vec3(foot + Vec3(std::cos(angle) * reach, std::sin(angle) * reach, random.uniform(0, 5)))
                       : Vec3(foot + random.uniform(5, 20) * (along + 0.01 * random.direction()).normalized());
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    scene.mesh.vertices.insert(scene.mesh.vertices.end(), {foot, b, c});
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  return scene;
}

/// Anywhere in front of the target, and close by where the view ends there.
std::vector<Vec3> draw_viewpoints(Random& random, const PreparedScene& scene, const Target& target, double range) {
  std::vector<Vec3> points;
  for (int k = 0; k < 1500; ++k) {
    Vec3 direction = random.direction();
    direction.z() = std::abs(direction.z()) + 1e-3;
    points.emplace_back(random.uniform(0.1, 1) * range * direction.normalized());
  }
  const std::vector<PointAnswer> answers = query_points(PreparedTarget(scene, target, {range}), {}, points);
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const double away = points[k].norm(), end = away + answers[k].margin_m;
    const double off = (random.chance(0.5) ? 1 : -1) * std::pow(10, random.uniform(-5, -1));
    points.emplace_back(points[k] * (end / away * (1 + off)));
  }
  return points;
}

void expect_what_queries_say(const Scene& scene) {
  const Target target = target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  constexpr double kRange = 40, kTolerance = 0.02;
  const PreparedScene prepared(scene);
  const Volume volume = compute_visibility(PreparedTarget(prepared, target, {kRange}), {kTolerance, 0});
  ASSERT_EQ(volume.outcome, Outcome::computed);
  EXPECT_EQ(measure(volume.mesh).euler, 2);
  const MeshProbe mesh(volume);
  Random random(3482);
  const std::vector<Vec3> points = draw_viewpoints(random, prepared, target, kRange);
  const std::vector<PointAnswer> answers = query_points(PreparedTarget(prepared, target, {kRange}), {}, points);
  int claimed = 0, hidden = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double depth = mesh.depth(points[k]), away = points[k].norm();
    if (depth > 1e-6 * away) {
      ++claimed;
      EXPECT_TRUE(answers[k].inside) << "over-claimed: " << points[k].transpose() << ", " << depth << " m deep";
    }
    hidden += answers[k].blocked_by.empty() ? 0 : 1;
    if (answers[k].margin_m > kTolerance + 1e-5 * away) {
      EXPECT_GT(depth, 0) << "left out: " << points[k].transpose() << ", margin " << answers[k].margin_m;
    }
  }
  EXPECT_GT(claimed, 500);
  EXPECT_GT(hidden, 500);
}

// Their shadows run side by side through the same directions: the tree must not repeat them in every cell.
TEST(ExactDegenerate, AFanOfThousandsOfSheetsAboutAnAxis) {
  Random random(1);
  expect_what_queries_say(sheets(random, 3000, true));
}

TEST(ExactDegenerate, AStarOfThousandsOfSheetsRoundAPoint) {
  Random random(2);
  expect_what_queries_say(sheets(random, 3000, false));
}

}  // namespace
}  // namespace vantage
