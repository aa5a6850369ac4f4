// The proofs of navigation limits: what keeps a limit is proved, what breaks it is refuted at a place that is looked at
// here with plain arithmetic. At several scales and at map coordinates.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/limit_claims.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::claim_of;
using testing::code_of;
using testing::expect_proved;
using testing::expect_wrong;
using testing::make_box_mesh;
using testing::report_of;
using testing::SceneBuilder;
using testing::World;
using testing::worlds;
using testing::zone_of;

double inside_box_by(const Vec3& p, const Vec3& min, const Vec3& max) {
  return std::min((p - min).minCoeff(), (max - p).minCoeff());
}

TEST(ProveLimits, ABoxToStayOutOf) {
  for (const World& world : worlds()) {
    const Mesh volume = world.mesh({-4, -4, 1}, {4, 4, 9});
    Navigation navigation;
    navigation.keep_out = {world.box({4, -3, 0}, {8, 3, 5}), world.box({-3, -3, 9}, {3, 3, 12})};
    expect_proved(world, navigation, volume);
    navigation.keep_out[1].min_z_m -= 1e-3 * world.scale;
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return inside_box_by(p, {-3, -3, 8.999}, {3, 3, 12});
    });
    navigation.keep_out[1].min_z_m += 1e-3 * world.scale;
    navigation.keep_out[0] =
        Box{navigation.keep_out[0].box().min - Vec3(1e-3 * world.scale, 0, 0), navigation.keep_out[0].box().max};
    expect_wrong(world, navigation, volume, [](const Vec3& p) { return inside_box_by(p, {3.999, -3, 0}, {8, 3, 5}); });
  }
}

TEST(ProveLimits, AZoneWithFarCorners) {
  const World world;
  for (const double far : {1e4, 1e6, 1e8, 1e9}) {
    SCOPED_TRACE(far);
    Navigation navigation;
    navigation.keep_in = {zone_of({{-7, -7}, {far, -far}, {far, far}, {-far, far}}, -50, 50)};
    const Volume cut = cut_to_navigation(testing::make_hemisphere(Vec3(0, 0, 1), 30, 16, 8), navigation);
    const ProofVerdict within = claim_of(world, navigation, cut.mesh).verdict;
    EXPECT_EQ(within, far < 5e8 ? ProofVerdict::proved : ProofVerdict::not_proved);
    navigation.keep_out = navigation.keep_in;
    navigation.keep_in.clear();
    const Volume rest = cut_to_navigation(testing::make_hemisphere(Vec3(0, 0, 1), 30, 16, 8), navigation);
    EXPECT_EQ(claim_of(world, navigation, rest.mesh).verdict, ProofVerdict::proved);
  }
}

/// No facet meets the box, as it is all inside.
TEST(ProveLimits, ABoxToStayOutOfInTheMiddle) {
  for (const World& world : worlds()) {
    Mesh volume = world.mesh({-4, -4, 1}, {4, 4, 9});
    Navigation navigation;
    navigation.keep_out = {world.box({-1, -1, 4}, {1, 1, 6})};
    expect_wrong(world, navigation, volume, [](const Vec3& p) { return inside_box_by(p, {-1, -1, 4}, {1, 1, 6}); });
    Mesh cavity = world.mesh({-1, -1, 4}, {1, 1, 6});
    for (Triangle& t : cavity.triangles) std::swap(t[0], t[1]);
    testing::append(volume, cavity);
    expect_proved(world, navigation, volume);
  }
}

/// A zone in the shape of an L, askew, with a hole. Boxes in its notch, in its hole, and across it.
TEST(ProveLimits, AZoneToStayOutOf) {
  const double turn = 0.3;
  const auto turned = [&](double x, double y) {
    return Eigen::Vector2d(std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y);
  };
  const Zone::Ring outer = {turned(0, 0), turned(20, 0), turned(20, 10), turned(10, 10), turned(10, 20), turned(0, 20)};
  const Zone::Ring hole = {turned(2, 2), turned(6, 2), turned(6, 6), turned(2, 6)};
  const auto box = [&](const World& world, double x0, double y0, double x1, double y1) {
    Mesh mesh = world.mesh({x0, y0, 1}, {x1, y1, 9});
    for (Vec3& vertex : mesh.vertices) {
      const Vec3 at = world.back(vertex);
      const Eigen::Vector2d plan = turned(at.x(), at.y());
      vertex = world.at(plan.x(), plan.y(), at.z());
    }
    return mesh;
  };
  // In the frame of the zone's sides.
  const auto inside_by = [&](const Vec3& p) {
    const double x = std::cos(turn) * p.x() + std::sin(turn) * p.y(),
                 y = std::cos(turn) * p.y() - std::sin(turn) * p.x();
    const bool is_in_notch = x > 10 && y > 10, is_in_hole = x > 2 && x < 6 && y > 2 && y < 6;
    if (is_in_notch || is_in_hole) return -1.0;
    const double of_bounds = std::min({x, y, 20 - x, 20 - y, p.z() - 3, 8 - p.z()});
    const double of_notch = std::hypot(std::max(10 - x, 0.0), std::max(10 - y, 0.0));
    const double of_hole = std::hypot(std::max({2 - x, x - 6, 0.0}), std::max({2 - y, y - 6, 0.0}));
    return std::min({of_bounds, of_notch, of_hole});
  };
  for (const World& world : worlds()) {
    Navigation navigation;
    const double low = world.at(0, 0, 3).z(), high = world.at(0, 0, 8).z();
    navigation.keep_out = {zone_of(world.ring(outer), low, high, "park")};
    navigation.keep_out[0].holes = {world.ring(hole)};
    expect_proved(world, navigation, box(world, 10, 10, 18, 19));
    expect_proved(world, navigation, box(world, 2, 2, 6, 6));
    expect_proved(world, navigation, box(world, 20, -2, 25, 12));
    expect_wrong(world, navigation, box(world, 9.9, 10, 18, 19), inside_by);
    expect_wrong(world, navigation, box(world, 2, 1.95, 6, 6), inside_by);
    expect_wrong(world, navigation, box(world, -5, 8, 25, 9), inside_by);
    expect_wrong(world, navigation, box(world, -5, -5, 25, 25), inside_by);
    navigation.keep_out[0].min_z_m = world.at(0, 0, 9).z();
    navigation.keep_out[0].max_z_m = std::numeric_limits<double>::infinity();
    expect_proved(world, navigation, box(world, -5, -5, 25, 25));
  }
}

TEST(ProveLimits, BoxesAndZonesToStayIn) {
  const auto outside_by = [](const Vec3& p) {
    const double of_box = (Vec3(-10, -10, 0) - p).cwiseMax(p - Vec3(0, 10, 20)).maxCoeff();
    const double of_zone = (Vec3(0.1, -10, 0) - p).cwiseMax(p - Vec3(10, 10, 20)).maxCoeff();
    return std::min(of_box, of_zone);
  };
  for (const World& world : worlds()) {
    const Mesh volume = world.mesh({-9, -9, 1}, {9, 9, 9});
    Navigation navigation;
    const double low = world.at(0, 0, 0).z(), high = world.at(0, 0, 20).z();
    navigation.keep_in = {world.box({-10, -10, 0}, {0, 10, 20}),
                          zone_of(world.ring({{0, -10}, {10, -10}, {10, 10}, {0, 10}}), low, high)};
    expect_proved(world, navigation, volume);
    navigation.keep_in[1].outer = world.ring({{0.1, -10}, {10, -10}, {10, 10}, {0.1, 10}});
    expect_wrong(world, navigation, volume, outside_by);
    navigation.keep_in[1].outer = world.ring({{-1, -10}, {10, -10}, {10, 10}, {-1, 10}});
    navigation.keep_in[1].holes = {world.ring({{5, 5}, {6, 5}, {6, 6}, {5, 6}})};
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return std::min(std::min(p.x() - 5, 6 - p.x()), std::min(p.y() - 5, 6 - p.y()));
    });
    navigation.keep_in[1].holes.clear();
    expect_proved(world, navigation, volume);
    navigation.keep_in[1].max_z_m = world.at(0, 0, 8.91).z();
    expect_wrong(world, navigation, volume, [](const Vec3& p) { return std::min(p.z() - 8.91, p.x()); });
  }
}

/// Every facet is covered by one of six slabs, but the room between them is in none.
TEST(ProveLimits, AHollowBetweenBoxesToStayInIsNotMissed) {
  const World world;
  Navigation navigation;
  navigation.keep_in = {world.box({-5, -5, 1}, {5, 5, 2}),   world.box({-5, -5, 9}, {5, 5, 10}),
                        world.box({-5, -5, 1}, {-4, 5, 10}), world.box({4, -5, 1}, {5, 5, 10}),
                        world.box({-5, -5, 1}, {5, -4, 10}), world.box({-5, 4, 1}, {5, 5, 10})};
  EXPECT_EQ(claim_of(world, navigation, world.mesh({-5, -5, 1}, {5, 5, 10})).verdict, ProofVerdict::not_proved);
  expect_proved(world, navigation, world.mesh({-5, -5, 1}, {5, 5, 2}));
}

double distance_to_box(const Vec3& p, const Vec3& min, const Vec3& max) {
  return (min - p).cwiseMax(p - max).cwiseMax(0.0).norm();
}

TEST(ProveLimits, AClearanceFromObstacles) {
  for (const World& world : worlds()) {
    Navigation navigation;
    const auto around = [&](const Vec3& min, const Vec3& max) {
      return std::make_shared<const Mesh>(world.mesh(min, max));
    };
    const Mesh volume = world.mesh({-4, -4, 1}, {4, 4, 9});
    navigation.clearance = Clearance{2 * world.scale, around({6, -1, 0}, {7, 1, 5})};
    expect_proved(world, navigation, volume);
    navigation.clearance->distance_m *= 1.01;
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return 2.02 - distance_to_box(p, {6, -1, 0}, {7, 1, 5});
    });
    // Corner against corner: the boxes are nearer to each other than the solids.
    navigation.clearance = Clearance{std::sqrt(3) * world.scale, around({5, 5, 10}, {6, 6, 11})};
    expect_proved(world, navigation, volume);
    navigation.clearance->distance_m *= 1.01;
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return 1.01 * std::sqrt(3) - distance_to_box(p, {5, 5, 10}, {6, 6, 11});
    });
    navigation.clearance = Clearance{1 * world.scale, around({-1, -1, 4}, {1, 1, 6})};  // all inside
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return 1.0 - distance_to_box(p, {-1, -1, 4}, {1, 1, 6});
    });
  }
}

/// A wire across an edge of the volume: the nearest points are inside of two edges.
TEST(ProveLimits, AClearanceFromAWire) {
  for (const World& world : worlds()) {
    const Mesh volume = world.mesh({-4, -4, 1}, {4, 4, 9});
    auto wire = std::make_shared<Mesh>();
    wire->vertices = {world.at(2, 0.3, 13), world.at(8, 0.3, 7), world.at(8, 0.3, 7)};
    wire->triangles = {{0, 1, 2}};
    Navigation navigation;
    navigation.clearance = Clearance{std::sqrt(2) * world.scale, wire};
    expect_proved(world, navigation, volume);
    navigation.clearance->distance_m *= 1.001;
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      const Vec3 from = p - Vec3(5, 0.3, 10), along = Vec3(1, 0, -1) / std::sqrt(2);
      return 1.001 * std::sqrt(2) - (from - from.dot(along) * along).norm();
    });
  }
}

TEST(ProveLimits, MeshesToStayIn) {
  for (const World& world : worlds()) {
    Navigation navigation;
    Mesh wedge = world.mesh({-5, -5, 0}, {5, 5, 10});
    for (Vec3& vertex : wedge.vertices) vertex.x() += 0.3 * (vertex.z() - world.shift.z());
    navigation.meshes = {{wedge, "airspace"}};
    expect_proved(world, navigation, world.mesh({-2, -4, 1}, {5.3, 4, 10}));
    expect_wrong(world, navigation, world.mesh({-2, -4, 1}, {5.35, 4, 10}),
                 [](const Vec3& p) { return std::max(p.x() - 5 - 0.3 * p.z(), -2 - p.x() - 3 + 0.3 * p.z()); });
    testing::append(navigation.meshes[0].mesh, world.mesh({20, 20, 0}, {30, 30, 10}));  // two solids are not convex
    EXPECT_EQ(claim_of(world, navigation, world.mesh({-2, -4, 1}, {5, 4, 9})).verdict, ProofVerdict::not_proved);
    expect_wrong(world, navigation, world.mesh({-2, -4, 1}, {6, 4, 9}),
                 [](const Vec3& p) { return std::max(p.x() - 5 - 0.3 * p.z(), 0.3 * p.z() - 5 - p.x()); });
  }
}

TEST(ProveLimits, HeightsOfZonesAboveTerrainAreNamed) {
  const World world;
  auto surface = std::make_shared<Mesh>();
  surface->vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}};
  surface->triangles = {{0, 1, 2}, {0, 2, 3}};
  Zone zone = zone_of({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, 0, 100);
  zone.above_ground = AboveGround{20, 40, {0, surface}};
  Navigation navigation;
  navigation.keep_out = {zone};
  EXPECT_EQ(claim_of(world, navigation, world.mesh({-5, -5, 1}, {5, 5, 8})).verdict, ProofVerdict::not_proved);
  expect_proved(world, navigation, world.mesh({9, -5, 1}, {15, 5, 8}));
  navigation = {};
  navigation.keep_in = {zone};
  expect_proved(world, navigation, world.mesh({-9, -5, 20}, {9, 5, 40}));
  expect_wrong(world, navigation, world.mesh({-9, -5, 19.9}, {9, 5, 40}), [](const Vec3& p) { return 20 - p.z(); });
  expect_wrong(world, navigation, world.mesh({-9, -5, 20}, {9.1, 5, 40}), [](const Vec3& p) { return p.x() - 9; });
  navigation.keep_in.push_back(world.box({20, 20, 0}, {30, 30, 9}));
  EXPECT_EQ(claim_of(world, navigation, world.mesh({-9, -5, 20}, {9, 5, 40})).verdict, ProofVerdict::not_proved);
}

/// What cut_to_navigation leaves keeps the limits.
TEST(ProveLimits, WhatWasCutIsProved) {
  const World world;
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{1.1, 8.7};
  navigation.keep_in = {zone_of({{-30, -25}, {28, -31}, {33, 27}, {-29, 34}}, -5, 50)};
  navigation.keep_out = {Box{{-8, -8, 3}, {-6, -6, 5}}, zone_of({{3, 3}, {12, 5}, {6, 6}, {7, 14}}, -5, 6)};
  auto surface = std::make_shared<Mesh>();
  surface->vertices = {{-60, -60, -6}, {60, -60, -3}, {60, 60, -8}, {-60, 60, -2}, {1, 2, 1}};
  surface->triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  navigation.above_ground = AboveGround{1.3, 11.7, {0, surface}};
  navigation.clearance = Clearance{1.5, std::make_shared<const Mesh>(make_box_mesh({-20, 10, 0}, {-15, 14, 6}))};
  Mesh ball;
  testing::append(ball, testing::make_hemisphere({0, 0, 0}, 25).mesh);
  const Volume cut = cut_to_navigation(volume_of_mesh(ball, "ball"), navigation);
  ASSERT_FALSE(cut.empty()) << cut.reason;
  const ProofReport report = report_of(world, navigation, cut.mesh);
  EXPECT_EQ(report.claims.size(), 8u);
  for (const ClaimProof& claim : report.claims) {
    EXPECT_EQ(claim.verdict, ProofVerdict::proved) << claim.name << ": " << claim.text;
  }
}

/// A zone whose two kinds of heights exclude each other takes nothing away.
TEST(ProveLimits, AZoneOfNoHeight) {
  const World world;
  Navigation navigation;
  navigation.keep_out = {zone_of({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, 0, 5)};
  navigation.keep_out[0].above_ground = AboveGround{10, 20, {0, nullptr}};
  expect_proved(world, navigation, world.mesh({-5, -5, 1}, {5, 5, 30}));
}

TEST(ProveLimits, LimitsThatAreWrongInThemselvesAreRefused) {
  const World world;
  const auto code = [&](const Navigation& navigation) {
    return code_of([&] { report_of(world, navigation, world.mesh({-4, -4, 1}, {4, 4, 9})); });
  };
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{5, 5};
  EXPECT_EQ(code(navigation), ErrorCode::limits_empty);
  navigation = {};
  navigation.keep_out = {Box{{0, 0, 0}, {1, 1, 0}}};
  EXPECT_EQ(code(navigation), ErrorCode::limits_empty);
  navigation = {};
  navigation.keep_in = {zone_of({{0, 0}, {1, 1}}, 0, 9)};
  EXPECT_EQ(code(navigation), ErrorCode::zone_not_simple);
  navigation = {};
  navigation.clearance = Clearance{1, nullptr};
  EXPECT_EQ(code(navigation), ErrorCode::nothing_given);
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}};
  mesh->triangles = {{0, 1, 2}};
  navigation.clearance->obstacles = mesh;
  EXPECT_EQ(code(navigation), ErrorCode::index_out_of_range);
  navigation = {};
  navigation.above_ground = AboveGround{1, 5, {0, mesh}};
  EXPECT_EQ(code(navigation), ErrorCode::index_out_of_range);
}

}  // namespace
}  // namespace vantage
