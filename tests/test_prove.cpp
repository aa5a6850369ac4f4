// The proof of volumes: right ones are proved, and whatever claims too much is refuted with a witness.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/exact_crossings.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::code_of;
using testing::expect_code;
using testing::Random;
using testing::random_city;
using testing::random_target;

Mesh scaled_about(Mesh mesh, const Vec3& centre, double by) {
  for (Vec3& vertex : mesh.vertices) vertex = centre + by * (vertex - centre);
  return mesh;
}

/// A city with a target in a clearing, and its volume.
struct CityVolume {
  explicit CityVolume(std::uint64_t seed, int blocks = 30) : random(seed), scene(random_city(random, blocks, 12)) {
    target = random_target(random, 5, 2, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
    const PreparedTarget prepared(PreparedScene(scene), target, sensor);
    volume = compute_volume(prepared);
  }
  ProofReport prove(const Mesh& mesh, const ProveOptions& options = {}) const {
    return prove_volume(scene, target, sensor, {}, mesh, options);
  }

  Random random;
  Scene scene;
  Target target;
  Sensor sensor{.max_range_m = 80};
  Volume volume;
};

bool crosses(const Scene& scene, const HiddenView& view) {
  const Triangle& t = scene.mesh.triangles[view.triangle];
  const Vec3 &a = scene.mesh.vertices[t[0]], &b = scene.mesh.vertices[t[1]], &c = scene.mesh.vertices[t[2]];
  const Vec3 way = view.target_point - view.viewpoint, normal = (b - a).cross(c - a);
  const double at = normal.dot(a - view.viewpoint) / normal.dot(way);
  const Vec3 place = view.viewpoint + at * way;
  const auto side = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(place - from)) > 0; };
  return at > 0 && at < 1 && side(a, b) && side(b, c) && side(c, a);
}

TEST(Prove, VolumesOfRandomCitiesAreProved) {
  for (std::uint64_t seed = 81; seed < 89; ++seed) {
    const CityVolume city(seed);
    ASSERT_FALSE(city.volume.empty()) << city.volume.reason;
    const ProofReport report = city.prove(city.volume.mesh);
    EXPECT_EQ(report.verdict(), ProofVerdict::proved) << "seed " << seed << ": " << report.unproved.size() << " facets";
    EXPECT_TRUE(report.unproved.empty());
    EXPECT_FALSE(report.witness);
    EXPECT_GT(report.tested_facets, 0.9 * static_cast<double>(report.facets));
    EXPECT_GT(report.separations, 0u);
  }
}

/// Twice the part that the proof leaves out: refuted, by a place from which a point of the target is hidden.
TEST(Prove, AVolumeThatIsAMillionthTooLargeIsRefuted) {
  for (std::uint64_t seed = 81; seed < 85; ++seed) {
    const CityVolume city(seed);
    const ProofReport report = city.prove(scaled_about(city.volume.mesh, city.volume.frame.origin, 1.000002));
    EXPECT_EQ(report.claims[0].verdict, ProofVerdict::wrong) << "seed " << seed;
    ASSERT_TRUE(report.witness);
    EXPECT_TRUE(crosses(city.scene, *report.witness));
    EXPECT_FALSE(report.witness->object.empty());
    EXPECT_TRUE(std::find(report.unproved.begin(), report.unproved.end(), report.witness->facet) !=
                report.unproved.end());
  }
}

/// The volume that is computed without an obstacle which bounds it claims what that one hides.
TEST(Prove, AVolumeThatForgotAnObstacleIsRefuted) {
  const CityVolume city(90);
  std::uint32_t dropped = 0;
  double most = 0;
  for (const Cause& cause : city.volume.causes) {
    if (!cause.object || cause.name == "ground" || cause.area_m2 <= most) continue;
    most = cause.area_m2;
    dropped = *cause.object;
  }
  ASSERT_GT(most, 0);
  Scene less = city.scene;
  less.mesh.triangles.clear();
  less.object_of.clear();
  for (std::size_t t = 0; t < city.scene.mesh.triangles.size(); ++t) {
    if (city.scene.object_of[t] == dropped) continue;
    less.mesh.triangles.push_back(city.scene.mesh.triangles[t]);
    less.object_of.push_back(city.scene.object_of[t]);
  }
  const Volume more = compute_volume(PreparedTarget(PreparedScene(less), city.target, city.sensor));
  const ProofReport report = city.prove(more.mesh);
  EXPECT_EQ(report.verdict(), ProofVerdict::wrong);
  ASSERT_TRUE(report.witness);
  EXPECT_TRUE(crosses(city.scene, *report.witness));
  EXPECT_EQ(report.witness->object, city.scene.objects[dropped].name);
  EXPECT_GT(report.witness->depth_m, 0.01);
  EXPECT_GT(report.unproved_area_share, 0);
}

TEST(Prove, CutVolumesAreProvedWithTheirLimits) {
  const CityVolume city(91);
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{10, 40};
  navigation.keep_out = {Box{{-5, -5, 15}, {5, 5, 20}}};
  const Volume cut = cut_to_navigation(city.volume, navigation);
  ProofReport report = prove_volume(city.scene, city.target, city.sensor, navigation, cut.mesh);
  EXPECT_EQ(report.claims[0].verdict, ProofVerdict::proved);
  EXPECT_EQ(report.verdict(), ProofVerdict::proved);
  EXPECT_EQ(report.claims.size(), 5u);
  navigation.altitude = Navigation::Altitude{10, 39.9};
  report = prove_volume(city.scene, city.target, city.sensor, navigation, cut.mesh);
  EXPECT_EQ(report.verdict(), ProofVerdict::wrong);
}

TEST(Prove, RangeAndFrontAreClaimsToo) {
  CityVolume city(92, 0);
  EXPECT_EQ(city.prove(city.volume.mesh).verdict(), ProofVerdict::proved);
  city.sensor.max_range_m = 79.9;
  EXPECT_EQ(city.prove(city.volume.mesh).claims[1].verdict, ProofVerdict::wrong);
  city.sensor.max_range_m = 80;
  Mesh lowered = city.volume.mesh;
  for (Vec3& vertex : lowered.vertices) vertex.z() -= 1;
  EXPECT_EQ(city.prove(lowered).claims[2].verdict, ProofVerdict::wrong);
}

/// As a file of single-precision numbers has it: what it says that these moved is allowed, and no more.
TEST(Prove, AllowsWhatAFileSaysItRounded) {
  const CityVolume city(91);
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{10.2, 40.2};
  Mesh rounded = cut_to_navigation(city.volume, navigation).mesh;
  double moved = 0;
  for (Vec3& vertex : rounded.vertices) {
    const Vec3 was = vertex;
    vertex = vertex.cast<float>().cast<double>();
    moved = std::max(moved, (vertex - was).norm());
  }
  const auto verdict = [&](double rounding_m) {
    const ProveOptions options{.rounding_m = rounding_m};
    return prove_volume(city.scene, city.target, city.sensor, navigation, rounded, options).claims[3].verdict;
  };
  EXPECT_EQ(verdict(moved), ProofVerdict::proved);
  EXPECT_EQ(verdict(0), ProofVerdict::wrong);
  EXPECT_EQ(code_of([&] { verdict(-1); }), ErrorCode::value_out_of_range);
}

/// What rounding moved along the view hides far more of it than that: still nothing is wrong for sure.
TEST(Prove, CallsNothingWrongForWhatAFileRounded) {
  for (std::uint64_t seed = 110; seed < 112; ++seed) {
    const CityVolume city(seed);
    Random random(seed);
    const auto verdict = [&](double moved_m) {
      Mesh moved = city.volume.mesh;
      for (Vec3& vertex : moved.vertices) vertex += moved_m * random.direction();
      const ProveOptions options{.shrink = 0, .rounding_m = 1.5e-5};
      return prove_volume(city.scene, city.target, city.sensor, {}, moved, options).claims[0].verdict;
    };
    EXPECT_NE(verdict(1.4e-5), ProofVerdict::wrong);
    EXPECT_EQ(verdict(1e-2), ProofVerdict::wrong);
  }
}

TEST(Prove, AllPartsMustBeSeen) {
  CityVolume city(93);
  const Target first = city.target;
  city.target.parts.push_back({{6, 0, 0.5}, {8, 0, 0.5}, {7, 2, 0.5}});
  EXPECT_EQ(city.prove(city.volume.mesh).verdict(), ProofVerdict::wrong);
  const Volume both = compute_volume(PreparedTarget(PreparedScene(city.scene), city.target, city.sensor));
  EXPECT_EQ(city.prove(both.mesh).verdict(), ProofVerdict::proved);
}

TEST(Prove, APointThatIsSeenFromAllSides) {
  CityVolume city(94);
  city.target = Target::point({0, 0, 6});
  const Volume round = compute_volume(PreparedTarget(PreparedScene(city.scene), city.target, city.sensor));
  EXPECT_EQ(city.prove(round.mesh).verdict(), ProofVerdict::proved);
  EXPECT_EQ(city.prove(scaled_about(round.mesh, Vec3(0, 0, 6), 1.00001)).verdict(), ProofVerdict::wrong);
}

TEST(Prove, TheSameOnOneThreadAndWithVerticesApart) {
  const CityVolume city(95);
  Mesh soup;
  for (const Triangle& t : city.volume.mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(city.volume.mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const ProofReport a = city.prove(city.volume.mesh), b = city.prove(soup);
  EXPECT_EQ(a.verdict(), ProofVerdict::proved);
  EXPECT_EQ(b.verdict(), ProofVerdict::proved);
  EXPECT_EQ(a.tested_facets, b.tested_facets);
}

/// A face that rises by a hair from the target's plane: the views along it and the face are apart by less than what
/// doubles lose.
TEST(Prove, ViewsAlongAFaceThatIsNearlyInThePlaneOfTheTarget) {
  Random random(98);
  for (int i = 0; i < 4; ++i) {
    CityVolume city(98, 0);
    city.sensor.max_range_m = 110;
    const double rise = std::pow(10.0, random.uniform(-4.6, -4.3));
    const Vec3 at(random.uniform(100, 600), random.uniform(-600, -100), 21.47289);
    const Eigen::Matrix3d tilt = Eigen::AngleAxisd(random.uniform(0.1, 0.4), random.direction()).toRotationMatrix();
    const auto place = [&](double x, double y, double z) { return Vec3(at + tilt * Vec3(x, y, z)); };
    Mesh& mesh = city.scene.mesh;
    mesh.vertices = {place(-8, -21, 0), place(-8.2, 43, rise), place(20, 52, 0), place(-30, -25, -6)};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
    city.scene.object_of = {0, 0};
    city.target = Target::polygon({place(-2, -2, 0), place(2, -2.1, 0), place(1.9, 2, 0), place(-1.2, 1, 0)});
    const PreparedTarget prepared(PreparedScene(city.scene), city.target, city.sensor);
    const Volume volume = compute_volume(prepared);
    const ProveOptions options{.lift_m = volume.lift_m};
    const ProofReport report = city.prove(volume.mesh, options);
    EXPECT_EQ(report.verdict(), ProofVerdict::proved) << rise << ": " << report.unproved.size() << " facets";
    EXPECT_NE(city.prove(scaled_about(volume.mesh, volume.frame.origin, 1.000002), options).verdict(),
              ProofVerdict::proved);
  }
}

/// Winds round -1 times behind a wall: a line of sight leaves it by facets that face the target.
TEST(Prove, APartThatIsInsideOutIsJudgedToo) {
  const Scene scene = testing::SceneBuilder().box("wall", {10, -6, 0}, {11, 6, 9});
  const Target target = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const Sensor sensor{.max_range_m = 50};
  const auto verdict = [&](double tip_x) {
    Mesh mesh = testing::make_box_mesh({-3, -3, 1}, {3, 3, 6});
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {Vec3(3, 3, 1), Vec3(tip_x, 1, 2), Vec3(tip_x, 3, 2), Vec3(tip_x, 2, 3)});
    for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{1, 3, 2}}) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    for (std::size_t t = mesh.triangles.size() - 4; t < mesh.triangles.size(); ++t) {
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    }
    const ProofReport turned = prove_volume(scene, target, sensor, {}, mesh);
    for (std::size_t t = mesh.triangles.size() - 4; t < mesh.triangles.size(); ++t) {
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    }
    const ProofReport outward = prove_volume(scene, target, sensor, {}, mesh);
    EXPECT_EQ(turned.verdict(), outward.verdict());
    return turned.verdict();
  };
  EXPECT_EQ(verdict(9), ProofVerdict::proved);
  EXPECT_EQ(verdict(20), ProofVerdict::wrong);
}

/// A wire of no width hides nothing: the methods leave it out.
TEST(Prove, ATriangleWithoutAreaHidesNothing) {
  const Scene scene =
      testing::SceneBuilder().ground("ground", 60).polygon("wire", {{-7, -2, 5}, {-1, -5, 5}, {-4, -3.5, 5}});
  const Target target = testing::target_of({{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}});
  const Sensor sensor{.max_range_m = 20};
  const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor));
  const ProofReport report = prove_volume(scene, target, sensor, {}, volume.mesh, {.maximal = true});
  EXPECT_EQ(report.verdict(), ProofVerdict::proved);
  EXPECT_EQ(report.maximal->proved_share, 1);
}

TEST(Prove, ARangeBelowWhatDoublesCanSquare) {
  for (const double range : {1e-20, 1e-40, 1e-60}) {
    const Mesh volume = testing::make_box_mesh(Vec3::Constant(0.1 * range), Vec3::Constant(0.5 * range));
    Mesh large = volume;
    for (Vec3& vertex : large.vertices) vertex *= 1e4;
    const Sensor sensor{.max_range_m = range};
    EXPECT_EQ(prove_volume({}, Target::point({0, 0, 0}), sensor, {}, volume).verdict(), ProofVerdict::proved) << range;
    EXPECT_NE(prove_volume({}, Target::point({0, 0, 0}), sensor, {}, large).verdict(), ProofVerdict::proved) << range;
  }
  testing::expect_code(
      [] {
        prove_volume({}, Target::point({0, 0, 0}), {.max_range_m = 1e-150}, {}, {});
      },
      ErrorCode::value_out_of_range);
}

/// By so much that its half is no less: nothing is proved, and it is told in the end.
TEST(Prove, ALimitThatIsBrokenBeyondAllNumbers) {
  const Mesh volume = testing::make_box_mesh({-1, -1, 5}, {1, 1, 6});
  for (const double far : {1e150, 1e155, 1e300}) {
    const ProofReport report = prove_volume({}, Target::point({far, 0, 0}), {.max_range_m = 60}, {}, volume);
    EXPECT_NE(report.verdict(), ProofVerdict::proved) << far;
  }
}

/// A needle from the target through a ceiling. Each facet holds views through it, however thin it is: its corners are
/// not in one plane with the target, though products of their coordinates are too small for a double.
TEST(Prove, ANeedleThatIsThinnerThanDoublesCanMultiply) {
  const Scene scene = testing::SceneBuilder().ground("ceiling", 90, 5);
  for (const Target& target :
       {Target::point({0, 0, 0}), Target::polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}})}) {
    for (const double thin : {1e-100, 1e-165, 1e-200, 1e-320}) {
      const Mesh needle = {{{thin, 0, thin}, {-thin, thin, thin}, {-thin, -thin, thin}, {0, 0, 10}},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
      const ProofReport report = prove_volume(scene, target, {.max_range_m = 60}, {}, needle);
      EXPECT_NE(report.verdict(), ProofVerdict::proved) << thin;
      EXPECT_GT(report.tested_facets, 0) << thin;
    }
  }
}

/// As it is told, without another rounding, at map coordinates and where edges of the scene lie in one line of sight.
TEST(Prove, AWitnessHoldsExactly) {
  int found = 0;
  for (std::uint64_t seed = 120; seed < 126; ++seed) {
    CityVolume city(seed, 12);
    const Vec3 far(5e5, 5e6, 100);
    for (Vec3& vertex : city.scene.mesh.vertices) vertex += far;
    for (Vec3& vertex : city.target.parts[0]) vertex += far;
    for (Vec3& vertex : city.volume.mesh.vertices) vertex += far;
    for (const double by : {1.0001, 1.1, 1.5}) {
      const ProofReport report = city.prove(scaled_about(city.volume.mesh, city.volume.frame.origin + far, by));
      ASSERT_TRUE(report.witness);
      const Triangle& t = city.scene.mesh.triangles[report.witness->triangle];
      const std::vector<Vec3>& v = city.scene.mesh.vertices;
      const Vec3 &from = report.witness->viewpoint, &to = report.witness->target_point;
      using testing::exact_side;
      EXPECT_EQ(exact_side(v[t[0]], v[t[1]], v[t[2]], from) * exact_side(v[t[0]], v[t[1]], v[t[2]], to), -1);
      const int side = exact_side(from, to, v[t[0]], v[t[1]]);
      EXPECT_NE(side, 0);
      EXPECT_EQ(exact_side(from, to, v[t[1]], v[t[2]]), side);
      EXPECT_EQ(exact_side(from, to, v[t[2]], v[t[0]]), side);
      ++found;
    }
  }
  EXPECT_EQ(found, 18);
}

TEST(Prove, RefusesWhatIsNoSolid) {
  const CityVolume city(96, 4);
  const auto expect = [&](const Mesh& mesh, ErrorCode code) {
    expect_code([&] { city.prove(mesh); }, code, "volume");  // which edge it is differs from compiler to compiler
  };
  expect({}, ErrorCode::mesh_empty);
  Mesh open = city.volume.mesh;
  open.triangles.pop_back();
  expect(open, ErrorCode::mesh_not_closed);
  Mesh turned = city.volume.mesh;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expect(turned, ErrorCode::mesh_not_oriented);
  Mesh inside_out = city.volume.mesh;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  expect(inside_out, ErrorCode::mesh_inside_out);
  Mesh infinite = city.volume.mesh;
  infinite.vertices[0].x() = std::numeric_limits<double>::infinity();
  expect(infinite, ErrorCode::coordinate_not_finite);
  infinite.vertices[0].x() = -1.001e9;
  expect(infinite, ErrorCode::coordinate_too_large);
  Mesh beyond = city.volume.mesh;
  beyond.triangles[0][0] = static_cast<std::uint32_t>(beyond.vertices.size());
  expect(beyond, ErrorCode::index_out_of_range);
}

TEST(Prove, RefusesOptionsAndSharesAndLinks) {
  CityVolume city(97, 4);
  EXPECT_EQ(code_of([&] { city.prove(city.volume.mesh, {.shrink = -1}); }), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of([&] { city.prove(city.volume.mesh, {.shrink = 1}); }), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of([&] { city.prove(city.volume.mesh, {.lift_m = {0, 0}}); }), ErrorCode::array_sizes_differ);
  city.sensor.visible = VisibleShare{0.8};
  EXPECT_EQ(code_of([&] { city.prove(city.volume.mesh); }), ErrorCode::not_applicable);
}

}  // namespace
}  // namespace vantage
