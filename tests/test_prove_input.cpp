// What proofs are given: scenes, targets and limits that are wrong in themselves, meshes with flaps, and callers that
// stop them. Nothing of it may be called proved, or wrong, that is not.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "support/progress_check.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::expect_code;
using testing::make_box_mesh;
using testing::SceneBuilder;
using testing::zone_of;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A square on the ground, a wall beside it, and a box over the square.
struct Yard {
  Scene scene = SceneBuilder().ground("ground", 60).box("wall", {10, -6, 0}, {11, 6, 9});
  Target target = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  Sensor sensor{.max_range_m = 50};
  Navigation navigation = {};
  Mesh volume = make_box_mesh({-3, -3, 1}, {3, 3, 6});

  ProofReport prove(const ProveOptions& options = {}, const Progress& progress = {}) const {
    return prove_volume(scene, target, sensor, navigation, volume, options, progress);
  }
};

ProofVerdict verdict_on(const ProofReport& report, const std::string& claim) {
  for (const ClaimProof& one : report.claims) {
    if (one.name == claim) return one.verdict;
  }
  ADD_FAILURE() << "there is no claim " << claim;
  return ProofVerdict::not_proved;
}

TEST(ProveInput, TargetsAndScenesThatAreWrongInThemselvesAreRefused) {
  const Yard yard;
  ASSERT_EQ(yard.prove().verdict(), ProofVerdict::proved);
  Yard without = yard;
  without.target.parts.clear();
  expect_code([&] { without.prove(); }, ErrorCode::target_parts_invalid);
  for (const double lift : {kNaN, std::numeric_limits<double>::infinity(), -1e-6, 0.011}) {
    expect_code([&] { yard.prove({.lift_m = {lift}}); }, ErrorCode::value_out_of_range);
  }
  Yard broken = yard;
  broken.scene.mesh.vertices[5].y() = kNaN;
  expect_code([&] { broken.prove(); }, ErrorCode::coordinate_not_finite);
  broken = yard;
  broken.scene.mesh.vertices[5].y() = 1e150;  // exact predicates would overflow
  expect_code([&] { broken.prove(); }, ErrorCode::coordinate_too_large);
  broken = yard;
  broken.scene.mesh.triangles[1][2] = 1000;
  expect_code([&] { broken.prove(); }, ErrorCode::index_out_of_range);
  broken = yard;
  broken.scene.object_of.pop_back();
  expect_code([&] { broken.prove(); }, ErrorCode::array_sizes_differ);
}

TEST(ProveInput, LimitsThatBoundNothingAreRefused) {
  Yard yard;
  yard.navigation.meshes = {{make_box_mesh({-4, -4, 0}, {4, 4, 7}), "hall"}};
  ASSERT_EQ(yard.prove().verdict(), ProofVerdict::proved);
  Mesh& hall = yard.navigation.meshes[0].mesh;
  const Mesh closed = hall;
  hall.triangles.pop_back();
  expect_code([&] { yard.prove(); }, ErrorCode::mesh_not_closed);
  hall.triangles = {closed.triangles[0]};
  expect_code([&] { yard.prove(); }, ErrorCode::mesh_not_closed);
  hall = closed;
  for (Triangle& t : hall.triangles) std::swap(t[0], t[1]);
  expect_code([&] { yard.prove(); }, ErrorCode::mesh_inside_out);
  yard.navigation = {};
  yard.navigation.keep_out = {zone_of({{-20, -20}, {20, 20}, {20, -20}, {-20, 20}}, 0, 9)};  // crosses itself
  expect_code([&] { yard.prove(); }, ErrorCode::zone_not_simple);
  yard.navigation.keep_out = {zone_of({{20, 20}, {30, 20}, {30, kNaN}}, 0, 9)};
  expect_code([&] { yard.prove(); }, ErrorCode::coordinate_not_finite);
  const std::vector<std::pair<Zone::Ring, std::vector<Zone::Ring>>> bad = {
      {{{20, 20}, {30, 20}}, {}},                                          // two corners
      {{{20, 20}, {30, 20}, {30, 20}, {30, 30}}, {}},                      // one twice
      {{{20, 20}, {30, 20}, {25, 20}, {25, 30}}, {}},                      // runs back
      {{{20, 20}, {40, 20}, {40, 40}, {30, 20}, {20, 40}}, {}},            // touches its own side
      {{{20, 20}, {40, 20}, {40, 40}}, {{{20, 38}, {22, 38}, {22, 39}}}},  // a hole outside
      {{{20, 20}, {40, 20}, {40, 40}}, {{{30, 21}, {38, 21}, {45, 24}}}},  // a hole that sticks out
      {{{0, 20}, {40, 20}, {40, 60}, {0, 60}},
       {{{5, 25}, {30, 25}, {30, 50}, {5, 50}}, {{10, 30}, {20, 30}, {20, 40}}}}};  // a hole in a hole
  for (const auto& [outer, holes] : bad) {
    Zone zone = zone_of(outer, 0, 9);
    zone.holes = holes;
    yard.navigation.keep_out = {zone};
    expect_code([&] { yard.prove(); }, ErrorCode::zone_not_simple);
  }
  Zone ring = zone_of({{20, 20}, {40, 20}, {40, 40}, {20, 40}}, 0, 9);
  ring.holes = {{{22, 22}, {26, 22}, {26, 26}}, {{30, 30}, {30, 35}, {35, 35}}};
  yard.navigation.keep_out = {ring};
  EXPECT_EQ(verdict_on(yard.prove(), "keep_out"), ProofVerdict::proved);
  yard.navigation = {};
  yard.navigation.above_ground = AboveGround{1, 7, {kNaN, nullptr}};
  expect_code([&] { yard.prove(); }, ErrorCode::value_out_of_range);
}

/// The base of the volume lies in the target's plane, over its middle: whether the middle is inside cannot be told, and
/// the way to it leaves through no facet that faces it.
TEST(ProveInput, AFrameIsNotProvedOfAVolumeThatTouchesTheTarget) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      for (const bool is_turned : {false, true}) {
        const auto place = [&](double across, double up, double along) {
          Vec3 at = Vec3::Zero();
          at[axis] = side * along;
          at[(axis + 1) % 3] = across;
          at[(axis + 2) % 3] = up;
          return at;
        };
        Target target =
            Target::polygon({place(-0.5, -0.5, 0), place(0.5, -0.5, 0), place(0.5, 0.5, 0), place(-0.5, 0.5, 0)});
        target.front = place(0, 0, 1);
        Mesh mesh{{place(-2, -2, 0), place(3, -1, 0), place(-1, 3, 0), place(0, 0, 10)}, {}};
        mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
        if (is_turned) std::swap(mesh.vertices[0], mesh.vertices[1]);
        if (enclosed_volume(mesh) < 0) {
          for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
        }
        const Sensor sensor{.max_range_m = 60, .camera = pinhole_of_fov(30, 20)};
        const ProofReport report = prove_volume(Scene{}, target, sensor, {}, mesh);
        EXPECT_EQ(verdict_on(report, "frame"), ProofVerdict::not_proved) << axis << " " << side << " " << is_turned;
      }
    }
  }
}

/// Two facets on each other, out to a place behind the wall, out of range, below an altitude: nothing lies between
/// them.
TEST(ProveInput, WhatAFlapReachesIsNotCalledWrong) {
  const Yard yard;
  const auto with_flap = [&](const Vec3& tip) {
    Yard flapped = yard;
    Mesh& mesh = flapped.volume;
    const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(tip);
    const auto [a, b, c] = mesh.triangles.front();
    mesh.triangles.push_back({a, b, end});
    mesh.triangles.push_back({b, a, end});
    return flapped;
  };
  const ProofReport hidden = with_flap({20, 1, 2}).prove();
  EXPECT_NE(verdict_on(hidden, "sight"), ProofVerdict::wrong);
  EXPECT_FALSE(hidden.witness);
  EXPECT_EQ(verdict_on(with_flap({0, 0, 51}).prove(), "range"), ProofVerdict::not_proved);
  EXPECT_EQ(verdict_on(with_flap({0, 0, -1}).prove(), "front"), ProofVerdict::not_proved);
  Yard low = with_flap({0, 0, 0.5});
  low.navigation.altitude = Navigation::Altitude{1, 6};
  EXPECT_EQ(verdict_on(low.prove(), "altitude"), ProofVerdict::not_proved);
  // A thin piece in the same place is part of the volume.
  Yard thin = yard;
  const auto first = static_cast<std::uint32_t>(thin.volume.vertices.size());
  thin.volume.vertices.insert(thin.volume.vertices.end(),
                              {Vec3(3, 3, 1), Vec3(20, 1, 2), Vec3(20, 1.001, 2), Vec3(20, 1, 2.001)});
  for (const Triangle& t : {Triangle{0, 2, 1}, Triangle{0, 3, 2}, Triangle{0, 1, 3}, Triangle{1, 2, 3}}) {
    thin.volume.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  EXPECT_EQ(verdict_on(thin.prove(), "sight"), ProofVerdict::wrong);
}

TEST(ProveInput, RangeAndFrontSayWhereTheyAreBroken) {
  Yard yard;
  yard.sensor.max_range_m = 6.5;  // the corners of the box are farther from those of the square
  const ProofReport report = yard.prove();
  for (const ClaimProof& claim : report.claims) {
    if (claim.name != "range") continue;
    EXPECT_EQ(claim.verdict, ProofVerdict::wrong);
    ASSERT_TRUE(claim.place);
    double farthest = 0;
    for (const Vec3& corner : yard.target.parts[0]) farthest = std::max(farthest, (corner - *claim.place).norm());
    EXPECT_NEAR(claim.broken_by_m, farthest - 6.5, 1e-4);
    EXPECT_GT(claim.broken_by_m, 0.1);
  }
  // Exactly at the range: numbers cannot tell.
  const double exactly = Vec3(4, 4, 6).norm();
  yard.sensor.max_range_m = std::nextafter(exactly, 0);
  EXPECT_NE(verdict_on(yard.prove({.shrink = 0}), "range"), ProofVerdict::wrong);
  // Behind by less than the file's rounding: proved of the volume less a layer; nothing is known of the view from
  // there.
  Yard rounded;
  rounded.volume = make_box_mesh({-3, -3, -5e-7}, {3, 3, 6});
  EXPECT_EQ(verdict_on(rounded.prove({.rounding_m = 1e-6}), "front"), ProofVerdict::proved);
  EXPECT_NEAR(rounded.prove({.rounding_m = 1e-6}).layer_m, 5e-7, 1e-12);
  EXPECT_EQ(verdict_on(rounded.prove(), "front"), ProofVerdict::wrong);
  // No file's numbers are rounded by more than single precision is, whatever it says.
  rounded.volume = make_box_mesh({-3, -3, -1e-5}, {3, 3, 6});
  EXPECT_LT(rounded.prove({.rounding_m = 1}).rounding_m, 2e-6);
  EXPECT_EQ(verdict_on(rounded.prove({.rounding_m = 1}), "front"), ProofVerdict::wrong);
  // Cuts of large volumes leave corners within some 1e-12 of their size of the plane.
  Yard large;
  large.sensor.max_range_m = 3e4;
  large.volume = make_box_mesh({-3, -3, -3e-8}, {3, 3, 2e4});
  EXPECT_EQ(verdict_on(large.prove(), "front"), ProofVerdict::proved);
  EXPECT_NEAR(large.prove().layer_m, 3e-8, 1e-10);
  large.volume = make_box_mesh({-3, -3, -3e-6}, {3, 3, 2e4});
  EXPECT_EQ(verdict_on(large.prove(), "front"), ProofVerdict::wrong);
}

TEST(ProveInput, FollowsItsCaller) {
  Yard yard;
  yard.volume = make_box_mesh({-3, -3, 1}, {30, 3, 6});  // reaches behind the wall
  yard.navigation.clearance = Clearance{1, obstacles_of(yard.scene)};
  const testing::ProgressStory story =
      testing::check_progress([&](const Progress& progress) { yard.prove({.maximal = true}, progress); });
  EXPECT_EQ(story.stages, std::vector<std::string>{"prove"});
}

}  // namespace
}  // namespace vantage
