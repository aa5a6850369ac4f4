// The proofs of navigation limits: what keeps a limit is proved, what breaks it is refuted at a place that is looked at
// here with plain arithmetic. At several scales and at map coordinates.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/error.h"
#include "vantage/navigation.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::code_of;
using testing::make_box_mesh;
using testing::SceneBuilder;
using testing::zone_of;

/// Where a test takes place, and how large it is.
struct World {
  double scale = 1;
  Vec3 shift = Vec3::Zero();

  Vec3 at(double x, double y, double z) const { return shift + scale * Vec3(x, y, z); }
  Vec3 back(const Vec3& place) const { return (place - shift) / scale; }
  Box box(const Vec3& min, const Vec3& max) const { return {shift + scale * min, shift + scale * max}; }
  Mesh mesh(const Vec3& min, const Vec3& max) const { return make_box_mesh(shift + scale * min, shift + scale * max); }
  Zone::Ring ring(const Zone::Ring& of) const {
    Zone::Ring moved;
    for (const Eigen::Vector2d& corner : of) moved.push_back(shift.head<2>() + scale * corner);
    return moved;
  }
};

/// Micrometres to kilometres, on the ground and at map coordinates.
std::vector<World> worlds() {
  std::vector<World> all;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(5e5, 5e5, 100), Vec3(5e5, 5e6, 100)}) all.push_back({scale, shift});
  }
  return all;
}

/// Of a mesh over a small square that looks up, in a scene without anything else.
ProofReport report_of(const World& world, const Navigation& navigation, const Mesh& mesh) {
  const Target target =
      Target::polygon({world.at(-1, -1, 0), world.at(1, -1, 0), world.at(1, 1, 0), world.at(-1, 1, 0)});
  const Sensor sensor{.max_range_m = 1000 * world.scale};
  return prove_volume({}, target, sensor, navigation, mesh);
}

ClaimProof claim_of(const World& world, const Navigation& navigation, const Mesh& mesh) {
  const ProofReport report = report_of(world, navigation, mesh);
  EXPECT_EQ(report.claims.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(report.claims[i].verdict, ProofVerdict::proved);
  EXPECT_GE(report.limit_tolerance_m, report.shrink * 2 * world.scale);
  EXPECT_LT(report.limit_tolerance_m, 1e-3 * world.scale);
  const ClaimProof& claim = report.claims.back();
  EXPECT_FALSE(claim.text.empty());
  EXPECT_EQ(claim.place.has_value(), claim.verdict == ProofVerdict::wrong);
  if (claim.place) {
    EXPECT_GT(claim.broken_by_m, report.limit_tolerance_m);
  }
  return claim;
}

void expect_proved(const World& world, const Navigation& navigation, const Mesh& mesh) {
  const ClaimProof claim = claim_of(world, navigation, mesh);
  EXPECT_EQ(claim.verdict, ProofVerdict::proved) << claim.text << " scale " << world.scale;
}

/// `breaks`: of a place in the world of scale 1 about the origin, metres by which the limit is broken there.
void expect_wrong(const World& world, const Navigation& navigation, const Mesh& mesh,
                  const std::function<double(const Vec3&)>& breaks) {
  const ClaimProof claim = claim_of(world, navigation, mesh);
  ASSERT_EQ(claim.verdict, ProofVerdict::wrong) << claim.text << " scale " << world.scale;
  const double by = breaks(world.back(*claim.place));
  EXPECT_GT(by, 0);
  EXPECT_LE(claim.broken_by_m, by * world.scale + 1e-6 * world.scale + 1e-8) << claim.text;
}

double inside_box_by(const Vec3& p, const Vec3& min, const Vec3& max) {
  return std::min((p - min).minCoeff(), (max - p).minCoeff());
}

TEST(ProveLimits, ABoxToStayOutOf) {
  for (const World& world : worlds()) {
    const Mesh volume = world.mesh({-4, -4, 1}, {4, 4, 9});
    Navigation navigation;
    navigation.keep_out = {world.box({4, -3, 0}, {8, 3, 5}), world.box({-3, -3, 9}, {3, 3, 12})};
    expect_proved(world, navigation, volume);
    navigation.keep_out[1].min.z() -= 1e-3 * world.scale;
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return inside_box_by(p, {-3, -3, 8.999}, {3, 3, 12});
    });
    navigation.keep_out[1].min.z() += 1e-3 * world.scale;
    navigation.keep_out[0].min.x() -= 1e-3 * world.scale;
    expect_wrong(world, navigation, volume, [](const Vec3& p) { return inside_box_by(p, {3.999, -3, 0}, {8, 3, 5}); });
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
    navigation.keep_out_zones = {zone_of(world.ring(outer), low, high, "park")};
    navigation.keep_out_zones[0].holes = {world.ring(hole)};
    expect_proved(world, navigation, box(world, 10, 10, 18, 19));
    expect_proved(world, navigation, box(world, 2, 2, 6, 6));
    expect_proved(world, navigation, box(world, 20, -2, 25, 12));
    expect_wrong(world, navigation, box(world, 9.9, 10, 18, 19), inside_by);
    expect_wrong(world, navigation, box(world, 2, 1.95, 6, 6), inside_by);
    expect_wrong(world, navigation, box(world, -5, 8, 25, 9), inside_by);
    expect_wrong(world, navigation, box(world, -5, -5, 25, 25), inside_by);
    navigation.keep_out_zones[0].min_z_m = world.at(0, 0, 9).z();
    navigation.keep_out_zones[0].max_z_m = std::numeric_limits<double>::infinity();
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
    navigation.keep_in = {world.box({-10, -10, 0}, {0, 10, 20})};
    const double low = world.at(0, 0, 0).z(), high = world.at(0, 0, 20).z();
    navigation.keep_in_zones = {zone_of(world.ring({{0, -10}, {10, -10}, {10, 10}, {0, 10}}), low, high)};
    expect_proved(world, navigation, volume);
    navigation.keep_in_zones[0].outer = world.ring({{0.1, -10}, {10, -10}, {10, 10}, {0.1, 10}});
    expect_wrong(world, navigation, volume, outside_by);
    navigation.keep_in_zones[0].outer = world.ring({{-1, -10}, {10, -10}, {10, 10}, {-1, 10}});
    navigation.keep_in_zones[0].holes = {world.ring({{5, 5}, {6, 5}, {6, 6}, {5, 6}})};
    expect_wrong(world, navigation, volume, [](const Vec3& p) {
      return std::min(std::min(p.x() - 5, 6 - p.x()), std::min(p.y() - 5, 6 - p.y()));
    });
    navigation.keep_in_zones[0].holes.clear();
    expect_proved(world, navigation, volume);
    navigation.keep_in_zones[0].max_z_m = world.at(0, 0, 8.91).z();
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

/// Ground that rises to a ridge below the middle of the volume's bottom facets, which keep the height at all corners.
TEST(ProveLimits, HeightsAboveTerrain) {
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

/// Ground at 0 up to x = 0.37, and 2 lower beyond.
std::shared_ptr<Mesh> ground_with_a_step(const World& world) {
  auto surface = std::make_shared<Mesh>();
  surface->vertices = {world.at(-20, -20, 0),   world.at(0.37, -20, 0), world.at(0.37, 20, 0), world.at(-20, 20, 0),
                       world.at(0.37, -20, -2), world.at(20, -20, -2),  world.at(20, 20, -2),  world.at(0.37, 20, -2)};
  surface->triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return surface;
}

/// The volume has a wall straight above the step: on the border of both grounds, where the lower one counts.
TEST(ProveLimits, TerrainWithAStep) {
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
TEST(ProveLimits, TerrainWithAStepInLayers) {
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

/// Where a deck lies over other ground nothing keeps the heights of both. A fin straight below the side that two of its
/// triangles share is as near to the lower ground alone as one at the deck's border is.
TEST(ProveLimits, TerrainUnderADeck) {
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
TEST(ProveLimits, TerrainOfNarrowStrips) {
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
TEST(ProveLimits, TerrainOfTwoNarrowStrips) {
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

/// The tip of a sliver of lower ground lies at the end of a side of the upper one. Its sides, moved out by the
/// tolerance, meet many metres beyond the tip.
TEST(ProveLimits, TerrainWithTheTipOfASliver) {
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
TEST(ProveLimits, TerrainWithASlot) {
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
TEST(ProveLimits, TerrainBelowOneCorner) {
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
TEST(ProveLimits, TerrainWithASummit) {
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
TEST(ProveLimits, RandomTerrain) {
  const World world;
  testing::Random random(71);
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

TEST(ProveLimits, TerrainInLayersAndAPlane) {
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
  navigation.keep_out_zones = {zone};
  EXPECT_EQ(claim_of(world, navigation, world.mesh({-5, -5, 1}, {5, 5, 8})).verdict, ProofVerdict::not_proved);
  expect_proved(world, navigation, world.mesh({9, -5, 1}, {15, 5, 8}));
  navigation = {};
  navigation.keep_in_zones = {zone};
  expect_proved(world, navigation, world.mesh({-9, -5, 20}, {9, 5, 40}));
  expect_wrong(world, navigation, world.mesh({-9, -5, 19.9}, {9, 5, 40}), [](const Vec3& p) { return 20 - p.z(); });
  expect_wrong(world, navigation, world.mesh({-9, -5, 20}, {9.1, 5, 40}), [](const Vec3& p) { return p.x() - 9; });
  navigation.keep_in = {world.box({20, 20, 0}, {30, 30, 9})};
  EXPECT_EQ(claim_of(world, navigation, world.mesh({-9, -5, 20}, {9, 5, 40})).verdict, ProofVerdict::not_proved);
}

/// What cut_to_navigation leaves keeps the limits.
TEST(ProveLimits, WhatWasCutIsProved) {
  const World world;
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{1.1, 8.7};
  navigation.keep_in_zones = {zone_of({{-30, -25}, {28, -31}, {33, 27}, {-29, 34}}, -5, 50)};
  navigation.keep_out = {Box{{-8, -8, 3}, {-6, -6, 5}}};
  navigation.keep_out_zones = {zone_of({{3, 3}, {12, 5}, {6, 6}, {7, 14}}, -5, 6)};
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
  navigation.keep_out_zones = {zone_of({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, 0, 5)};
  navigation.keep_out_zones[0].above_ground = AboveGround{10, 20, {0, nullptr}};
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
  navigation.keep_in_zones = {zone_of({{0, 0}, {1, 1}}, 0, 9)};
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
