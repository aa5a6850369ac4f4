// A mission that is moved to map coordinates, turned, scaled, or whose triangles are split and shuffled asks for the
// same volume: for every limit of the sensor and of navigation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "support/limit_samples.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::LimitDraw;
using testing::LimitSample;
using testing::LimitWorld;
using testing::MeshProbe;
using testing::Motion;
using testing::moved;
using testing::Random;
using testing::SceneBuilder;
using testing::Turns;

constexpr double kRangeOfMoved = 40, kToleranceOfMoved = 0.1;  // metres, before scaling

/// Each triangle in two along its first side, in any order, with corners of its own, any of them first.
Mesh split_and_shuffled(const Mesh& mesh, Random& random, std::vector<std::uint32_t>& object_of) {
  std::vector<std::pair<std::array<Vec3, 3>, std::uint32_t>> parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k], middle = (a + b) / 2;
    const std::uint32_t object = object_of.empty() ? 0 : object_of[t];
    parts.push_back({{a, middle, c}, object});
    parts.push_back({{middle, b, c}, object});
  }
  for (std::size_t i = parts.size(); i > 1; --i) {
    std::swap(parts[i - 1], parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  }
  Mesh result;
  object_of.clear();
  for (auto& [corners, object] : parts) {
    std::rotate(corners.begin(), corners.begin() + random.integer(0, 2), corners.end());
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.insert(result.vertices.end(), corners.begin(), corners.end());
    result.triangles.push_back({first, first + 1, first + 2});
    object_of.push_back(object);
  }
  return result;
}

LimitWorld split_and_shuffled(const LimitWorld& world, Random& random) {
  LimitWorld result = world;
  result.scene.mesh = split_and_shuffled(world.scene.mesh, random, result.scene.object_of);
  std::vector<std::uint32_t> unused;
  testing::change_soups(result.navigation, [&](const Mesh& mesh) { return split_and_shuffled(mesh, random, unused); });
  return result;
}

/// Blocks of odd sizes about the target, and a sheet over some of it.
Scene draw_scene(Random& random) {
  SceneBuilder builder;
  for (int i = 0; i < 4; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), away = random.uniform(9, 24);
    const Vec3 low(away * std::cos(angle), away * std::sin(angle), random.uniform(-2, 3));
    builder.box("block", low, low + random.point(2, 14));
  }
  const Vec3 at = random.point(-12, 12).cwiseProduct(Vec3(1, 1, 0)) + Vec3(0, 0, 16);
  builder.polygon("sheet", {at, at + random.point(-5, 5), at + random.point(-5, 5)});
  return builder;
}

/// Every way to draw a limit, and what else bounds a volume. In this order: the place of each is its seed.
const std::vector<LimitDraw>& limits() {
  static const std::vector<LimitDraw> kLimits = [] {
    std::vector<LimitDraw> all = {{"max_range", Turns::all, 0, true, [](LimitWorld&, Random&) {}}};
    const auto add = [&](bool is_of_navigation) {
      for (const LimitSample& sample : testing::limit_samples()) {
        if (testing::is_of_navigation(sample.limit) != is_of_navigation) continue;
        all.insert(all.end(), sample.draws.begin(), sample.draws.end());
      }
    };
    add(false);
    all.push_back({"link", Turns::all, 2e-2, false, [](LimitWorld& w, Random& r) {
                     w.target.parts = {{Vec3(0, 0, 0.7)}};
                     w.target.front.reset();
                     w.sensor.link = {r.uniform(1, 30), r.uniform(0.3, 1)};
                   }});
    all.push_back({"visible", Turns::all, 1e-2, false, [](LimitWorld& w, Random&) {
                     w.sensor.visible = VisibleShare{0.6, 4};
                   }});
    add(true);
    return all;
  }();
  return kLimits;
}

Eigen::Matrix3d draw_turn(Turns turns, Random& random) {
  if (turns == Turns::quarters) {
    Eigen::Matrix3d quarter;
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return random.chance(0.5) ? quarter : Eigen::Matrix3d(quarter * quarter);
  }
  const Vec3 axis = turns == Turns::all ? random.direction() : Vec3::UnitZ();
  return Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), axis).toRotationMatrix();
}

class MovedLimits : public ::testing::TestWithParam<std::size_t> {
 protected:
  const LimitDraw& limit() const { return limits()[GetParam()]; }

  LimitWorld draw(Random& random) const {
    LimitWorld world;
    world.scene = draw_scene(random);
    const int corners = random.integer(3, 6);
    const double radius = random.uniform(1, 3);
    world.target = testing::random_target(random, corners, radius, Vec3::Zero(), Vec3(0, 0, 1));
    world.target.front = Vec3(0, 0, 1);
    world.sensor.max_range_m = kRangeOfMoved;
    limit().add(world, random);
    return world;
  }

  /// Whether a draw has an obstacle in the target.
  static bool is_pierced(const LimitWorld& world) {
    try {
      static_cast<void>(PreparedTarget(PreparedScene(world.scene), world.target, world.sensor));
      return false;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::target_pierced) throw;
      return true;
    }
  }

  Volume compute(const LimitWorld& world, double scale) const {
    const PreparedTarget target(PreparedScene(world.scene), world.target, world.sensor);
    return compute_volume(target, world.navigation, {.tolerance_m = scale * kToleranceOfMoved});
  }

  /// No point inside, deeper than is stated, is outside for PointQuery, and the proof agrees.
  void expect_right(const LimitWorld& world, const Volume& volume, Random& random) const;
  /// The two are within the stated bound of each other, and of the same size.
  void expect_same(const Volume& base, const Volume& other, const Motion& motion, Random& random) const;
};

void MovedLimits::expect_right(const LimitWorld& world, const Volume& volume, Random& random) const {
  EXPECT_EQ(first_open_edge(volume.mesh), "");
  const MeshProbe probe(volume);
  const Vec3 centre = make_target_frame(world.target).origin;
  const double largest = std::max(probe.bounds().min.cwiseAbs().maxCoeff(), probe.bounds().max.cwiseAbs().maxCoeff());
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * largest;
  std::vector<Vec3> points;
  for (int i = 0; i < 400 && points.size() < 120; ++i) {
    const auto t = static_cast<std::size_t>(random.integer(0, static_cast<int>(volume.mesh.triangles.size()) - 1));
    const auto& [a, b, c] = volume.mesh.triangles[t];
    const auto& v = volume.mesh.vertices;
    const double u = random.uniform(0, 1);
    const Vec3 on = v[a] + u * (v[b] - v[a]) + random.uniform(0, 1 - u) * (v[c] - v[a]);
    const Vec3 normal = (v[b] - v[a]).cross(v[c] - v[a]);
    if (!(normal.norm() > 0)) continue;
    const double depth = 1e-6 * (on - centre).norm() + rounding;
    const Vec3 inside = on - 2 * depth * normal.normalized();
    if (probe.holds(inside) && probe.depth(inside) > depth) points.push_back(inside);
  }
  EXPECT_GT(points.size(), 20u);
  const PreparedTarget target(PreparedScene(world.scene), world.target, world.sensor);
  const std::vector<PointAnswer> answers = query_points(target, world.navigation, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(answers[i].inside) << points[i].transpose() << ", " << probe.depth(points[i]) << " m inside: "
                                   << (answers[i].outside_of.empty() ? "sight" : answers[i].outside_of[0]);
  }
  if (!limit().has_proof) return;
  const ProofReport report =
      prove_volume(world.scene, world.target, world.sensor, world.navigation, volume.mesh, {.lift_m = volume.lift_m});
  for (const ClaimProof& claim : report.claims) {
    EXPECT_EQ(claim.verdict, ProofVerdict::proved) << claim.name << ": " << claim.text;
  }
}

void MovedLimits::expect_same(const Volume& base, const Volume& other, const Motion& motion, Random& random) const {
  const double apart = 2 * kToleranceOfMoved + limit().apart * kRangeOfMoved;
  const double size = enclosed_volume(base.mesh);
  const double found = enclosed_volume(other.mesh) / (motion.scale * motion.scale * motion.scale);
  EXPECT_NEAR(size, found, apart * surface_area(base.mesh)) << "cubic metres";
  const MeshProbe one(base), two(other);
  for (int i = 0; i < 150; ++i) {
    const Vec3 p = random.in_box(one.bounds());
    const double depth = one.depth(p), depth_there = two.depth(motion.of(p)) / motion.scale;
    if (std::abs(depth) > apart || std::abs(depth_there) > apart) {
      EXPECT_GT(depth * depth_there, 0) << p.transpose();
    }
  }
}

TEST_P(MovedLimits, AskForTheSameVolume) {
  SCOPED_TRACE(limit().name);
  Random random(1009 + GetParam());
  int computed = 0;
  for (int draw_number = 0; draw_number < 3; ++draw_number) {
    const LimitWorld world = draw(random);
    if (is_pierced(world)) continue;
    const Volume base = compute(world, 1);
    if (base.outcome != Outcome::computed) continue;
    ++computed;
    expect_right(world, base, random);
    const LimitWorld split = split_and_shuffled(world, random);
    const Volume of_split = compute(split, 1);
    ASSERT_EQ(of_split.outcome, Outcome::computed) << of_split.reason;
    expect_right(split, of_split, random);
    expect_same(base, of_split, {"split"}, random);
    const Eigen::Matrix3d turn = draw_turn(limit().turns, random);
    const Vec3 map(-3e6, 4.7e6, 0), other_map(5.8e5 + 0.1, 4.785e6 + 0.2, 1000.3);
    const std::vector<Motion> motions = {
        {"map", 1, Eigen::Matrix3d::Identity(), map},
        {"turned, map", 1, turn, other_map},
        {"turned", 1, turn, Vec3::Zero()},
        {"small", 1e-3, turn, Vec3::Zero()},
        {"small, map", 0.1, turn, map},  // smaller: see what volume.h says of roundings
        {"large", 1e2, Eigen::Matrix3d::Identity(), other_map},
        {"huge", 1e4, turn, Vec3::Zero()}};
    for (const Motion& motion : motions) {
      SCOPED_TRACE(motion.name);
      const LimitWorld there = moved(world, motion);
      if (there.sensor.link && there.sensor.link->frequency_ghz > 3000) continue;  // none is higher
      const Volume volume = compute(there, motion.scale);
      ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
      expect_right(there, volume, random);
      expect_same(base, volume, motion, random);
    }
  }
  EXPECT_GT(computed, 0);
}

INSTANTIATE_TEST_SUITE_P(All, MovedLimits, ::testing::Range(std::size_t{0}, limits().size()));

}  // namespace
}  // namespace vantage
