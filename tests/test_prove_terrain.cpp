// The proof of heights above terrain: what keeps them is proved, what breaks them is refuted, or not proved where the
// ground is finer than the tolerance.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "support/limit_claims.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::claim_of;
using testing::expect_proved;
using testing::expect_wrong;
using testing::Random;
using testing::World;
using testing::worlds;

/// Ground that rises to a ridge below the middle of the volume's bottom facets, which keep the height at all corners.
TEST(ProveTerrain, HasHeights) {
  for (const World& world : worlds()) {
    auto surface = std::make_shared<Mesh>();
    surface->vertices = {world.at(-20, -20, -4), world.at(0.5, -20, 0), world.at(20, -20, -4),
                         world.at(-20, 20, -4),  world.at(0.5, 20, 0),  world.at(20, 20, -4)};
    surface->triangles = {{0, 1, 4}, {0, 4, 3}, {2, 1, 4}, {2, 4, 5}};
    Navigation navigation;
    navigation.above_ground = AboveGround{5 * world.scale, 14 * world.scale, {0, surface}};
    expect_proved(world, navigation, world.mesh({-10, -10, 5}, {9, 10, 10}));
    expect_wrong(world, navigation, world.mesh({-10, -10, 4.95}, {9, 10, 10}), [](const Vec3& p) {
      const double ground = p.x() < 0.5 ? 4 / 20.5 * (p.x() - 0.5) : 4 / 19.5 * (0.5 - p.x());
      return 5 - (p.z() - ground);
    });
    expect_wrong(world, navigation, world.mesh({-10, -10, 6}, {9, 10, 13}), [](const Vec3& p) {
      const double ground = p.x() < 0.5 ? 4 / 20.5 * (p.x() - 0.5) : 4 / 19.5 * (0.5 - p.x());
      return p.z() - ground - 14;
    });
    navigation.above_ground->max_m = 100 * world.scale;
    expect_proved(world, navigation, world.mesh({-20, -20, 5}, {20, 20, 10}));
    expect_wrong(world, navigation, world.mesh({-10, -10, 5}, {20.2, 10, 10}),
                 [](const Vec3& p) { return p.x() - 20; });
    surface->triangles = {{0, 1, 4}, {0, 4, 3}, {2, 1, 4}};
    EXPECT_EQ(claim_of(world, navigation, world.mesh({-10, -10, 5}, {9, 10, 10})).verdict, ProofVerdict::wrong);
  }
}

/// Squares of such lengths are zero: a triangle is no ground for what is beside it, nor has it any other height.
TEST(ProveTerrain, OfATriangleThatIsHardlyThere) {
  const World world;
  for (const double size : {1e-60, 1e-80, 1e-120, 1e-160, 1e-200, 1e-320}) {
    auto surface = std::make_shared<Mesh>();
    surface->vertices = {{-size, -size, 0}, {size, -size, 0}, {0, size, 0}};
    surface->triangles = {{0, 1, 2}};
    Navigation navigation;
    navigation.above_ground = AboveGround{5, 14, {0, surface}};
    for (const auto& [x, low] : {std::pair(size / 4, 20.0), std::pair(0.1, 6.0), std::pair(0.1, 20.0)}) {
      const Mesh volume = testing::make_box_mesh({-x, -x, low}, {x, x, low + 1});
      EXPECT_NE(claim_of(world, navigation, volume).verdict, ProofVerdict::proved) << size << ' ' << x << ' ' << low;
    }
  }
}

/// Ground at 0 up to x = 0.37, and 2 lower beyond.
std::shared_ptr<Mesh> ground_with_a_step(const World& world) {
  auto surface = std::make_shared<Mesh>();
  surface->vertices = {world.at(-20, -20, 0),   world.at(0.37, -20, 0), world.at(0.37, 20, 0), world.at(-20, 20, 0),
                       world.at(0.37, -20, -2), world.at(20, -20, -2),  world.at(20, 20, -2),  world.at(0.37, 20, -2)};
  surface->triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return surface;
}

/// The volume has a wall straight above the step: on the border of both grounds, where the lower one counts.
TEST(ProveTerrain, WithAStep) {
  for (const World& world : worlds()) {
    Navigation navigation;
    navigation.above_ground = AboveGround{5 * world.scale, 20 * world.scale, {0, ground_with_a_step(world)}};
    const auto over_both = [&](double border, double low, double high) {
      Mesh mesh = world.mesh({-9, -9, 5}, {0.37, 9, 10});
      testing::append(mesh, world.mesh({border, -9, low}, {9, 9, high}));
      return mesh;
    };
    expect_proved(world, navigation, over_both(0.37, 3, 10));
    expect_wrong(world, navigation, over_both(0.3, 3, 10),
                 [](const Vec3& p) { return std::min(5 - p.z(), 0.37 - p.x()); });
    expect_wrong(world, navigation, over_both(0.37, 2.99, 10), [](const Vec3& p) { return 3 - p.z(); });
    expect_wrong(world, navigation, over_both(0.37, 3, 18.1), [](const Vec3& p) { return p.z() - 18; });
    // What keeps the limit next to it is over ground beside the volume's box.
    expect_wrong(world, navigation, world.mesh({0.2, -9, 3}, {0.36, 9, 10}),
                 [](const Vec3& p) { return std::min(5 - p.z(), 0.37 - p.x()); });
    if (world.shift != Vec3::Zero()) continue;
    // Hardly wider than nothing: its walls are at once beside both grounds, and keep the limit for neither.
    const auto thin = [&](double low, double high) {
      return world.mesh({0.37 - 1e-6, -9, low}, {0.37 + 1e-6, 9, high});
    };
    expect_proved(world, navigation, thin(3, 18));
    EXPECT_NE(claim_of(world, navigation, thin(2.9, 18)).verdict, ProofVerdict::proved);
    EXPECT_NE(claim_of(world, navigation, thin(3, 20.1)).verdict, ProofVerdict::proved);
    navigation.above_ground->max_m = 6 * world.scale;  // between 4 and 5 it is too high for one, too low for the other
    EXPECT_NE(claim_of(world, navigation, thin(3, 6)).verdict, ProofVerdict::proved);
  }
}

/// The lower ground goes on below the upper one: both count there.
TEST(ProveTerrain, WithAStepInLayers) {
  const World world;
  auto surface = ground_with_a_step(world);
  surface->vertices[4].x() = surface->vertices[7].x() = -20;
  Navigation navigation;
  navigation.above_ground = AboveGround{5, 20, {0, surface}};
  Mesh volume = world.mesh({-9, -9, 5}, {0.37, 9, 10});
  testing::append(volume, world.mesh({0.37, -9, 3}, {9, 9, 10}));
  expect_proved(world, navigation, volume);
  testing::append(volume, world.mesh({0.3, -9, 3}, {0.38, 9, 10}));
  expect_wrong(world, navigation, volume, [](const Vec3& p) { return std::min(5 - p.z(), 0.37 - p.x()); });
}

void add_rectangle(Mesh& surface, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double z) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vec3& corner : {Vec3(low.x(), low.y(), z), Vec3(high.x(), low.y(), z), Vec3(high.x(), high.y(), z),
                             Vec3(low.x(), high.y(), z)}) {
    surface.vertices.push_back(corner);
  }
  surface.triangles.push_back({first, first + 1, first + 2});
  surface.triangles.push_back({first, first + 2, first + 3});
}

void add_strip(Mesh& surface, double left, double right, double z) {
  add_rectangle(surface, {left, -20}, {right, 20}, z);
}

Navigation above_surface(Mesh surface, double min_m, double max_m) {
  Navigation navigation;
  navigation.above_ground = AboveGround{min_m, max_m, {0, std::make_shared<Mesh>(std::move(surface))}};
  return navigation;
}

/// A box whose walls are cut at these heights.
Mesh box_in_storeys(const Vec3& low, const Vec3& high, std::vector<double> heights) {
  heights.insert(heights.begin(), low.z());
  heights.push_back(high.z());
  Mesh mesh;
  for (const double z : heights) {
    for (const Vec3& corner : {Vec3(low.x(), low.y(), z), Vec3(high.x(), low.y(), z), Vec3(high.x(), high.y(), z),
                               Vec3(low.x(), high.y(), z)}) {
      mesh.vertices.push_back(corner);
    }
  }
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size()) - 4;
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {top, top + 1, top + 2}, {top, top + 2, top + 3}};
  for (std::uint32_t floor = 0; floor < top; floor += 4) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = floor + i, b = floor + (i + 1) % 4;
      mesh.triangles.push_back({a, b, b + 4});
      mesh.triangles.push_back({a, b + 4, a + 4});
    }
  }
  return mesh;
}

/// What is computed above steps of the ground is proved; moved up or down by a millimetre it is not.
void expect_computed_is_proved(const Mesh& surface, double min_m, double max_m) {
  Scene scene;
  scene.mesh = surface;
  scene.objects.push_back({.name = "ground"});
  scene.object_of.assign(surface.triangles.size(), 0);
  const Navigation navigation = above_surface(surface, min_m, max_m);
  const Target target = Target::polygon({{-2, -2, 6}, {2, -2, 6}, {2, 2, 6}, {-2, 2, 6}});
  const Sensor sensor{.max_range_m = 40};
  const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), navigation);
  ASSERT_FALSE(volume.empty()) << volume.reason;
  const auto verdict = [&](double by) {
    Mesh moved = volume.mesh;
    for (Vec3& vertex : moved.vertices) vertex.z() += by;
    return prove_volume(scene, target, sensor, navigation, moved, {.lift_m = volume.lift_m}).claims.back().verdict;
  };
  EXPECT_EQ(verdict(0), ProofVerdict::proved);
  // One of the two heights may be out of range everywhere.
  EXPECT_TRUE(verdict(-1e-3) != ProofVerdict::proved || verdict(1e-3) != ProofVerdict::proved);
}

/// Three grounds, or four, meet in a point: walls straight above two steps keep the heights only off both of them.
TEST(ProveTerrain, WithStepsThatMeet) {
  struct Ground {
    double beside, beyond, opposite, max_m;
  };
  for (const Ground& ground :
       std::vector<Ground>{{1, 0, 1.5, 13}, {1, 0.5, 1.5, 13}, {4, 2, 5, 30}, {-8, 4, -12, 63}}) {
    SCOPED_TRACE(ground.opposite);
    Mesh surface;
    add_rectangle(surface, {-70, -70}, {10, 10}, 0);
    add_rectangle(surface, {10, -70}, {70, 10}, ground.beside);
    add_rectangle(surface, {-70, 10}, {10, 70}, ground.beyond);
    add_rectangle(surface, {10, 10}, {70, 70}, ground.opposite);
    expect_computed_is_proved(surface, 3, ground.max_m);
  }
}

/// Rows of terraces, each cut at other places.
TEST(ProveTerrain, OfRandomTerraces) {
  Random random(72);
  for (int draw = 0; draw < 6; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw << " of seed 72");
    Mesh surface;
    double y = -70;
    while (y < 70) {
      const double next_y = std::min(70.0, y + random.uniform(12, 40));
      for (double x = -70; x < 70;) {
        const double next_x = std::min(70.0, x + random.uniform(12, 40));
        add_rectangle(surface, {x, y}, {next_x, next_y}, random.uniform(0, 4));
        x = next_x;
      }
      y = next_y;
    }
    expect_computed_is_proved(surface, random.uniform(2, 6), random.uniform(12, 30));
  }
}

/// Where a deck lies over other ground nothing keeps the heights of both. A fin straight below the side that two of its
/// triangles share is as near to the lower ground alone as one at the deck's border is.
TEST(ProveTerrain, UnderADeck) {
  const World world;
  Mesh surface;
  add_strip(surface, -40, 40, 0);
  add_strip(surface, -20, 0, 100);
  add_strip(surface, 0, 20, 100);
  const Navigation navigation = above_surface(std::move(surface), 10, 60);
  for (const double half_width : {1e-7, 1e-6, 1e-5, 1e-3}) {
    const Mesh fin = world.mesh({-half_width, -9, 10}, {half_width, 9, 40});
    EXPECT_NE(claim_of(world, navigation, fin).verdict, ProofVerdict::proved) << half_width;
  }
  const Mesh body = world.mesh({-8, -9, 10}, {8, 9, 40});
  expect_wrong(world, navigation, body, [](const Vec3& p) { return 110 - p.z(); });
}

/// Strips that are narrower than the tolerance, of two heights in turn, in a plain between them: what both allow leaves
/// heights between that neither does.
TEST(ProveTerrain, OfNarrowStrips) {
  const World world;
  const double left = -0.1, width = 4e-4, right = left + 500 * width;
  Mesh surface;
  add_rectangle(surface, {-60, -60}, {left, 60}, -1);
  add_rectangle(surface, {right, -60}, {60, 60}, -1);
  add_rectangle(surface, {left, -60}, {right, -3}, -1);
  add_rectangle(surface, {left, 3}, {right, 60}, -1);
  for (int i = 0; i < 500; ++i) {
    add_rectangle(surface, {left + i * width, -3}, {left + (i + 1) * width, 3}, i % 2 == 0 ? -2 : 0);
  }
  const auto storeys = [&](double low, double high, const std::vector<double>& heights) {
    return box_in_storeys({left, -3, low}, {right, 3, high}, heights);
  };
  const Navigation narrow = above_surface(surface, 500, 501);
  EXPECT_NE(claim_of(world, narrow, storeys(498.5, 500.5, {499, 500})).verdict, ProofVerdict::proved);
  EXPECT_NE(claim_of(world, narrow, storeys(498, 501, {499, 500})).verdict, ProofVerdict::proved);
  expect_proved(world, above_surface(surface, 498, 501), storeys(498, 499, {498.5}));
}

/// A lens over two such strips: its rim keeps the plain's heights, what is below those of one strip, what is above
/// those of the other. Its middle keeps none.
TEST(ProveTerrain, OfTwoNarrowStrips) {
  const World world;
  const double width = 2e-4;
  Mesh surface;
  add_rectangle(surface, {-60, -60}, {-width, 60}, -1);
  add_rectangle(surface, {width, -60}, {60, 60}, -1);
  add_rectangle(surface, {-width, -60}, {width, -3}, -1);
  add_rectangle(surface, {-width, 3}, {width, 60}, -1);
  add_rectangle(surface, {-width, -3}, {0, 3}, -2);
  add_rectangle(surface, {0, -3}, {width, 3}, 0);
  Mesh lens = box_in_storeys({-width, -3, 498.5}, {width, 3, 500.5}, {499.1, 499.9});
  for (Vec3& vertex : lens.vertices) {
    if (vertex.z() == 498.5 || vertex.z() == 500.5) vertex.head<2>() *= 0.5;
  }
  EXPECT_NE(claim_of(world, above_surface(surface, 500, 501), lens).verdict, ProofVerdict::proved);
}

/// Hundreds of pieces of ground within the tolerance, each of its own height: the search for a place beside has an end.
/// All of the box is that near to level ground around, over which it keeps the heights: it may be proved.
TEST(ProveTerrain, OfManyPiecesWithinTheTolerance) {
  const World world;
  Random random(11);
  constexpr int kCells = 20;
  const double cell = 2e-5, half = kCells * cell / 2;
  Mesh surface;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const Eigen::Vector2d low(i * cell - half, j * cell - half);
      add_rectangle(surface, low, low + Eigen::Vector2d(cell, cell), random.uniform(-1, 1));
    }
  }
  add_rectangle(surface, {-60, -60}, {-half, 60}, 0);
  add_rectangle(surface, {half, -60}, {60, 60}, 0);
  add_rectangle(surface, {-half, -60}, {half, -half}, 0);
  add_rectangle(surface, {-half, half}, {half, 60}, 0);
  const Navigation navigation = above_surface(std::move(surface), 500, 502);
  const Mesh box = world.mesh({-half, -half, 500}, {half, half, 502}),
             low = world.mesh({-half, -half, 498.9}, {half, half, 502});
  EXPECT_NE(claim_of(world, navigation, box).verdict, ProofVerdict::wrong);
  EXPECT_NE(claim_of(world, navigation, low).verdict, ProofVerdict::proved);
}

/// The tip of a sliver of lower ground lies at the end of a side of the upper one. Its sides, moved out by the
/// tolerance, meet many metres beyond the tip.
TEST(ProveTerrain, WithTheTipOfASliver) {
  const World world;
  Mesh surface;
  add_rectangle(surface, {-20, 20}, {0, 60}, 100);
  add_rectangle(surface, {0, 20}, {20, 60}, 100);
  add_rectangle(surface, {-60, -60}, {60, 10}, 0);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vec3& corner : {Vec3(-2e-5, 10, 0), Vec3(2e-5, 10, 0), Vec3(0, 20, 0)}) surface.vertices.push_back(corner);
  surface.triangles.push_back({first, first + 1, first + 2});
  const Navigation navigation = above_surface(std::move(surface), 10, 60);
  for (const double length : {1e-3, 1.0, 15.0}) {
    const Mesh fin = world.mesh({-1e-6, 20, 30}, {1e-6, 20 + length, 50});
    EXPECT_NE(claim_of(world, navigation, fin).verdict, ProofVerdict::proved) << length;
  }
}

/// Between two grounds that do not meet there is no ground: what hangs there, at whatever height, is beside no place
/// that keeps the limit.
TEST(ProveTerrain, WithASlot) {
  const World world;
  Mesh surface;
  add_strip(surface, -20, -1e-6, 0);
  add_strip(surface, 1e-6, 20, 0);
  const Navigation navigation = above_surface(std::move(surface), 5, 20);
  expect_proved(world, navigation, world.mesh({-9, -9, 5}, {9, 9, 20}));
  expect_proved(world, navigation, world.mesh({-5e-7, -9, 5}, {5e-7, 9, 20}));
  for (const double low : {4.9, 1.0}) {
    const Mesh fin = world.mesh({-5e-7, -9, low}, {5e-7, 9, 20});
    EXPECT_NE(claim_of(world, navigation, fin).verdict, ProofVerdict::proved) << low;
  }
}

/// Only one corner of the volume is too near to the ground, whichever it is.
TEST(ProveTerrain, BelowOneCorner) {
  const World world;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      auto surface = std::make_shared<Mesh>();
      for (const Vec3& corner : {Vec3(-20, -20, 0), Vec3(20, -20, 0), Vec3(20, 20, 0), Vec3(-20, 20, 0)}) {
        surface->vertices.emplace_back(corner.x(), corner.y(), 0.1 * (x * corner.x() + y * corner.y()));
      }
      surface->triangles = {{0, 1, 2}, {0, 2, 3}};
      Navigation navigation;
      navigation.above_ground = AboveGround{3, 100, {0, surface}};
      const Mesh volume = world.mesh({-10, -10, 5}, {10, 10, 9});
      expect_proved(world, navigation, volume);
      navigation.above_ground->min_m = 3.03;
      expect_wrong(world, navigation, volume,
                   [&](const Vec3& p) { return 3.03 - (p.z() - 0.1 * (x * p.x() + y * p.y())); });
    }
  }
}

/// A summit below the middle of a facet: all corners and edges of the volume are high enough.
TEST(ProveTerrain, WithASummit) {
  for (const World& world : worlds()) {
    auto surface = std::make_shared<Mesh>();
    surface->vertices = {world.at(-20, -20, -5), world.at(20, -20, -5), world.at(20, 20, -5), world.at(-20, 20, -5),
                         world.at(-4, 1, 0)};
    surface->triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    Navigation navigation;
    navigation.above_ground = AboveGround{5 * world.scale, 100 * world.scale, {0, surface}};
    expect_proved(world, navigation, world.mesh({-10, -10, 5}, {9, 10, 10}));
    expect_wrong(world, navigation, world.mesh({-10, -10, 4.99}, {9, 10, 10}),
                 [](const Vec3& p) { return 5 - p.z() - 5 * std::hypot(p.x() + 4, p.y() - 1) / 30; });
  }
}

/// Rough ground below an askew box that touches its highest place, a corner of the ground or where a ridge leaves it.
TEST(ProveTerrain, OfRandomHills) {
  const World world;
  Random random(71);
  for (int draw = 0; draw < 200; ++draw) {
    auto surface = std::make_shared<Mesh>();
    constexpr std::uint32_t kSide = 4;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const std::uint32_t row = i / kSide;
      surface->vertices.emplace_back(10.0 * (i % kSide) - 15 + random.uniform(-3, 3),
                                     10.0 * row - 15 + random.uniform(-3, 3), random.uniform(-9, -5));
    }
    for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i) {
      if (i % kSide == kSide - 1) continue;
      surface->triangles.push_back({i, i + 1, i + kSide + 1});
      surface->triangles.push_back({i, i + kSide + 1, i + kSide});
    }
    Mesh volume = world.mesh({-6, -6, 0}, {6, 6, 9});
    const double turn = random.uniform(0, 6);
    const Eigen::AngleAxisd about(turn, Vec3::UnitZ());
    for (Vec3& vertex : volume.vertices) vertex = about * vertex;
    const auto height_at = [&](double x, double y) {  // by barycentric coordinates
      for (const auto& [a, b, c] : surface->triangles) {
        const auto &p = surface->vertices[a], &q = surface->vertices[b], &r = surface->vertices[c];
        const double u = ((q.x() - x) * (r.y() - y) - (q.y() - y) * (r.x() - x)),
                     v = ((r.x() - x) * (p.y() - y) - (r.y() - y) * (p.x() - x)),
                     w = ((p.x() - x) * (q.y() - y) - (p.y() - y) * (q.x() - x));
        if (u >= 0 && v >= 0 && w >= 0) return (u * p.z() + v * q.z() + w * r.z()) / (u + v + w);
      }
      return -100.0;
    };
    // Along the sides of the bottom, closely, and at the corners of the ground inside.
    double highest = -100;
    for (int side = 0; side < 4; ++side) {
      for (int i = 0; i < 2000; ++i) {
        const double along = 12.0 * i / 2000 - 6;
        const Vec3 at = about * Vec3(side < 2 ? along : 12 * side - 30, side < 2 ? 12 * side - 6 : along, 0);
        highest = std::max(highest, height_at(at.x(), at.y()));
      }
    }
    for (const Vec3& vertex : surface->vertices) {
      const Vec3 own = about.inverse() * vertex;
      if (std::max(std::abs(own.x()), std::abs(own.y())) < 6) highest = std::max(highest, vertex.z());
    }
    Navigation navigation;
    navigation.above_ground = AboveGround{-highest - 0.01, 100, {0, surface}};  // the bottom is at 0
    volume.vertices.push_back(Vec3::Zero());
    expect_proved(world, navigation, volume);
    navigation.above_ground->min_m = -highest + 0.001;
    expect_wrong(world, navigation, volume,
                 [&](const Vec3& p) { return -highest + 0.001 - (p.z() - height_at(p.x(), p.y())); });
  }
}

TEST(ProveTerrain, InLayersAndAPlane) {
  const World world;
  auto surface = std::make_shared<Mesh>(world.mesh({-20, -20, -3}, {20, 20, 2}));  // vertical sides do not count
  Navigation navigation;
  navigation.above_ground = AboveGround{3, 12, {0, surface}};
  expect_proved(world, navigation, world.mesh({-9, -9, 5}, {9, 9, 9}));  // at least 3 above 2, at most 12 above -3
  expect_wrong(world, navigation, world.mesh({-9, -9, 4.9}, {9, 9, 9}), [](const Vec3& p) { return 5 - p.z(); });
  expect_wrong(world, navigation, world.mesh({-9, -9, 5}, {9, 9, 9.1}), [](const Vec3& p) { return p.z() - 9; });
  navigation.above_ground = AboveGround{3, 7, {2, nullptr}};
  expect_proved(world, navigation, world.mesh({-9, -9, 5}, {9, 9, 9}));
  expect_wrong(world, navigation, world.mesh({-9, -9, 5}, {9, 9, 9.1}), [](const Vec3& p) { return p.z() - 9; });
}

}  // namespace
}  // namespace vantage
