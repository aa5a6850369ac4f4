#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "core/parallel.h"
#include "core/triangle_tree.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/progress_check.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::append;
using testing::first_open_edge;
using testing::make_box_mesh;
using testing::make_dome;
using testing::make_hemisphere;

const Vec3 kUtm(580000.1, 4785000.2, 1000.3);

Volume bumpy_dome(const Vec3& origin, int sectors = 90, int rings = 30) {
  return make_dome(origin, sectors, rings, [](double azimuth, double elevation) {
    return 60 + 25 * std::sin(5 * azimuth) * std::cos(elevation) + 10 * std::cos(3 * elevation);
  });
}

Box box(double x0, double y0, double z0, double x1, double y1, double z1, const Vec3& offset = Vec3::Zero()) {
  return {Vec3(x0, y0, z0) + offset, Vec3(x1, y1, z1) + offset};
}

Navigation band(double min, double max) {
  Navigation navigation;
  navigation.altitude = {min, max};
  return navigation;
}

/// Area by cause name, summed over the facets themselves.
std::map<std::string, double> areas_of(const Volume& volume) {
  std::map<std::string, double> areas;
  for (std::size_t t = 0; t < volume.mesh.triangles.size(); ++t) {
    const Triangle& i = volume.mesh.triangles[t];
    const Vec3& a = volume.mesh.vertices[i[0]];
    areas[volume.causes[volume.cause_of[t]].name] +=
        (volume.mesh.vertices[i[1]] - a).cross(volume.mesh.vertices[i[2]] - a).norm() / 2;
  }
  return areas;
}

/// What every cut volume must be.
void expect_sound(const Volume& volume) {
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  EXPECT_EQ(first_open_edge(volume.mesh), "");
  EXPECT_EQ(volume.cause_of.size(), volume.mesh.triangles.size());
  EXPECT_EQ(measure(volume.mesh).vertices, volume.mesh.vertices.size());
  const std::map<std::string, double> areas = areas_of(volume);
  EXPECT_EQ(areas.size(), volume.causes.size());  // no cause without a facet
  for (const Cause& cause : volume.causes) EXPECT_NEAR(cause.area_m2, areas.at(cause.name), 1e-6) << cause.name;
}

CauseKind kind_of(const Volume& volume, const std::string& name) {
  for (const Cause& cause : volume.causes) {
    if (cause.name == name) return cause.kind;
  }
  ADD_FAILURE() << "no cause named " << name;
  return CauseKind::scene;
}

/// Whether a point lies in a dome by its own definition: the cone of one of its facets from the origin.
bool inside_star(const Volume& dome, const Vec3& point) {
  const Vec3 origin = dome.frame.origin, p = point - origin;
  for (std::size_t t = 0; t < dome.mesh.triangles.size(); ++t) {
    if (dome.cause_of[t] == 4) continue;  // the floor
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = dome.mesh.vertices[dome.mesh.triangles[t][i]] - origin;
    const Vec3 weights = corners.fullPivLu().solve(p);
    if (weights.minCoeff() >= -1e-9) return weights.sum() <= 1;
  }
  return false;
}

TEST(Navigation, AltitudeBandIsExact) {
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(0.1, -0.7, 3.3), kUtm}) {
    const Volume dome = bumpy_dome(origin);
    const double low = origin.z() + 10.1, high = origin.z() + 40.7;
    const Volume cut = cut_to_navigation(dome, band(low, high));
    expect_sound(cut);
    const MeshMeasures measures = measure(cut.mesh);
    EXPECT_EQ(measures.bounds.min.z(), low);
    EXPECT_EQ(measures.bounds.max.z(), high);
    EXPECT_EQ(measures.pieces, 1u);
    EXPECT_EQ(measures.euler, 2);
    EXPECT_LT(measures.volume_m3, measure(dome.mesh).volume_m3);
    EXPECT_EQ(kind_of(cut, "altitude min"), CauseKind::navigation);
    EXPECT_EQ(kind_of(cut, "altitude max"), CauseKind::navigation);
    for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
      const std::string& name = cut.causes[cut.cause_of[t]].name;
      for (const std::uint32_t v : cut.mesh.triangles[t]) {
        if (name == "altitude min") {
          EXPECT_EQ(cut.mesh.vertices[v].z(), low);
        } else if (name == "altitude max") {
          EXPECT_EQ(cut.mesh.vertices[v].z(), high);
        }
      }
    }
  }
}

TEST(Navigation, HemisphereSlabHasTheRightVolumeAndAreas) {
  const Volume dome = make_hemisphere(Vec3(0, 0, 0), 100, 400, 200);
  const Volume cut = cut_to_navigation(dome, band(20, 60));
  const auto slab = [](double z) { return std::numbers::pi * (100 * 100 * z - z * z * z / 3); };
  EXPECT_NEAR(measure(cut.mesh).volume_m3, slab(60) - slab(20), 100);
  const std::map<std::string, double> areas = areas_of(cut);
  EXPECT_NEAR(areas.at("altitude min"), std::numbers::pi * (10000 - 400), 5);
  EXPECT_NEAR(areas.at("altitude max"), std::numbers::pi * (10000 - 3600), 5);
  EXPECT_EQ(areas.count("target plane"), 0u);
  EXPECT_EQ(areas.count("max_range"), 0u);  // above 60 degrees: z > 86
}

TEST(Navigation, KeepsWhatLiesWithinTheLimits) {
  const Volume dome = bumpy_dome(Vec3(0, 0, 0));
  Navigation navigation = band(0, 500);  // the floor lies in the lower limit
  navigation.keep_in = {box(-200, -200, -1, 200, 200, 300)};
  navigation.keep_out = {box(150, 0, 0, 200, 10, 10)};
  const Volume cut = cut_to_navigation(dome, navigation);
  EXPECT_EQ(cut.mesh.vertices, dome.mesh.vertices);
  EXPECT_EQ(cut.mesh.triangles, dome.mesh.triangles);
  EXPECT_EQ(cut.cause_of, dome.cause_of);
  EXPECT_EQ(cut_to_navigation(dome, {}).mesh.vertices, dome.mesh.vertices);
}

TEST(Navigation, VerticesAwayFromTheCutKeepTheirBits) {
  const Volume dome = bumpy_dome(kUtm);
  const Volume cut = cut_to_navigation(dome, band(0, kUtm.z() + 30.5));
  std::map<std::array<double, 3>, int> after;
  for (const Vec3& v : cut.mesh.vertices) ++after[{v.x(), v.y(), v.z()}];
  for (const Vec3& v : dome.mesh.vertices) {
    const int count = after[{v.x(), v.y(), v.z()}];
    EXPECT_EQ(count, v.z() < kUtm.z() + 30.5 ? 1 : 0);
  }
}

TEST(Navigation, BoxCornersAreExact) {
  for (const Vec3& offset : {Vec3(0, 0, 0), kUtm}) {
    const Volume dome = bumpy_dome(offset);
    Navigation navigation;
    navigation.keep_in = {box(-9.7, -8.3, 5.1, 11.9, 7.7, 21.3, offset)};  // wholly inside
    const Volume cut = cut_to_navigation(dome, navigation);
    expect_sound(cut);
    const MeshMeasures measures = measure(cut.mesh);
    EXPECT_EQ(measures.vertices, 8u);
    EXPECT_EQ(measures.bounds.min, navigation.keep_in[0].box().min);
    EXPECT_EQ(measures.bounds.max, navigation.keep_in[0].box().max);
    ASSERT_EQ(cut.causes.size(), 1u);
    EXPECT_EQ(cut.causes[0].name, "zone 0");
    EXPECT_NEAR(measures.volume_m3, 21.6 * 16 * 16.2, 1e-5);
  }
}

TEST(Navigation, BoxesAreUnited) {
  const Volume dome = bumpy_dome(Vec3(0, 0, 0));
  Navigation navigation;
  navigation.keep_in = {box(-20, -5, 1, 0, 5, 10), box(0, -5, 1, 20, 5, 10), box(10, -5, 5, 15, 5, 20),
                        box(-20, 20, 1, -10, 30, 5), box(500, 500, 0, 501, 501, 1)};
  const Volume cut = cut_to_navigation(dome, navigation);
  expect_sound(cut);
  EXPECT_EQ(measure(cut.mesh).pieces, 2u);
  EXPECT_EQ(measure(cut.mesh).euler, 4);
  EXPECT_NEAR(measure(cut.mesh).volume_m3, 40 * 10 * 9 + 5 * 10 * 10 + 10 * 10 * 4, 1e-6);
  EXPECT_EQ(kind_of(cut, "zone 3"), CauseKind::navigation);
}

TEST(Navigation, KeepOutTakesAway) {
  const Volume dome = bumpy_dome(Vec3(0, 0, 0));
  const double before = measure(dome.mesh).volume_m3;
  Navigation navigation;
  navigation.keep_out = {box(5, 5, 5, 7, 8, 9), box(500, 0, 0, 501, 1, 1), box(-4, -4, -9, -2, -2, 3)};
  const Volume cut = cut_to_navigation(dome, navigation);
  expect_sound(cut);
  EXPECT_NEAR(measure(cut.mesh).volume_m3, before - 24 - 12, 1e-6);
  EXPECT_EQ(measure(cut.mesh).pieces, 2u);  // the first is a cavity
  const std::map<std::string, double> areas = areas_of(cut);
  EXPECT_NEAR(areas.at("keep_out zone 0"), 2 * (6 + 8 + 12), 1e-9);
  EXPECT_NEAR(areas.at("keep_out zone 2"), 4 * 2 * 3 + 4, 1e-9);
  EXPECT_EQ(areas.count("keep_out zone 1"), 0u);
}

TEST(Navigation, KeepOutMayCutTheVolumeInTwo) {
  const Volume dome = bumpy_dome(Vec3(0, 0, 0));
  Navigation navigation;
  navigation.keep_out = {box(-1, -200, -1, 1, 200, 200)};
  const Volume cut = cut_to_navigation(dome, navigation);
  expect_sound(cut);
  EXPECT_EQ(measure(cut.mesh).pieces, 2u);
  for (const Vec3& v : cut.mesh.vertices) EXPECT_GE(std::abs(v.x()), 1.0);
}

TEST(Navigation, MeshesCutAndKeepTheirNames) {
  const Volume dome = bumpy_dome(kUtm);
  Navigation navigation;
  Mesh wedge = make_box_mesh(Vec3(-30, -30, 2) + kUtm, Vec3(30, 30, 20) + kUtm);
  for (int v = 4; v < 8; ++v) wedge.vertices[v].x() += 10;  // slanted sides
  navigation.meshes = {{wedge, "airspace.ply"}, {make_box_mesh(Vec3(-9, -9, -9) + kUtm, Vec3(9, 9, 99) + kUtm), "b"}};
  const Volume cut = cut_to_navigation(dome, navigation);
  expect_sound(cut);
  EXPECT_EQ(kind_of(cut, "mesh airspace.ply"), CauseKind::navigation);
  EXPECT_EQ(kind_of(cut, "mesh b"), CauseKind::navigation);
  EXPECT_NEAR(measure(cut.mesh).volume_m3, 18 * 18 * 18, 1e-4);
}

TEST(Navigation, AllLimitsTogetherAgreeWithPointTests) {
  for (const Vec3& offset : {Vec3(0, 0, 0), kUtm}) {
    const Volume dome = bumpy_dome(offset, 36, 12);
    Navigation navigation = band(offset.z() + 3, offset.z() + 45);
    navigation.keep_in = {box(-50, -50, 0, 10, 50, 50, offset), box(0, -20, -5, 70, 20, 30, offset)};
    navigation.keep_out = {box(-20, -20, 0, -5, 15, 25, offset), box(20, -60, 10, 30, 60, 90, offset)};
    Mesh mesh = make_box_mesh(Vec3(-45, -40, -10), Vec3(50, 40, 100));
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& v : mesh.vertices) v = turn * v + offset;
    navigation.meshes = {{mesh, "m"}};
    const Volume cut = cut_to_navigation(dome, navigation);
    expect_sound(cut);

    // The volume of the result by counting points of the definition.
    const unsigned seed = 3;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> xy(-90, 90), z(0, 80);
    const auto in_any = [&](const std::vector<Zone>& zones, const Vec3& p) {
      for (const Zone& zone : zones) {
        const Box b = zone.box();
        if ((p.array() >= b.min.array()).all() && (p.array() <= b.max.array()).all()) return true;
      }
      return false;
    };
    constexpr int kPoints = 40000;
    int inside = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 p = Vec3(xy(random), xy(random), z(random)) + offset;
      const Vec3 m = turn.transpose() * (p - offset);
      const bool in_mesh = m.x() > -45 && m.x() < 50 && m.y() > -40 && m.y() < 40 && m.z() > -10 && m.z() < 100;
      inside += in_mesh && p.z() >= navigation.altitude->min_m && p.z() <= navigation.altitude->max_m &&
                in_any(navigation.keep_in, p) && !in_any(navigation.keep_out, p) && inside_star(dome, p);
    }
    const double share = static_cast<double>(inside) / kPoints, domain = 180.0 * 180 * 80;
    const double deviation = domain * std::sqrt(share * (1 - share) / kPoints);
    EXPECT_NEAR(measure(cut.mesh).volume_m3, share * domain, 4 * deviation) << "seed " << seed;
    EXPECT_GT(inside, 500);
  }
}

TEST(Navigation, NothingIsPushedOutward) {
  // Every vertex of the result lies in the dome and in the limits, to rounding.
  const Volume dome = bumpy_dome(kUtm, 36, 12);
  const unsigned seed = 17;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 20; ++i) {
    Navigation navigation = band(kUtm.z() + 10 + 8 * uniform(random), kUtm.z() + 30 + 8 * uniform(random));
    const Vec3 centre = kUtm + Vec3(40 * uniform(random), 40 * uniform(random), 20);
    navigation.keep_in = {Box{centre - Vec3(30, 25, 40), centre + Vec3(30, 25, 40)}};
    const Volume cut = cut_to_navigation(dome, navigation);
    expect_sound(cut);
    const Box b = navigation.keep_in[0].box();
    for (const Vec3& v : cut.mesh.vertices) {
      EXPECT_GE(v.z(), navigation.altitude->min_m);
      EXPECT_LE(v.z(), navigation.altitude->max_m);
      EXPECT_TRUE((v.array() >= b.min.array()).all() && (v.array() <= b.max.array()).all()) << "seed " << seed;
      EXPECT_TRUE(inside_star(dome, kUtm + (v - kUtm) * (1 - 1e-9))) << "seed " << seed;
    }
  }
}

/// Triangles of boxes on a ground, as scenes have them.
Scene small_town(const Vec3& offset) {
  Scene scene;
  scene.objects = named({"ground", "north", "east", "tower"});
  scene.mesh.vertices = {Vec3(-200, -200, 0), Vec3(200, -200, 0), Vec3(200, 200, 0), Vec3(-200, 200, 0)};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  append(scene.mesh, make_box_mesh(Vec3(-20, 15, 0), Vec3(20, 30, 12)));
  append(scene.mesh, make_box_mesh(Vec3(15, -20, 0), Vec3(30, 10, 20)));
  append(scene.mesh, make_box_mesh(Vec3(-30, -12, 0), Vec3(-25, -7, 50)));
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    scene.object_of.push_back(t < 2 ? 0 : static_cast<std::uint32_t>(1 + (t - 2) / 12));
  }
  for (Vec3& v : scene.mesh.vertices) v += offset;
  return scene;
}

/// Limits about `offset`. Every other coordinate is that of a vertex of the volume, so that planes run through
/// vertices, along edges and in facets.
Navigation random_limits(std::mt19937& random, const Volume& volume) {
  std::uniform_int_distribution<std::size_t> vertex(0, volume.mesh.vertices.size() - 1);
  const Box bounds = bounding_box(volume.mesh);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  const auto coordinate = [&](int axis) {
    if (random() % 2 == 0) return volume.mesh.vertices[vertex(random)][axis];
    return bounds.min[axis] + uniform(random) * (bounds.max[axis] - bounds.min[axis]);
  };
  const auto random_box = [&] {
    Box b;
    while (!(b.min.array() < b.max.array()).all()) {
      for (int axis = 0; axis < 3; ++axis) {
        b.min[axis] = coordinate(axis);
        b.max[axis] = coordinate(axis);
      }
    }
    return b;
  };
  Navigation navigation;
  if (random() % 2 == 0) navigation.altitude = {random_box().min.z(), bounds.max.z() + 1};
  for (std::size_t i = random() % 4; i > 0; --i) navigation.keep_in.push_back(random_box());
  for (std::size_t i = random() % 3; i > 0; --i) navigation.keep_out.push_back(random_box());
  return navigation;
}

bool within_limits(const Navigation& navigation, const Vec3& p) {
  const auto in = [&](const Zone& zone) {
    const Box b = zone.box();
    return (p.array() >= b.min.array()).all() && (p.array() <= b.max.array()).all();
  };
  if (navigation.altitude && (p.z() < navigation.altitude->min_m || p.z() > navigation.altitude->max_m)) return false;
  if (!navigation.keep_in.empty() && std::none_of(navigation.keep_in.begin(), navigation.keep_in.end(), in))
    return false;
  return std::none_of(navigation.keep_out.begin(), navigation.keep_out.end(), in);
}

/// The mesh about `origin`, where single-precision boxes are fine.
Mesh moved(Mesh mesh, const Vec3& origin) {
  for (Vec3& v : mesh.vertices) v -= origin;
  return mesh;
}

TEST(Navigation, RandomLimitsOnEngineVolumesAgreeWithPointTests) {
  const unsigned seed = 23;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Vec3& offset : {Vec3(0, 0, 0), kUtm}) {
    const PreparedScene scene(small_town(offset));
    Target target;
    for (const Vec3& v : {Vec3(-5, -5, 0), Vec3(6, -4, 0), Vec3(0, 5, 0)}) target.parts[0].push_back(v + offset);
    const Volume volume = compute_visibility(PreparedTarget(scene, target, Sensor{60}), ExactOptions{0.1});
    ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
    const Mesh before = moved(volume.mesh, offset);
    const core::TriangleTree whole(before);
    const Box bounds = bounding_box(volume.mesh);
    int inside = 0, outside = 0;
    for (int draw = 0; draw < 40; ++draw) {
      const Navigation navigation = random_limits(random, volume);
      const Volume cut = cut_to_navigation(volume, navigation);
      if (cut.outcome == Outcome::computed) expect_sound(cut);
      const Mesh after = moved(cut.mesh, offset);
      const core::TriangleTree rest(after);
      for (int i = 0; i < 200; ++i) {
        const Vec3 unit(uniform(random), uniform(random), uniform(random));
        const Vec3 p = bounds.min + unit.cwiseProduct(bounds.max - bounds.min);
        const bool expected = within_limits(navigation, p) && whole.winding_number(p - offset) == 1;
        EXPECT_EQ(rest.winding_number(p - offset), expected ? 1 : 0) << "seed " << seed << ", draw " << draw;
        ++(expected ? inside : outside);
      }
    }
    EXPECT_GT(inside, 300);
    EXPECT_GT(outside, 300);
  }
}

TEST(Navigation, LimitsThatTouchCornersAndEdgesOfTheVolume) {
  // Planes through vertices, along edges and in the floor of the dome.
  const Volume dome = make_hemisphere(Vec3(0, 0, 0), 10, 8, 4);
  const double ring = dome.mesh.vertices[8].z();
  for (const auto& [low, high] : {std::pair(ring, 20.0), std::pair(0.0, ring), std::pair(-5.0, ring)}) {
    const Volume cut = cut_to_navigation(dome, band(low, high));
    expect_sound(cut);
    EXPECT_EQ(measure(cut.mesh).euler, 2);
    EXPECT_EQ(measure(cut.mesh).bounds.max.z(), std::min(high, 10.0));
    EXPECT_EQ(measure(cut.mesh).bounds.min.z(), std::max(low, 0.0));
  }
  Navigation quarter;
  quarter.keep_in = {box(0, 0, 0, 20, 20, 20)};
  const Volume cut = cut_to_navigation(dome, quarter);
  expect_sound(cut);
  EXPECT_NEAR(measure(cut.mesh).volume_m3, measure(dome.mesh).volume_m3 / 4, 1e-9);
}

TEST(Navigation, WhatDoesNotChangeIsPassedThrough) {
  Volume dome = bumpy_dome(Vec3(0, 0, 0));
  dome.tolerance_m = 0.5;
  dome.lift_m = {0.001};
  dome.counts.visible_blockers = 17;
  dome.seconds.engine = 3;
  const Volume cut = cut_to_navigation(dome, band(5, 20));
  EXPECT_EQ(cut.tolerance_m, 0.5);
  EXPECT_EQ(cut.lift_m, std::vector{0.001});
  EXPECT_EQ(cut.counts.visible_blockers, 17u);
  EXPECT_EQ(cut.seconds.engine, 3);
  EXPECT_GT(cut.seconds.navigation, 0);
  EXPECT_EQ(cut.frame.origin, dome.frame.origin);

  Volume blocked;
  blocked.outcome = Outcome::blocked_at_once;
  blocked.reason = "why";
  blocked.hint = "what";
  const Volume passed = cut_to_navigation(blocked, band(5, 20));
  EXPECT_EQ(passed.outcome, Outcome::blocked_at_once);
  EXPECT_EQ(passed.reason, "why");
  EXPECT_EQ(passed.hint, "what");
  EXPECT_THROW(cut_to_navigation(blocked, band(20, 5)), Error);  // wrong limits are wrong all the same
}

TEST(Navigation, SaysWhyNothingIsLeft) {
  const Volume dome = make_hemisphere(Vec3(10, 20, 512.3), 100);
  const auto expect_nothing_left = [&](const Navigation& navigation) {
    const Volume cut = cut_to_navigation(dome, navigation);
    EXPECT_EQ(cut.outcome, Outcome::outside_limits);
    EXPECT_TRUE(cut.mesh.empty() && cut.mesh.vertices.empty() && cut.cause_of.empty() && cut.causes.empty());
    EXPECT_FALSE(cut.hint.empty());
    EXPECT_EQ(cut.tolerance_m, dome.tolerance_m);
    testing::expect_wording(cut.reason);
  };
  expect_nothing_left(band(700, 800));
  expect_nothing_left(band(612.3, 800));
  expect_nothing_left(band(5, 20.5));

  Navigation boxes;
  boxes.keep_in = {box(500, 0, 0, 600, 10, 999)};
  expect_nothing_left(boxes);
  boxes.keep_in.push_back(box(95, 105, 590, 120, 130, 700));  // meets its bounds only
  expect_nothing_left(boxes);
  boxes.altitude = {520, 530};
  boxes.keep_in = {box(0, 0, 540, 600, 10, 999)};
  expect_nothing_left(boxes);

  Navigation meshes;
  meshes.meshes = {{make_box_mesh(Vec3(0, 0, 0), Vec3(10, 10, 10)), "airspace.ply"}};
  expect_nothing_left(meshes);

  Navigation keep_out;
  keep_out.keep_out = {box(-100, -100, 0, 200, 200, 999)};
  expect_nothing_left(keep_out);
  keep_out.keep_out = {box(-100, -100, 0, 50, 200, 999), box(50, -100, 0, 200, 200, 999)};
  expect_nothing_left(keep_out);
}

/// Expects that a cut refuses these limits.
void expect_refused(const Navigation& navigation, ErrorCode code, const std::string& where) {
  testing::expect_error([&] { cut_to_navigation(make_hemisphere(Vec3(0, 0, 0), 10), navigation); }, code, where);
}

TEST(Navigation, RefusesReversedLimits) {
  expect_refused(band(120, 20), ErrorCode::limits_reversed, "navigation.altitude");
  expect_refused(band(20, 20), ErrorCode::limits_empty, "navigation.altitude");
  expect_refused(band(20, NAN), ErrorCode::value_out_of_range, "navigation.altitude");
  expect_refused(band(-INFINITY, 20), ErrorCode::value_out_of_range, "navigation.altitude");
  Navigation navigation;
  navigation.keep_in = {box(0, 0, 0, 1, 1, 1), box(0, 30, 0, 1, 10, 1)};
  expect_refused(navigation, ErrorCode::limits_reversed, "navigation.keep_in[1]");
  navigation.keep_in.clear();
  navigation.keep_out = {box(0, 0, 5, 1, 1, 5)};
  expect_refused(navigation, ErrorCode::limits_empty, "navigation.keep_out[0]");
  navigation.keep_out = {Box()};
  expect_refused(navigation, ErrorCode::value_out_of_range, "navigation.keep_out[0]");
}

TEST(Navigation, RefusesBadMeshes) {
  Navigation navigation;
  Mesh mesh = make_box_mesh(Vec3(-5, -5, -5), Vec3(5, 5, 5));
  mesh.triangles.pop_back();
  navigation.meshes = {{mesh, "airspace.ply"}};
  expect_refused(navigation, ErrorCode::mesh_not_closed, "airspace.ply");
  mesh = make_box_mesh(Vec3(-5, -5, -5), Vec3(5, 5, 5));
  append(mesh, make_box_mesh(Vec3(-4, -4, -4), Vec3(4, 4, 9)));
  navigation.meshes[0].mesh = mesh;
  expect_refused(navigation, ErrorCode::mesh_intersects_itself, "airspace.ply");
  mesh = make_box_mesh(Vec3(-5, -5, -5), Vec3(5, 5, 5));
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  navigation.meshes[0].mesh = mesh;
  expect_refused(navigation, ErrorCode::mesh_inside_out, "airspace.ply");
  navigation.meshes[0].mesh = {};
  expect_refused(navigation, ErrorCode::mesh_empty, "airspace.ply");
}

TEST(Navigation, RefusesABrokenVolume) {
  const Volume good = make_hemisphere(Vec3(0, 0, 0), 10);
  std::vector<Volume> broken(4, good);
  broken[0].cause_of[3] = 5;
  broken[1].cause_of.pop_back();
  broken[2].mesh.triangles[3] = {0, 1, 9999};
  broken[3].mesh.triangles.pop_back();  // open
  broken[3].cause_of.pop_back();
  for (const Volume& volume : broken) {
    try {
      cut_to_navigation(volume, band(2, 5));
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    }
  }
}

TEST(Navigation, ReportsProgressAndStops) {
  const Volume dome = bumpy_dome(Vec3(0, 0, 0), 300, 150);
  Navigation navigation = band(5, 50);
  navigation.keep_out = {box(5, 5, 5, 30, 30, 30)};
  navigation.meshes = {{make_hemisphere(Vec3(0, 0, 0), 40, 100, 50).mesh, "m"}};
  Volume cut;
  const auto story =
      testing::check_progress([&](const Progress& progress) { cut = cut_to_navigation(dome, navigation, progress); });
  expect_sound(cut);
  EXPECT_EQ(story.stages, std::vector<std::string>{"navigation"});
  EXPECT_EQ(story.last_fraction.at("navigation"), 1);
}

TEST(Navigation, ItsTimeIsPartOfTheTotal) {
  Volume dome = bumpy_dome(Vec3::Zero());
  dome.seconds.engine = dome.seconds.total = 1;
  const Volume cut = cut_to_navigation(dome, band(5, 50));
  EXPECT_GT(cut.seconds.navigation, 0);
  EXPECT_EQ(cut.seconds.total, 1 + cut.seconds.navigation);
  const Volume again = cut_to_navigation(cut, band(10, 40));
  EXPECT_GT(again.seconds.navigation, cut.seconds.navigation);
  EXPECT_NEAR(again.seconds.total, 1 + again.seconds.navigation, 1e-12);
}

TEST(Navigation, DoesNotDependOnThreads) {
  const Volume dome = bumpy_dome(kUtm, 400, 100);
  Navigation navigation = band(kUtm.z() + 5, kUtm.z() + 50);
  navigation.keep_in = {box(-50, -50, 0, 10, 50, 50, kUtm), box(0, -20, -5, 70, 20, 30, kUtm)};
  navigation.keep_out = {box(-20, -20, 0, -5, 15, 25, kUtm)};
  Volume one;
  parallel::with_threads(1, [&] { one = cut_to_navigation(dome, navigation); });
  for (int i = 0; i < 3; ++i) {
    const Volume all = cut_to_navigation(dome, navigation);
    EXPECT_EQ(all.mesh.vertices, one.mesh.vertices);
    EXPECT_EQ(all.mesh.triangles, one.mesh.triangles);
    EXPECT_EQ(all.cause_of, one.cause_of);
  }
}

}  // namespace
}  // namespace vantage
