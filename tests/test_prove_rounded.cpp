// Volumes in files of single-precision numbers: right ones are proved, less a layer that is told; those that were moved
// by more, and those that only look thin, are not.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "prove/shallow.h"
#include "prove/sight.h"
#include "prove/view.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using internal::prove::make_view;
using internal::prove::Piece;
using internal::prove::Shallow;
using internal::prove::View;
using testing::make_box_mesh;
using testing::Random;
using testing::SceneBuilder;

/// A volume of a random city, and what its files say.
struct FiledCity {
  explicit FiledCity(std::uint64_t seed, const Vec3& shift = Vec3::Zero())
      : random(seed), scene(testing::random_city(random, 30, 12)) {
    for (Vec3& vertex : scene.mesh.vertices) vertex += shift;
    target = testing::random_target(random, 5, 2, shift + Vec3(0, 0, 0.5), Vec3(0, 0, 1));
    volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor));
  }
  VolumeFile as(const std::string& name) const {
    write_volume(volume, folder / name);
    return read_volume(folder / name);
  }
  ProofReport prove(const Mesh& mesh, double rounding_m) const {
    const ProveOptions options{.rounding_m = rounding_m, .lift_m = volume.lift_m};
    return prove_volume(scene, target, sensor, {}, mesh, options);
  }

  testing::TemporaryDirectory folder;
  Random random;
  Scene scene;
  Target target;
  Sensor sensor{.max_range_m = 80};
  Volume volume;
};

TEST(ProveRounded, RightFilesAreProvedLessALayer) {
  std::size_t layers = 0;
  for (std::uint64_t seed = 61; seed < 65; ++seed) {
    const FiledCity city(seed);
    for (const char* name : {"volume.stl", "volume.glb"}) {
      const VolumeFile read = city.as(name);
      ASSERT_GT(read.rounding_m, 0);
      const ProofReport report = city.prove(read.volume.mesh, read.rounding_m);
      EXPECT_EQ(report.verdict(), ProofVerdict::proved)
          << name << " of seed " << seed << ": " << report.unproved.size() << " facets";
      EXPECT_LE(report.layer_m, 2.001 * read.rounding_m);
      if (report.layer_m == 0) continue;
      ++layers;
      // Numbers of single precision are coarser than the margin: a strip of four of them is left out.
      EXPECT_GT(report.margin_m, 3e-9);
      std::cout << name << " of seed " << seed << ": layer of " << report.layer_m / read.rounding_m << " roundings\n";
    }
  }
  EXPECT_GT(layers, 4U);
}

/// The same vertices, moved by some roundings of the file: by one it may be right, by twenty it is not.
TEST(ProveRounded, FilesThatWereMovedByMoreAreNotProved) {
  for (std::uint64_t seed = 61; seed < 63; ++seed) {
    FiledCity city(seed);
    for (const char* name : {"volume.stl", "volume.glb"}) {
      const VolumeFile read = city.as(name);
      Mesh moved = read.volume.mesh;
      std::map<std::array<double, 3>, Vec3> places;  // in an STL file each triangle has vertices of its own
      for (Vec3& vertex : moved.vertices) {
        const auto at = places.try_emplace({vertex.x(), vertex.y(), vertex.z()}, Vec3::Zero()).first;
        if (at->second.isZero(0)) at->second = vertex + 20 * read.rounding_m * city.random.direction();
        vertex = at->second;
      }
      EXPECT_NE(city.prove(moved, read.rounding_m).verdict(), ProofVerdict::proved) << name << " of seed " << seed;
      for (Vec3& vertex : moved.vertices) vertex.x() += 0.01;
      EXPECT_EQ(city.prove(moved, read.rounding_m).verdict(), ProofVerdict::wrong) << name << " of seed " << seed;
    }
  }
}

/// A wall beside a square, a box that sees all of it, and more shells.
struct Walled {
  Scene scene = SceneBuilder().ground("ground", 60).box("wall", {10, -6, 0}, {11, 6, 9});
  Target target = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  Mesh volume = make_box_mesh({-3, -3, 1}, {3, 3, 6});

  ProofReport prove(double rounding_m) const {
    return prove_volume(scene, target, {.max_range_m = 90}, {}, volume, {.shrink = 0, .rounding_m = rounding_m});
  }
};

/// A cube behind the wall, filled with shells in each other, so that nothing in it is two roundings from a facet: but
/// its middle is nearly four from all that is outside.
TEST(ProveRounded, ARegionThatIsFilledWithFacetsIsNotALayer) {
  constexpr double kRounding = 1e-6;
  const auto cube = [](double half) {
    const Vec3 middle(20, 0, 2);
    return make_box_mesh(middle - Vec3::Constant(half), middle + Vec3::Constant(half));
  };
  Walled thin;
  thin.volume = make_box_mesh({-3, -3, 1}, {10 + 0.5 * kRounding, 3, 6});  // ends in the wall
  const ProofReport whole = thin.prove(kRounding);
  EXPECT_EQ(whole.verdict(), ProofVerdict::proved) << whole.claims[0].text;
  EXPECT_NEAR(whole.layer_m, kRounding, 0.01 * kRounding);
  Walled filled;
  for (int k = 1; k <= 2; ++k) testing::append(filled.volume, cube(1.8 * kRounding * k));
  EXPECT_NE(filled.prove(kRounding).verdict(), ProofVerdict::proved);
  // Likewise with the two sides of flaps, which hang on one of its corners.
  Walled flaps;
  constexpr int kFlaps = 2;
  const double half = 1.8 * kRounding * kFlaps;
  const auto first = static_cast<std::uint32_t>(flaps.volume.vertices.size());
  testing::append(flaps.volume, cube(half));
  for (int k = -kFlaps; k <= kFlaps; ++k) {
    const auto next = static_cast<std::uint32_t>(flaps.volume.vertices.size());
    const double z = 2 + half * k / kFlaps;
    flaps.volume.vertices.insert(flaps.volume.vertices.end(),
                                 {Vec3(20 - half, 3 * half, z), Vec3(20 + 3 * half, -half, z)});
    flaps.volume.triangles.push_back({first, next, next + 1});
    flaps.volume.triangles.push_back({first, next + 1, next});
  }
  EXPECT_NE(flaps.prove(kRounding).verdict(), ProofVerdict::proved);
}

/// A volume of 50 roundings' width that ends in a wall by half of one: a layer of one would be 4 % of it.
TEST(ProveRounded, ALayerIsNoLargePartOfTheVolume) {
  constexpr double kRounding = 1e-6;
  Walled thin;
  thin.volume = make_box_mesh({-3, -3, 1}, {10 + 0.5 * kRounding, 3, 1 + 50 * kRounding});
  const ProofReport report = thin.prove(kRounding);
  EXPECT_EQ(report.verdict(), ProofVerdict::not_proved);
  EXPECT_EQ(report.layer_m, 0);
  EXPECT_NE(report.claims[0].text.find("write PLY"), std::string::npos) << report.claims[0].text;
  thin.volume = make_box_mesh({-3, -3, 1}, {10 + 0.5 * kRounding, 3, 1 + 500 * kRounding});
  EXPECT_EQ(thin.prove(kRounding).verdict(), ProofVerdict::proved);
  thin.volume = make_box_mesh({-3, -3, 1}, {9.9, 3, 1 + 50 * kRounding});
  EXPECT_EQ(thin.prove(kRounding).verdict(), ProofVerdict::proved);  // needs none
}

/// What is said to be shallow: places from which the obstacle hides something, on the way to the facet, have places
/// outside of the volume as near.
TEST(ProveRounded, WhatIsShallowIsNearToTheOutside) {
  Random random(2301);
  std::size_t shallow = 0, deep = 0, judged = 0;
  const Target target = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const View view = make_view(target, 0, 0);
  for (int round = 0; round < 1500; ++round) {
    const double depth = std::pow(10.0, random.uniform(-5, -1));
    Mesh mesh = make_box_mesh({-3, -3, 1}, {3, 3, 6});
    for (Vec3& vertex : mesh.vertices) vertex += random.point(-0.5, 0.5) - view.origin;
    // A triangle that reaches into the view of one facet's corner, by about the depth.
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(random.integer(0, 11))];
    const std::array<Vec3, 3> facet = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const Vec3 corner = facet[static_cast<std::size_t>(random.integer(0, 2))];
    const Vec3 seen = view.corners[static_cast<std::size_t>(random.integer(0, 3))];
    const Vec3 place = seen + random.uniform(0.3, 0.95) * (corner - seen);
    const Vec3 outward = Vec3(seen.x(), seen.y(), 0).normalized();
    const Vec3 edge = outward.cross(corner - seen).normalized();
    const Vec3 touch = place + depth * random.uniform(-2, 2) * outward.cross(edge).normalized() - depth * outward;
    const std::array<Vec3, 3> hides = {touch, touch + 3 * outward + edge, touch + 3 * outward - edge};
    const bool is_shallow = Shallow(mesh, view).is_shallow(facet, Piece::triangle(hides, 0), depth);
    ++(is_shallow ? shallow : deep);
    if (!is_shallow) continue;
    // Positions near the facet, in the tetrahedron to the target's centre.
    for (int k = 0; k < 200; ++k) {
      std::array<double, 3> parts = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
      for (double& part : parts) part = std::pow(part, 3);
      const double sum = parts[0] + parts[1] + parts[2];
      const Vec3 on = (parts[0] * facet[0] + parts[1] * facet[1] + parts[2] * facet[2]) / sum;
      const Vec3 at = (1 - std::pow(10.0, random.uniform(-6, 0))) * on;
      bool is_hidden = false;
      for (int s = 0; s < 20 && !is_hidden; ++s) {
        const Vec3& a = view.inner[static_cast<std::size_t>(random.integer(0, 3))];
        const Vec3& b = view.inner[static_cast<std::size_t>(random.integer(0, 3))];
        const Vec3 aim = a + random.uniform(0, 1) * (b - a);
        const Vec3 normal = (hides[1] - hides[0]).cross(hides[2] - hides[0]);
        const double from = normal.dot(at - hides[0]), to = normal.dot(aim - hides[0]);
        if (from * to >= 0) continue;
        const Vec3 pass = at + from / (from - to) * (aim - at);
        is_hidden = true;
        for (std::size_t i = 0; i < 3; ++i) {
          is_hidden = is_hidden && normal.cross(hides[(i + 1) % 3] - hides[i]).dot(pass - hides[i]) > 0;
        }
      }
      if (!is_hidden) continue;
      ++judged;
      bool has_outside = !testing::holds(mesh, at);
      for (const Triangle& other : mesh.triangles) {
        const Vec3 n = (mesh.vertices[other[1]] - mesh.vertices[other[0]])
                           .cross(mesh.vertices[other[2]] - mesh.vertices[other[0]])
                           .normalized();
        has_outside = has_outside || !testing::holds(mesh, at + depth * n);
      }
      EXPECT_TRUE(has_outside) << "round " << round;
    }
  }
  std::cout << shallow << " shallow, " << deep << " not, " << judged << " hidden places judged\n";
  EXPECT_GT(shallow, 100U);
  EXPECT_GT(deep, 100U);
  EXPECT_GT(judged, 20U);
}

/// A volume that ends behind its target by no more than its file rounded.
TEST(ProveRounded, WhatIsBehindTheTargetIsALayerToo) {
  Walled yard;
  yard.volume = make_box_mesh({-3, -3, -5e-7}, {3, 3, 6});
  const ProofReport rounded = yard.prove(1e-6);
  EXPECT_EQ(rounded.claims[2].verdict, ProofVerdict::proved);
  EXPECT_NEAR(rounded.layer_m, 5e-7, 1e-12);
  EXPECT_EQ(yard.prove(1e-7).claims[2].verdict, ProofVerdict::wrong);
}

/// Of two targets one has the thicker layer, the other a lift that is not believed: both are told, in either order.
TEST(ProveRounded, SeveralTargetsTellTheirLayersAndLifts) {
  Walled yard;
  yard.volume = make_box_mesh({-3, -3, 1}, {10 + 5e-7, 3, 6});  // ends in the wall
  Mission mission;
  auto loaded = std::make_shared<LoadedScene>();
  loaded->scene = yard.scene;
  mission.loaded = loaded;
  Target other = testing::target_of({{-21, -1, 0}, {-19, -1, 0}, {-19, 1, 0}, {-21, 1, 0}});
  mission.target = other;
  mission.sensor.max_range_m = 90;
  for (const bool is_first : {true, false}) {
    mission.views = {{yard.target}, {other}};
    if (is_first) std::swap(mission.views[0], mission.views[1]);
    const ProveOptions options{
        .shrink = 0, .rounding_m = 1e-6, .lift_m = {is_first ? 0.0 : 0.005, is_first ? 0.005 : 0.0}};
    const ProofReport report = prove_volume(mission, yard.volume, options);
    const ProofReport one = prove_volume(yard.scene, yard.target, mission.sensor, {}, yard.volume,
                                         {.shrink = 0, .rounding_m = 1e-6, .lift_m = {0.005}});
    const ProofReport more = prove_volume(yard.scene, other, mission.sensor, {}, yard.volume,
                                          {.shrink = 0, .rounding_m = 1e-6, .lift_m = {0.0}});
    ASSERT_GT(one.layer_m, 0);
    ASSERT_GT(more.layer_m, one.layer_m);  // it is farther away
    EXPECT_EQ(report.verdict(), ProofVerdict::proved);
    EXPECT_EQ(report.layer_m, more.layer_m);
    EXPECT_NE(report.claims[0].text.find(one.claims[0].text), std::string::npos) << report.claims[0].text;
    EXPECT_EQ(report.lift_of_part_m.size(), 2U);
    EXPECT_EQ(report.lift_m, one.lift_m);
  }
}

/// Targets in one plane that face opposite ways are not the two sides of one: in that plane a position sees one of
/// them only.
TEST(ProveRounded, OfTargetsInOnePlaneIsNoSideOfTheOther) {
  Walled yard;
  Mission mission;
  auto loaded = std::make_shared<LoadedScene>();
  loaded->scene = yard.scene;
  mission.loaded = loaded;
  mission.sensor.max_range_m = 90;
  Target up = testing::target_of({{-9, -1, 2}, {-7, -1, 2}, {-7, 1, 2}, {-9, 1, 2}}), down = up, beside = up;
  std::reverse(down.parts[0].begin(), down.parts[0].end());
  up.front_by_order = down.front_by_order = true;
  mission.views = {{up, down}};
  check_provable(mission);
  for (Vec3& corner : down.parts[0]) corner.x() += 3;
  mission.views = {{up, down}};
  EXPECT_THROW(check_provable(mission), Error);
}

/// Of a facet that is open for many pieces no more are listed than are looked at.
TEST(ProveRounded, ManyOpenPiecesAreNotAllListed) {
  Mesh flaps;
  testing::SceneBuilder city;
  for (int i = 0; i < 40; ++i) {
    const double x = 10 + 0.1 * i;
    city.polygon("sheet " + std::to_string(i), {{x, -9, 0.5}, {x, 9, 0.5}, {x, 9, 20}, {x, -9, 20}});
    const auto first = static_cast<std::uint32_t>(flaps.vertices.size());
    for (const Vec3& corner : {Vec3(20 + x, -1, 5), Vec3(20 + x, 1, 5), Vec3(20 + x, 0, 7)})
      flaps.vertices.push_back(corner);
    flaps.triangles.push_back({first, first + 1, first + 2});
  }
  const Scene scene = city;
  const Target target = testing::target_of({{0, -2, 0.1}, {2, -2, 0.1}, {2, 2, 0.1}, {0, 2, 0.1}});
  const auto view = internal::prove::make_view(target, 0, 0);
  std::vector<Vec3> vertices;
  for (const Vec3& vertex : flaps.vertices) vertices.push_back(vertex - view.origin);
  const auto tree = internal::prove::obstacles_in_front(scene, view, Box{Vec3::Constant(-500), Vec3::Constant(500)});
  const auto told = [&](std::size_t most) {
    return internal::prove::prove_sight(vertices, flaps.triangles, view, scene, tree, {.most_pieces = most}, {})
        .open.size();
  };
  const std::size_t all = told(1'000'000);
  ASSERT_EQ(all, 40U * 40);
  EXPECT_EQ(told(all), all);
  EXPECT_GT(told(100), 100U);
  EXPECT_LE(told(100), 110U);
}

}  // namespace
}  // namespace vantage
