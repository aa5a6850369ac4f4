// PointQuery::fractions: what is known by hand, against a plane sweep, and against PointQuery::answer.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/parallel.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/sweep_oracle.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/fraction.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

constexpr std::array kMeasures = {FractionMeasure::area, FractionMeasure::solid_angle, FractionMeasure::pixels};

Target ten_metres() { return target_of({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}); }

std::vector<PointFraction> fractions_of(const Scene& scene, const Target& target, const std::vector<Vec3>& points,
                                        const FractionOptions& options = {}, double range = 100) {
  return PointQuery(PreparedTarget(PreparedScene(scene), target, {range})).fractions(points, options);
}

double fraction_at(const Scene& scene, const Vec3& point, FractionMeasure measure = FractionMeasure::area) {
  return fractions_of(scene, ten_metres(), {point}, {measure})[0].fraction;
}

/// Horizontal, from (x0, y0) to (x1, y1).
std::vector<Vec3> plate(double x0, double y0, double x1, double y1, double z) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

double area_of(const std::vector<Vec3>& ring) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
  return 0.5 * sum.norm();
}

double area_of(const std::vector<SeenPolygon>& polygons) {
  double sum = 0;
  for (const SeenPolygon& polygon : polygons) {
    sum += area_of(polygon.outer);
    for (const auto& hole : polygon.holes) sum -= area_of(hole);
  }
  return sum;
}

/// Of a rectangle a x b with a corner below the eye, h under it.
double angle_of_quarter(double a, double b, double h) {
  return std::atan(a * b / (h * std::sqrt(a * a + b * b + h * h)));
}

TEST(Fraction, OfHalfATarget) {
  SceneBuilder scene;
  scene.ground("ground", 50, -1).polygon("plate", plate(0, -20, 20, 20, 10));
  for (const FractionMeasure measure : kMeasures) {
    EXPECT_NEAR(fraction_at(scene, {0, 0, 20}, measure), 0.5, 1e-14) << name_of(measure);
    EXPECT_EQ(fraction_at(scene, {0, 0, 9}, measure), 1) << "under the plate";
    EXPECT_EQ(fraction_at(scene, {10, 0, 15}, measure), 0) << "over it";
    EXPECT_EQ(fraction_at(scene, {-10, 0, 20}, measure), 1);
  }
}

TEST(Fraction, OfAHoleByEachMeasure) {
  SceneBuilder scene;
  scene.ground("ground", 50, -1).polygon("plate", plate(-1, -1, 1, 1, 10));  // its shadow is four times as large
  const Vec3 eye(0, 0, 20);
  EXPECT_NEAR(fraction_at(scene, eye, FractionMeasure::area), 1 - 0.16, 1e-14);
  EXPECT_NEAR(fraction_at(scene, eye, FractionMeasure::pixels), 1 - 0.16, 1e-14) << "the image is parallel to it";
  EXPECT_NEAR(fraction_at(scene, eye, FractionMeasure::solid_angle),
              1 - angle_of_quarter(2, 2, 20) / angle_of_quarter(5, 5, 20), 1e-14);
  const auto answer = fractions_of(scene, ten_metres(), {eye}, {FractionMeasure::area, true})[0];
  ASSERT_EQ(answer.seen.size(), 1U);
  EXPECT_EQ(answer.seen[0].outer.size(), 4U);
  ASSERT_EQ(answer.seen[0].holes.size(), 1U);
  EXPECT_EQ(answer.seen[0].holes[0].size(), 4U);
  EXPECT_NEAR(area_of(answer.seen), 84, 1e-9);
}

// The part of a wall that is as high as the eye, or higher, hides what it hides by its lower part; what is behind the
// eye hides nothing, though the lines from it through the eye meet the target.
TEST(Fraction, OfWhatReachesAboveAndBehindTheEye) {
  for (const double top : {6.0, 10.0, 10.5, 40.0, 1e6}) {
    SceneBuilder scene;
    scene.polygon("wall", {{10, -50, 4}, {10, 50, 4}, {10, 50, top}, {10, -50, top}});
    const double from = 20 - 10 * 10.0 / (10 - 4);  // of the shadow, from an eye at 20, 10 m high
    EXPECT_NEAR(fraction_at(scene, {20, 0, 10}), (5 - from) / 10, 1e-13) << top;
  }
  SceneBuilder behind;
  behind.polygon("wall", {{30, -50, 1}, {30, 50, 1}, {30, 50, 90}, {30, -50, 90}})
      .polygon("roof", plate(-40, -40, 40, 40, 31))
      .polygon("slope", {{21, -9, 9}, {21, 9, 9}, {45, 9, 60}, {45, -9, 60}});
  for (const FractionMeasure measure : kMeasures) EXPECT_EQ(fraction_at(behind, {20, 0, 10}, measure), 1);
  // Reaches from before the eye, by its side, to behind it: with its straight extension it would hide other parts.
  SceneBuilder beside;
  beside.polygon("wall", {{30, 1, 0.5}, {30, 1, 30}, {-30, 1, 30}, {-30, 1, 0.5}});
  const double y = 1 * 10 / (10 - 0.5);  // of the shadow of its lower side
  EXPECT_NEAR(fraction_at(beside, {0, 0, 10}), (5 + y) / 10, 1e-13);
}

TEST(Fraction, IsNothingFromTheBackAndFromThePlane) {
  SceneBuilder scene;
  scene.polygon("plate", plate(20, 20, 30, 30, 10));
  for (const FractionMeasure measure : kMeasures) {
    for (const Vec3& point : {Vec3(0, 0, -3), Vec3(0, 0, 0), Vec3(3, 2, 0), Vec3(50, 0, 0), Vec3(1, 1, -1e155)}) {
      EXPECT_EQ(fraction_at(scene, point, measure), 0) << point.transpose();
    }
  }
}

TEST(Fraction, RangeAndLimitsPlayNoRole) {
  SceneBuilder scene;
  scene.polygon("plate", plate(0, -2000, 2000, 2000, 1000));
  Navigation low;
  low.altitude = {0, 5};
  PointQuery query(PreparedTarget(PreparedScene(scene), ten_metres(), {10}), low);
  const std::vector<Vec3> points = {{-30, 0, 500}, {0, 0, 2000}};
  const auto fractions = query.fractions(points);
  EXPECT_EQ(fractions[0].fraction, 1);
  EXPECT_NEAR(fractions[1].fraction, 0.5, 1e-12);
  EXPECT_FALSE(query.answer(points)[0].inside);
}

TEST(Fraction, OnAndInsideBlockers) {
  SceneBuilder scene;
  scene.box("house", {8, -5, 0}, {18, 5, 12}).ground("ground", 100, -0.5);
  EXPECT_EQ(fraction_at(scene, {12, 0, 6}), 0) << "inside";
  EXPECT_EQ(fraction_at(scene, {8, 0, 6}), 1) << "on the wall that faces the target";
  EXPECT_EQ(fraction_at(scene, {8, 0, 12}), 1) << "on the edge of the roof";
  EXPECT_EQ(fraction_at(scene, {18, 0, 6}), 0) << "on the wall behind";
  EXPECT_EQ(fraction_at(scene, {8, 20, 6}), 1) << "in the plane of a wall";
  EXPECT_EQ(fraction_at(scene, {8, 5, 12}), 1) << "on a corner";
}

TEST(Fraction, OfASinglePointIsAllOrNothing) {
  SceneBuilder scene;
  scene.polygon("plate", plate(-1, -1, 1, 1, 10));
  for (const FractionMeasure measure : kMeasures) {
    const auto answers = fractions_of(scene, Target::point({0, 0, 4}),
                                      {{0, 0, 20}, {8, 0, 20}, {0, 0, -20}, {0, 0, 4}, {2, 0, 4}}, {measure, true});
    EXPECT_EQ(answers[0].fraction, 0);
    for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_EQ(answers[i].fraction, 1) << i;
    EXPECT_TRUE(answers[1].seen.empty());
  }
}

TEST(Fraction, PartsAddUp) {
  SceneBuilder scene;
  scene.polygon("plate", plate(0, -20, 20, 20, 10)).ground("ground", 60, -1);
  Target two;  // the second is vertical and looks to +x
  two.parts = {{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}},
               {{-20, -5, 5}, {-20, 5, 5}, {-20, 5, 15}, {-20, -5, 15}}};
  const PreparedTarget prepared(PreparedScene(scene), two, {100});
  for (const FractionMeasure measure : kMeasures) {
    const auto at = [&](const Vec3& point) { return PointQuery(prepared).fractions({&point, 1}, {measure, true})[0]; };
    EXPECT_EQ(at({-10, 0, 20}).fraction, 1);
    EXPECT_EQ(at({-10, 0, 20}).seen.size(), 2U);
    EXPECT_EQ(at({-30, 0, -2}).fraction, 0) << "behind both";
    const double one = at({-30, 0, 20}).fraction;  // behind the second
    EXPECT_GT(one, 0);
    EXPECT_LT(one, 1);
    EXPECT_LT(at({-20, 0, 20}).fraction, 1) << "in the plane of the second";
  }
  EXPECT_NEAR(PointQuery(prepared).fractions(std::vector{Vec3(0, 0, 20)})[0].fraction, 0.75, 1e-14);
}

TEST(Fraction, IsMeasuredHoweverFarAway) {
  SceneBuilder scene;
  scene.polygon("plate", plate(0, -20, 20, 20, 10));
  for (const double far : {1e3, 1e6, 1e9, 1e15, 1e29, 1e31, 1e140, 1e160, 1e308}) {
    for (const FractionMeasure measure : kMeasures) {
      EXPECT_NEAR(fraction_at(scene, {0, 0, far}, measure), 0.5, 1e-6) << far << " " << name_of(measure);
      EXPECT_EQ(fraction_at(scene, {-far, 0, far}, measure), 1) << far;
      // At 45 degrees the plate's border is thrown 10 m aside.
      EXPECT_EQ(fraction_at(scene, {far, 0, far}, measure), 0) << far;
    }
  }
  EXPECT_GE(fraction_at(scene, {1.7e308, 1.7e308, 1.7e308}), 0);
}

TEST(Fraction, RefusesPointsThatAreNotNumbers) {
  testing::expect_error(
      [] {
        fraction_at(SceneBuilder().ground("ground", 9, -1), {0, 0, NAN});
      },
      ErrorCode::coordinate_not_finite, "point 0");
}

TEST(Fraction, NamesOfMeasures) {
  for (const FractionMeasure measure : kMeasures) EXPECT_EQ(fraction_measure(name_of(measure)), measure);
  EXPECT_FALSE(fraction_measure("areas"));
}

/// Triangles over and about a target at the origin that they do not pierce: in the air, on the ground, through the
/// ground, near the eyes and behind them; fans that share edges, doubled ones, some in one plane, needles.
Scene clutter(Random& random, int count, double scale, const Vec3& at) {
  SceneBuilder builder;
  const auto place = [&](const Vec3& v) { return Vec3(at + scale * v); };
  for (int i = 0; i < count; ++i) {
    Vec3 o(random.uniform(-18, 18), random.uniform(-18, 18), random.uniform(1, 30));
    const double size = random.chance(0.2) ? 40 : random.uniform(0.2, 6);
    Vec3 a = o + size * random.point(-1, 1), b = o + size * random.point(-1, 1);
    if (random.chance(0.2)) b = a + 1e-7 * random.point(-1, 1);
    if (random.chance(0.2)) a.z() = b.z() = o.z();
    if (random.chance(0.15)) {  // a wall outside of the target, from under the ground
      o = 30 * random.direction();
      o.z() = -1;
      const Vec3 side = Vec3(-o.y(), o.x(), 0).normalized() * random.uniform(1, 9);
      a = o + side;
      b = o + Vec3(0, 0, random.uniform(2, 30));
      if (o.head<2>().norm() < 12) continue;
    }
    const auto low = [](const Vec3& v) { return v.z() < 0.5; };
    if (o.z() > 0 && (low(a) || low(b) || low(o))) continue;
    const Vec3 across = a + b - o;
    if (o.z() > 0 && random.chance(0.3) && !low(across)) {  // one polygon of two triangles
      builder.polygon("t", {place(o), place(a), place(across), place(b)});
      continue;
    }
    builder.polygon("t", {place(o), place(a), place(b)});
    if (random.chance(0.3)) {  // shares an edge
      const Vec3 c = random.chance(0.5) ? across : Vec3(a + size * random.point(-1, 1));
      if (!low(c) && o.z() > 0) builder.polygon("t", {place(b), place(a), place(c)});
    }
    if (random.chance(0.1)) builder.polygon("t", {place(a), place(b), place(o)});
  }
  return builder;
}

/// Twelve a scene: anywhere, every sixth in the plane of a polygon of the scene beside it, and the one after it
/// micrometres to decimetres over the target's plane.
std::vector<Vec3> eyes_about(Random& random, const Scene& scene, double scale, const Vec3& at) {
  std::vector<Vec3> eyes;
  for (int i = 0; i < 12; ++i) {
    Vec3 eye(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(0.3, 35));
    if (i % 4 == 0) eye *= 3;
    if (i % 6 == 5) eye.z() = std::pow(10.0, random.uniform(-6, -1));
    eyes.emplace_back(at + scale * eye);
    if (i % 6 != 4 || scene.mesh.empty()) continue;
    const Triangle& t = scene.mesh.triangles[static_cast<std::size_t>(i) % scene.mesh.triangles.size()];
    const Vec3 &a = scene.mesh.vertices[t[0]], &b = scene.mesh.vertices[t[1]], &c = scene.mesh.vertices[t[2]];
    const Vec3 beside = a + random.uniform(2.2, 3) * (random.uniform(0, 1) * (b - c) + c - a);
    if ((beside - at).z() > 0.3 * scale) eyes.back() = beside;
  }
  return eyes;
}

/// Seen from micrometres over its plane, from far aside, borders are uncertain by more than elsewhere; and the closed
/// forms of the sweep's solid angle cancel. From a point in the plane of a needle, on its axis, the rounding of the
/// point decides which way the needle's sides run.
double allowed_difference(std::size_t eye) {
  if (eye % 6 == 4) return 1e-6;
  return eye % 6 == 5 ? 1e-9 : 1e-12;
}

double swept_fraction(const testing::SweptFraction& swept, FractionMeasure measure) {
  if (measure == FractionMeasure::area) return static_cast<double>(swept.seen.area / swept.all.area);
  if (measure == FractionMeasure::pixels) return static_cast<double>(swept.seen.pixels / swept.all.pixels);
  return static_cast<double>(swept.seen.solid_angle / swept.all.solid_angle);
}

class FractionAtScale : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(FractionAtScale, IsThatOfAPlaneSweep) {
  const auto [scale, shift] = GetParam();
  const Vec3 at(shift, -shift, shift / 1e4);
  Random random(20261122);
  double worst = 0;
  int partly = 0, none = 0, all = 0;
  for (int round = 0; round < 200; ++round) {
    const int corners = random.integer(3, 7);
    const Target target = testing::random_target(random, corners, 6 * scale, at, {0, 0, 1});
    const Scene scene = clutter(random, random.integer(1, 30), scale, at);
    const PreparedTarget prepared(PreparedScene(scene), target, {200 * scale});
    const testing::SweepOracle oracle(scene.mesh, prepared.frame());
    const std::vector<Vec3> eyes = eyes_about(random, scene, scale, at);
    std::vector<testing::SweptFraction> swept;
    for (const Vec3& eye : eyes) swept.push_back(oracle.look_from(eye));
    PointQuery query(prepared);
    for (const FractionMeasure measure : kMeasures) {
      const auto answers = query.fractions(eyes, {measure});
      for (std::size_t i = 0; i < eyes.size(); ++i) {
        const double fraction = answers[i].fraction, expected = swept_fraction(swept[i], measure);
        EXPECT_NEAR(fraction, expected, allowed_difference(i))
            << name_of(measure) << " of round " << round << ", eye " << i;
        if (i % 6 < 4) worst = std::max(worst, std::abs(fraction - expected));
        if (measure != FractionMeasure::area) continue;
        partly += fraction > 0 && fraction < 1;
        none += fraction == 0;
        all += fraction == 1;
      }
    }
  }
  std::cout << "worst difference " << worst << "; partly seen " << partly << ", not at all " << none << ", whole "
            << all << "\n";
  EXPECT_GT(partly, 300);
  EXPECT_GT(none, 20);
  EXPECT_GT(all, 500);
}

// 1 where nothing is named that hides some of the target, and nowhere else; the polygons have the same area; no answer
// depends on what was asked before.
TEST_P(FractionAtScale, AgreesWithTheAnswers) {
  const auto [scale, shift] = GetParam();
  const Vec3 at(shift, -shift, shift / 1e4);
  Random random(20261123);
  int whole = 0, partly = 0;
  for (int round = 0; round < 12; ++round) {
    const Target target = testing::random_target(random, random.integer(3, 9), 6 * scale, at, {0, 0, 1});
    const Scene scene = clutter(random, 60, scale, at);
    const PreparedTarget prepared(PreparedScene(scene), target, {80 * scale});
    std::vector<Vec3> eyes;
    for (int i = 0; i < 150; ++i) {
      Vec3 eye(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-2, 40));
      if (i % 5 == 0) eye.z() = std::pow(10.0, random.uniform(-9, 0));
      if (i % 5 == 1) eye *= 10;
      if (i % 5 == 2) {  // on a triangle, and in its plane beside it
        const Triangle& t = scene.mesh.triangles[static_cast<std::size_t>(i) % scene.mesh.triangles.size()];
        const double s = random.uniform(0, 1.5);
        eyes.emplace_back(scene.mesh.vertices[t[0]] * (1 - s) +
                          s * 0.5 * (scene.mesh.vertices[t[1]] + scene.mesh.vertices[t[2]]));
        continue;
      }
      eyes.emplace_back(at + scale * eye);
    }
    PointQuery query(prepared);
    const auto answers = query.answer(eyes);
    const double area = area_of([&] {
      std::vector<Vec3> ring;
      for (const auto& t : prepared.frame().polygon) ring.emplace_back(t.x(), t.y(), 0);
      return ring;
    }());
    for (const FractionMeasure measure : kMeasures) {
      const auto fractions = query.fractions(eyes, {measure, true});
      for (std::size_t i = 0; i < eyes.size(); ++i) {
        const bool is_seen = answers[i].blocked_by.empty() && !answers[i].behind_target;
        EXPECT_EQ(fractions[i].fraction == 1, is_seen) << eyes[i].transpose() << " " << fractions[i].fraction;
        EXPECT_GE(fractions[i].fraction, 0);
        EXPECT_LE(fractions[i].fraction, 1);
        EXPECT_EQ(fractions[i].fraction, PointQuery(prepared).fractions({&eyes[i], 1}, {measure})[0].fraction);
        if (measure != FractionMeasure::area) continue;
        EXPECT_NEAR(area_of(fractions[i].seen) / area, fractions[i].fraction, 1e-7 + 1e-9 * shift / scale);
        whole += is_seen;
        partly += fractions[i].fraction > 0 && !is_seen;
      }
    }
  }
  EXPECT_GT(whole, 100);
  EXPECT_GT(partly, 100);
}

INSTANTIATE_TEST_SUITE_P(Scales, FractionAtScale,
                         ::testing::Values(std::tuple(1e-3, 0.0), std::tuple(0.1, 0.0), std::tuple(1.0, 0.0),
                                           std::tuple(100.0, 0.0), std::tuple(1e4, 0.0), std::tuple(1.0, 5e6),
                                           std::tuple(100.0, 5e6)));

TEST(Fraction, ThreadsChangeNoBit) {
  Random random(11);
  const Scene scene = clutter(random, 80, 1, Vec3::Zero());
  std::vector<Vec3> eyes;
  for (int i = 0; i < 3000; ++i) eyes.emplace_back(random.uniform(-40, 40), random.uniform(-40, 40), i % 40);
  std::vector<std::vector<PointFraction>> fractions;
  for (const int threads : {1, 4}) {
    parallel::with_threads(threads, [&] {
      fractions.push_back(fractions_of(scene, ten_metres(), eyes, {FractionMeasure::solid_angle, true}));
    });
  }
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    EXPECT_EQ(fractions[0][i].fraction, fractions[1][i].fraction);
    ASSERT_EQ(fractions[0][i].seen.size(), fractions[1][i].seen.size());
    for (std::size_t k = 0; k < fractions[0][i].seen.size(); ++k) {
      EXPECT_EQ(fractions[0][i].seen[k].outer, fractions[1][i].seen[k].outer);
    }
  }
}

// The rings against single lines of sight.
TEST(Fraction, PolygonsHoldWhatIsSeen) {
  Random random(12);
  const auto crossings = [](const std::vector<Vec3>& ring, const Vec3& t) {
    int count = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > t.y()) == (b.y() > t.y())) continue;
      count += t.x() < a.x() + (t.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    }
    return count;
  };
  int holes = 0, several = 0, dark = 0;
  for (int round = 0; round < 100; ++round) {
    const Scene scene = clutter(random, 60, 1, Vec3::Zero());
    const Vec3 eye(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(20, 60));
    const PreparedTarget prepared(PreparedScene(scene), ten_metres(), {100});
    const auto answer = PointQuery(prepared).fractions({&eye, 1}, {FractionMeasure::area, true})[0];
    several += answer.seen.size() > 1;
    for (const SeenPolygon& polygon : answer.seen) holes += static_cast<int>(polygon.holes.size());
    for (int i = 0; i < 300; ++i) {
      const Vec3 t(random.uniform(-5, 5), random.uniform(-5, 5), 0), off = t - eye;
      bool is_hidden = false;
      for (const Triangle& triangle : scene.mesh.triangles) {
        const Vec3 a = scene.mesh.vertices[triangle[0]] - eye, b = scene.mesh.vertices[triangle[1]] - eye,
                   c = scene.mesh.vertices[triangle[2]] - eye;
        const double u = a.cross(b).dot(off), v = b.cross(c).dot(off), w = c.cross(a).dot(off),
                     volume = a.cross(b).dot(c);
        const double along = (b - a).cross(c - a).dot(off) / volume;  // in triangles' distances
        is_hidden = is_hidden || ((u > 0) == (v > 0) && (v > 0) == (w > 0) && along > 1);
      }
      int count = 0;
      for (const SeenPolygon& polygon : answer.seen) {
        int inside = crossings(polygon.outer, t);
        for (const auto& hole : polygon.holes) inside += crossings(hole, t);
        count += inside % 2;
      }
      EXPECT_EQ(count, is_hidden ? 0 : 1) << "round " << round << " at " << t.transpose();
      dark += is_hidden;
    }
  }
  EXPECT_GT(holes, 10);
  EXPECT_GT(several, 10);
  EXPECT_GT(dark, 1000);
}

}  // namespace
}  // namespace vantage
