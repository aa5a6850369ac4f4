// Small scenes: the engine's volume against the plain union of blockers, and its topology.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include "support/blocker_solids.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::make_box_mesh;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;
using testing::UnionComparison;

void expect_one_closed_piece(const Volume& volume) {
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures m = measure(volume.mesh);
  EXPECT_TRUE(m.closed);
  EXPECT_TRUE(m.oriented);
  EXPECT_EQ(m.euler, 2);
  EXPECT_EQ(m.pieces, 1u);
  EXPECT_GT(m.volume_m3, 0);
  ASSERT_EQ(volume.cause_of.size(), volume.mesh.triangles.size());
  for (const std::uint32_t cause : volume.cause_of) ASSERT_LT(cause, volume.causes.size());
}

/// Computes with a range that holds a box of the given reach and height about the target, and compares inside the box.
UnionComparison expect_union(const Scene& scene, const Target& target, double reach = 40, double height = 40) {
  const TargetFrame frame = make_target_frame(target);
  const double across = 2 * frame.enclosing_radius_m + reach;
  const Sensor sensor{std::sqrt(2 * across * across + height * height) + 1};
  const Volume volume = compute_visibility(PreparedTarget(PreparedScene(scene), target, sensor), {0.2, 0});
  expect_one_closed_piece(volume);
  if (volume.mesh.empty()) return {};
  const UnionComparison c = testing::compare_with_union(scene, volume, testing::local_box(volume.frame, reach, height));
  EXPECT_GT(c.volume, 0);
  EXPECT_LT(c.error(), 1e-6) << c.missing << " m3 missing, " << c.excessive << " m3 too much of " << c.volume << ", "
                             << c.blockers << " blockers";
  return c;
}

Target square(double half_side, const Vec3& centre = Vec3::Zero()) {
  const double s = half_side;
  return target_of(
      {centre + Vec3(-s, -s, 0), centre + Vec3(s, -s, 0), centre + Vec3(s, s, 0), centre + Vec3(-s, s, 0)});
}

Target regular(int corners, double radius, const Vec3& centre, const Vec3& normal = Vec3(0, 0, 1)) {
  const Vec3 n = normal.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  Target target;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    target.parts[0].push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return target;
}

TEST(ExactSmall, AnEmptySceneGivesTheRangeRegion) {
  const Volume volume = compute_visibility(PreparedTarget(PreparedScene{Scene{}}, square(5), {50}), {1e-3, 0});
  expect_one_closed_piece(volume);
  // Four quarters of a half ball about the square's centre, between them what the vertices' balls share: by Monte
  // Carlo's slow brother, a grid.
  double expected = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {  // the tower over each cell reaches up to the nearest of the four spheres
      const double x = (i + 0.5) / n * 50, y = (j + 0.5) / n * 50;
      const double rest = 2500 - (x + 5) * (x + 5) - (y + 5) * (y + 5);
      if (rest > 0) expected += 4 * std::sqrt(rest) * 2500 / (n * n);
    }
  }
  EXPECT_NEAR(enclosed_volume(volume.mesh), expected, 2e-4 * expected);
  ASSERT_EQ(volume.causes.size(), 2u);
}

TEST(ExactSmall, ABoxBesideTheTarget) {
  const Scene scene = SceneBuilder().ground("ground", 60).box("block", {8, -3, 0}, {14, 4, 9});
  expect_union(scene, square(4));
  expect_union(scene, target_of({{-3, -3, 0}, {5, -2, 0}, {0, 4, 0}}));
}

TEST(ExactSmall, AWallOfTwoTrianglesAndOneOfABox) {
  expect_union(SceneBuilder().polygon("sheet", {{6, -8, 0}, {6, 8, 0}, {6, 8, 7}, {6, -8, 7}}), square(4));
  expect_union(SceneBuilder().box("wall", {6, -8, 0}, {6.2, 8, 7}), square(4));
  // A sheet that hangs in the air, askew.
  expect_union(SceneBuilder().polygon("sail", {{3, -5, 6}, {7, 2, 5}, {4, 6, 11}}), square(4));
}

TEST(ExactSmall, AWallOnTheTargetsOutline) {
  expect_union(SceneBuilder().box("wall", {4, -8, 0}, {4.5, 8, 7}), square(4));
  expect_union(SceneBuilder().box("wall", {4, -4, 0}, {4.5, 4, 7}), square(4));
  expect_union(SceneBuilder().box("corner post", {4, 4, 0}, {4.5, 4.5, 7}), square(4));
}

TEST(ExactSmall, APoleBetweenTwoVertices) {
  const Scene scene = SceneBuilder().ground("ground", 60).box("pole", {-0.1, 5, 0}, {0.1, 5.2, 12});
  const UnionComparison c = expect_union(scene, square(4));
  EXPECT_GT(c.blockers, 0u);
  expect_union(SceneBuilder().box("thin pole", {-0.005, 4, 0}, {0.005, 4.01, 12}), square(4));
}

TEST(ExactSmall, ABridgeOverTheTarget) {
  const Scene scene = SceneBuilder()
                          .ground("ground", 60)
                          .box("deck", {-2, -20, 6}, {2, 20, 7})
                          .box("pier", {-2, 10, 0}, {2, 11, 6})
                          .box("pier", {-2, -11, 0}, {2, -10, 6});
  expect_union(scene, square(4));
  expect_union(scene, target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}));  // wholly underneath
}

TEST(ExactSmall, AnLShapedWall) {
  const Scene scene = SceneBuilder()
                          .polygon("long", {{4, -4, 0}, {4, 9, 0}, {4, 9, 5}, {4, -4, 5}})
                          .polygon("short", {{-6, 9, 0}, {4, 9, 0}, {4, 9, 5}, {-6, 9, 5}});
  expect_union(scene, square(3));
  expect_union(scene, square(4));  // touches
}

TEST(ExactSmall, TwoTouchingBoxes) {
  expect_union(SceneBuilder().box("left", {6, -5, 0}, {10, 0, 8}).box("right", {6, 0, 0}, {10, 5, 8}), square(4));
  expect_union(SceneBuilder().box("left", {6, -5, 0}, {10, 0, 8}).box("right", {6, 0, 0}, {10, 5, 5}), square(4));
  expect_union(SceneBuilder().box("low", {6, -5, 0}, {10, 5, 4}).box("high", {7, -4, 4}, {9, 4, 9}), square(4));
  expect_union(SceneBuilder().box("one", {6, -5, 0}, {10, 0, 8}).box("edge to edge", {10, 0, 0}, {12, 6, 8}),
               square(4));
}

TEST(ExactSmall, OverlappingAndDoubledWalls) {
  expect_union(SceneBuilder().box("one", {6, -5, 0}, {10, 1, 8}).box("through it", {7, -2, 0}, {9, 5, 11}), square(4));
  expect_union(SceneBuilder().box("one", {6, -5, 0}, {10, 1, 8}).box("again", {6, -5, 0}, {10, 1, 8}), square(4));
  expect_union(SceneBuilder().box("one", {6, -5, 0}, {10, 1, 8}).box("a hair off", {6.001, -5, 0}, {10.001, 1, 8}),
               square(4));
}

/// A floor, four walls and a ceiling; one wall has a window.
Scene room() {
  return SceneBuilder()
      .ground("floor", 6)
      .polygon("ceiling", {{-6, -6, 5}, {6, -6, 5}, {6, 6, 5}, {-6, 6, 5}})
      .polygon("west", {{-6, -6, 0}, {-6, 6, 0}, {-6, 6, 5}, {-6, -6, 5}})
      .polygon("north", {{-6, 6, 0}, {6, 6, 0}, {6, 6, 5}, {-6, 6, 5}})
      .polygon("south", {{-6, -6, 0}, {6, -6, 0}, {6, -6, 5}, {-6, -6, 5}})
      .polygon("sill", {{6, -6, 0}, {6, 6, 0}, {6, 6, 1}, {6, -6, 1}})
      .polygon("lintel", {{6, -6, 3}, {6, 6, 3}, {6, 6, 5}, {6, -6, 5}})
      .polygon("left", {{6, -6, 1}, {6, -2, 1}, {6, -2, 3}, {6, -6, 3}})
      .polygon("right", {{6, 2, 1}, {6, 6, 1}, {6, 6, 3}, {6, 2, 3}});
}

TEST(ExactSmall, ARoomWithAWindow) {
  const UnionComparison c = expect_union(room(), square(1, {0, 0, 0}));
  EXPECT_GT(c.volume, 12 * 12 * 5);  // the room, and something outside the window
  expect_union(room(), square(1, {3, 1, 0.5}));
}

TEST(ExactSmall, ATargetOnARoof) {
  const Scene scene = SceneBuilder()
                          .ground("ground", 60)
                          .box("house", {-8, -8, 0}, {8, 8, 10})
                          .box("chimney", {5, 5, 10}, {6, 6, 13})
                          .box("parapet", {-8, -8, 10}, {8, -7.8, 11})
                          .box("tower", {12, -6, 0}, {18, 6, 30});
  expect_union(scene, square(4, {0, 0, 10}));
  expect_union(scene, target_of({{-7, -7, 10}, {4, -7, 10}, {0, 7, 10}}));
}

TEST(ExactSmall, ATargetOnAFacade) {
  const Scene scene = SceneBuilder()
                          .ground("ground", 60)
                          .box("house", {-8, 0, 0}, {8, 10, 12})
                          .box("balcony", {-1, -1.5, 6}, {1, 0, 6.2})
                          .box("opposite", {-12, -20, 0}, {3, -10, 8});
  // Counter-clockwise seen from -y, where the street is.
  expect_union(scene, target_of({{2, 0, 2}, {7, 0, 2}, {7, 0, 11}, {2, 0, 11}}));
  expect_union(scene, target_of({{-7, 0, 1}, {-2, 0, 1}, {-4, 0, 9}}));
  expect_union(scene, target_of({{-3, 0, 6.5}, {3, 0, 6.5}, {0, 0, 11}}));  // just above the balcony
  // Down to the ground: the edges of the target, the wall and the street are one line.
  expect_union(scene, target_of({{-8, 0, 0}, {8, 0, 0}, {8, 0, 5}, {-8, 0, 5}}));
}

TEST(ExactSmall, ATiltedTargetOnAPitchedRoof) {
  Mesh house = make_box_mesh({-8, -5, 0}, {8, 5, 6});
  house.vertices[4].y() = house.vertices[5].y() = 0;  // a lean-to roof from (y 0, z 6) ...
  house.vertices[4].z() = house.vertices[5].z() = 9;
  const Scene scene = SceneBuilder()
                          .ground("ground", 60)
                          .add("house", house)
                          .box("chimney", {4, 1.5, 5}, {5, 2.5, 12})
                          .box("neighbour", {-6, 9, 0}, {6, 15, 11});
  // In the plane through (x, 0, 9) and (x, 5, 6): z = 9 - 0.6 y.
  const auto on_roof = [](double x, double y) { return Vec3(x, y, 9 - 0.6 * y); };
  expect_union(scene, target_of({on_roof(-6, 1), on_roof(2, 1), on_roof(2, 4), on_roof(-6, 4)}));
  expect_union(scene, target_of({on_roof(-8, 0), on_roof(4, 1.5), on_roof(0, 5)}));
}

/// The top of a tower whose pointed roof has only two sides: planes of three polygons meet in lines that pass within
/// micrometres of each other.
TEST(ExactSmall, ATowerOfThreePolygons) {
  const Scene scene = SceneBuilder()
                          .polygon("front", {{16, 20, 0}, {21, 20, 0}, {21, 20, 19}, {16, 20, 19}})
                          .polygon("side", {{16, 25, 0}, {16, 20, 0}, {16, 20, 19}, {16, 25, 19}})
                          .polygon("roof", {{16, 25, 19}, {16, 20, 19}, {18.5, 22.5, 25}});
  expect_union(scene, target_of({{-12, -9, 0}, {8, -11, 0}, {11, 0, 0}, {4, 10, 0}, {-13, 8, 0}}), 60, 60);
}

/// Roofs that continue the plane of the target's roof but for micrometres: what they hide is all but flat.
TEST(ExactSmall, SurfacesThatAllButContinueTheTarget) {
  for (const double step : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
    SCOPED_TRACE(step);
    const Scene scene = SceneBuilder()
                            .polygon("roof", {{-20, -8, 0}, {30, -8, step}, {30, 9, 2 * step}, {-20, 9, -step}})
                            .polygon("next", {{30, -8, step}, {60, -8, 0}, {60, 9, 5 * step}, {30, 9, 2 * step}})
                            .polygon("wall", {{30, -8, -9}, {30, 9, -9}, {30, 9, 2 * step}, {30, -8, step}})
                            .box("chimney", {12, 1, -1}, {13, 2, 2});
    expect_union(scene, target_of({{-5, -3, 0}, {4, -4, 0}, {6, 3, 0}, {-4, 5, 0}}), 60, 60);
  }
}

/// Quadrilaterals that are flat only to the noise on their corners, as map coordinates and rounded files have it.
TEST(ExactSmall, HousesThatAreNotQuitePlanar) {
  Random random(53);
  for (const double noise : {0.0, 1e-11, 1e-10, 3e-10, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6, 1e-4}) {
    for (int draw = 0; draw < 6; ++draw) {
      SCOPED_TRACE(noise);
      const double angle = random.uniform(0, 6), w = random.uniform(2, 5), l = random.uniform(3, 9),
                   h = random.uniform(1, 3), top = h + random.uniform(1, 3);
      Mesh house = make_box_mesh({-w, -l, 0}, {w, l, h});
      for (int i = 4; i < 8; ++i) house.vertices[i].z() = h;
      house.vertices.insert(house.vertices.end(), {{0, -l, top}, {0, l, top}});
      const auto corner = [&](double x, double y, double z) {
        for (std::uint32_t i = 0; i < 10; ++i)
          if ((house.vertices[i] - Vec3(x, y, z)).norm() < 1e-9) return i;
        return ~0u;
      };
      const std::uint32_t a = corner(-w, -l, h), b = corner(w, -l, h), c = corner(w, l, h), d = corner(-w, l, h);
      std::erase_if(house.triangles, [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return house.vertices[v].z() == h; });
      });
      house.triangles.insert(house.triangles.end(), {{a, b, 8}, {c, d, 9}, {b, c, 9}, {b, 9, 8}, {d, a, 8}, {d, 8, 9}});
      const Vec3 aside(w + random.uniform(2.5, 5), random.uniform(-3, 3), 0);
      for (Vec3& v : house.vertices) {
        v += aside;
        v = Vec3(std::cos(angle) * v.x() - std::sin(angle) * v.y(), std::sin(angle) * v.x() + std::cos(angle) * v.y(),
                 v.z());
        v += noise * random.direction();
      }
      expect_union(SceneBuilder().ground("ground", 60).add("house", house), square(1.5), 30, 30);
    }
  }
}

/// Ground, or the foot of a wall, within nanometres to micrometres of the target's plane: creases run along the
/// horizon, closer to it than vertices can be told apart.
TEST(ExactSmall, SurfacesThatCreepAboveTheTargetsPlane) {
  Random random(59);
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(draw);
    const double noise = std::pow(10, random.uniform(-9, -4)), turn = random.uniform(0, 6), far = random.uniform(3, 30);
    const Vec3 along(-std::sin(turn), std::cos(turn), 0), foot = far * Vec3(std::cos(turn), std::sin(turn), 0);
    const auto creep = [&] { return Vec3(0, 0, noise * random.uniform(-1, 1)); };
    SceneBuilder scene;
    if (random.chance(0.5)) {
      const double top = random.uniform(1, 9);
      scene.polygon("wall", {foot - 6 * along + creep(), foot + 8 * along + creep(), foot + 8 * along + Vec3(0, 0, top),
                             foot - 6 * along + Vec3(0, 0, top)});
    } else {
      scene.polygon("ground", {Vec3(-60, -60, 0) + creep(), Vec3(60, -60, 0) + creep(), Vec3(0, 60, 0) + creep()});
    }
    Target target = square(0.5);
    const Volume volume = compute_visibility(PreparedTarget(PreparedScene(scene), target, {100}), {0.2, 0});
    expect_one_closed_piece(volume);
    const UnionComparison c = testing::compare_with_union(scene, volume, testing::local_box(volume.frame, 40, 40));
    EXPECT_LT(c.excessive, 1e-6 * c.volume);
    EXPECT_LT(c.missing, 1e-6 * c.volume);
  }
}

/// Whether the points just inside the mesh see the target, by the exact answers of query.
void expect_facets_inside(const PreparedScene& scene, const Target& target, double range) {
  const Volume volume = compute_visibility(PreparedTarget(scene, target, {range}), {});
  if (volume.outcome != Outcome::computed) return;  // something lies on the target
  expect_one_closed_piece(volume);
  std::vector<Vec3> points;
  for (const Triangle& t : volume.mesh.triangles) {
    const auto& v = volume.mesh.vertices;
    const Vec3 middle = (v[t[0]] + v[t[1]] + v[t[2]]) / 3 - volume.frame.origin;
    if (middle.z() > 0) points.push_back(volume.frame.origin + 0.9999 * middle);
  }
  for (const PointAnswer& answer : query_points(PreparedTarget(scene, target, {range}), {}, points))
    ASSERT_TRUE(answer.inside);
}

/// Ranges that leave a lens of millimetres: narrower than the tolerance.
TEST(ExactSmall, RangesJustAboveTheEnclosingCircle) {
  const Scene sheet = SceneBuilder().polygon("sheet", {{0.008148901359986048, 1.1676667727146894, 0.4532033394981615},
                                                       {-0.11990467512319794, 1.3297047607461878, 0.3285000697334644},
                                                       {0.25258728578786044, 1.4828191728465794, 0.00068131965788826}});
  const Target octagon = target_of({{0, 0, 0},
                                    {0.2911541475482512, 0, 0},
                                    {0.9061724748585209, 0.10604688706726838, 0},
                                    {1.4901914043690094, 0.7984737552231782, 0},
                                    {1.4243443277402987, 1.0097348387328369, 0},
                                    {1.3812233898380704, 1.0877195664493833, 0},
                                    {0.39043516170460757, 1.827811970729792, 0},
                                    {-1.809108850798967, 2.03054382393113, 0}});
  expect_facets_inside(PreparedScene(sheet), octagon, 1.7638045549842059);
  Random random(61);
  for (int draw = 0; draw < 40; ++draw) {
    SCOPED_TRACE(draw);
    const Target target = testing::random_target(random, random.integer(3, 9), 2, {0, 0, 0}, {0, 0, 1});
    SceneBuilder scene;
    for (int i = 0; i < 3; ++i) {
      const Vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.001, 0.5));
      scene.polygon("sheet", {at, at + 0.4 * random.direction().cwiseAbs(), at + 0.4 * random.direction().cwiseAbs()});
    }
    const double radius = make_target_frame(target).enclosing_radius_m;
    expect_facets_inside(PreparedScene(scene), target, radius * (1 + std::pow(10, random.uniform(-4, -1))));
  }
}

TEST(ExactSmall, TargetsWithThreeToSixtyFourVertices) {
  const Scene scene =
      SceneBuilder().ground("ground", 60).polygon("sheet", {{6, -3, 0}, {6, 4, 0}, {7, 4, 5}, {7, -3, 5}});
  for (const int corners : {3, 4, 5, 6, 7, 8, 10, 12, 16, 24}) {
    SCOPED_TRACE(corners);
    expect_union(scene, regular(corners, 5, {0, 0, 0}));
  }
}

TEST(ExactSmall, SixtyFourVertices) {
  expect_union(SceneBuilder().polygon("leaf", {{7, -3, 0}, {7, 4, 1}, {6, 1, 5}}), regular(64, 5, {0, 0, 0}));
}

/// Obstacles all round a place 8 m wide.
Scene plaza() {
  return SceneBuilder()
      .ground("ground", 60)
      .box("wall", {8, -6, 0}, {8.5, 7, 5})
      .box("house", {-16, -4, 0}, {-7, 6, 9})
      .box("pole", {-0.1, 4.5, 0}, {0.1, 4.7, 10})
      .polygon("sign", {{2, -7, 3}, {5, -6, 4}, {4, -5, 7}, {1, -6, 6}});
}

TEST(ExactSmall, TargetsFromMetresToMicrometres) {
  for (const double size : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const Vec3& corner : {Vec3(-4, -4, 0), Vec3(4, -4, 0), Vec3(4, 4, 0), Vec3(-4, 4, 0)}) {
      SCOPED_TRACE(size);
      Target target = square(4);
      for (Vec3& v : target.parts[0]) v = corner + size * (v - corner);
      expect_union(plaza(), target, 12, 12);
    }
  }
}

TEST(ExactSmall, ThinTargets) {
  for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    for (const double angle : {0.0, 0.3, 1.1, std::numbers::pi / 2, 2.8}) {
      SCOPED_TRACE(width);
      Target target = square(4);
      for (Vec3& v : target.parts[0]) {
        const double x = v.x(), y = width * v.y();
        v = {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, 0};
      }
      expect_union(plaza(), target, 12, 12);
    }
  }
}

TEST(ExactSmall, SmallTargetsInRandomCities) {
  Random random(47);
  for (int draw = 0; draw < 12; ++draw) {
    SCOPED_TRACE(draw);
    const Scene city = testing::random_city(random, 25, 3);
    const double radius = 2 * std::pow(10, -(draw % 4));
    expect_union(city, testing::random_target(random, random.integer(3, 6), radius, {0, 0, 0}, {0, 0, 1}), 38, 45);
  }
}

TEST(ExactSmall, ABoxInLineWithTheTargetsEdges) {
  const Target facade = target_of({{-3, 0, 0}, {3, 0, 0}, {3, 0, 6}, {-3, 0, 6}});
  expect_union(SceneBuilder().box("block", {6, -7, 0}, {10, -6, 1}), facade, 15, 15);
  const Target gable = target_of({{-3, 0, 0}, {3, 0, 0}, {3, 0, 6}});
  expect_union(SceneBuilder().box("block", {-3, -7, 0}, {-2, -4, 2}), gable, 15, 15);
  expect_union(SceneBuilder().ground("ground", 30).box("block", {-1, -2, 0}, {3, -1, 4}), gable, 15, 15);
}

/// A few blocks on a coarse grid: walls that continue each other, stand on the target's outline or on its line.
TEST(ExactSmall, RandomBlocksOnACoarseGrid) {
  Random random(43);
  int compared = 0, refused = 0;
  double worst = 0;
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(draw);
    SceneBuilder builder;
    if (random.chance(0.5)) builder.ground("ground", 30);
    for (int k = 0; k < random.integer(1, 5); ++k) {
      const Vec3 min(random.integer(-8, 6), random.integer(-8, 6), random.chance(0.7) ? 0 : random.integer(0, 4));
      const Vec3 size(random.integer(1, 4), random.integer(1, 4), random.integer(1, 6));
      builder.box("block " + std::to_string(k), min, min + size);
    }
    Target target = square(random.integer(1, 3), {0, 0, 0});
    if (random.chance(0.3)) target.parts[0].pop_back();
    if (random.chance(0.3))
      for (Vec3& v : target.parts[0]) v = Vec3(v.x(), 0, v.y() + 3);  // upright
    try {
      const UnionComparison c = expect_union(builder, target, 15, 15);
      worst = std::max(worst, c.error());
      ++compared;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::target_pierced) << error.what();
      ++refused;
    }
  }
  std::cout << compared << " compared, worst error " << worst << "; " << refused << " targets were pierced\n";
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace vantage
