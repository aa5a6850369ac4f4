// Geometry that all but touches the target: walls that stand on its outline, or a hair over its plane, at any size and
// at map coordinates. The mesh against the exact answers of query, and against the scene without the hair.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Random;
using testing::target_of;

/// Turns what is drawn about the origin, z up, and moves it elsewhere.
struct Pose {
  std::string name;
  Eigen::Matrix3d turn;
  Vec3 shift;
  Vec3 operator()(const Vec3& p) const { return turn * p + shift; }
};

std::vector<Pose> poses(const Vec3& shift, const std::string& where) {
  const auto about = [](double angle, const Vec3& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  };
  const Eigen::Matrix3d upright = about(std::numbers::pi / 2, {1, 0, 0});
  return {{"level" + where, Eigen::Matrix3d::Identity(), shift},
          {"sloped" + where, about(0.35, {0.3, 1, 0}), shift},
          {"upright" + where, upright, shift},
          {"upright, turned" + where, about(0.7, {0, 0, 1}) * upright, shift}};
}

const Vec3 kOrigin(0, 0, 0), kMap(5e5, 5e6, 30);

/// A square, a triangle and a hexagon about the origin, some 4 m in radius.
std::vector<std::vector<Vec3>> outlines() {
  std::vector<std::vector<Vec3>> all;
  for (const int corners : {4, 3, 6}) {
    std::vector<Vec3>& outline = all.emplace_back();
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / corners;
      outline.emplace_back(4 * std::cos(angle), 4 * std::sin(angle), 0);
      if (corners == 4) outline.back() = {std::copysign(3, std::cos(angle)), std::copysign(3, std::sin(angle)), 0};
    }
  }
  return all;
}

/// Where a wall stands: on edge `edge` of the outline, its base `base` over the plane and `inward` inside the edge, as
/// long as the edge and `overhang` more at either end. Metres, before the pose and the scale.
struct Wall {
  std::size_t edge;
  double overhang, base, inward;
};

struct Case {
  Target target;
  Scene scene;
  double range;
};

/// `wall` is in metres of the world as scaled, but for its overhang.
Case make_case(const std::vector<Vec3>& outline, const Pose& pose, double scale, const Wall& wall) {
  Case made;
  made.range = 50 * scale;
  for (const Vec3& t : outline) made.target.parts[0].push_back(pose(scale * t));
  made.target.front = pose.turn * Vec3::UnitZ();
  const Vec3 a = scale * outline[wall.edge], b = scale * outline[(wall.edge + 1) % outline.size()];
  const Vec3 along = (b - a).normalized(), in = Vec3(-along.y(), along.x(), 0) * wall.inward;
  const Vec3 from = a - wall.overhang * scale * along + in, to = b + wall.overhang * scale * along + in;
  const Vec3 low(0, 0, wall.base), high(0, 0, 5 * scale);
  made.scene =
      testing::SceneBuilder().polygon("wall", {pose(from + low), pose(to + low), pose(to + high), pose(from + high)});
  return made;
}

/// From the centre along `direction` to the mesh.
double reach_of_mesh(const Volume& volume, const Vec3& direction) {
  double reach = 0;
  for (const Triangle& t : volume.mesh.triangles) {
    const Vec3 a = volume.mesh.vertices[t[0]] - volume.frame.origin,
               b = volume.mesh.vertices[t[1]] - volume.frame.origin,
               c = volume.mesh.vertices[t[2]] - volume.frame.origin;
    if (a.cross(b).dot(direction) < 0 || b.cross(c).dot(direction) < 0 || c.cross(a).dot(direction) < 0) continue;
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.dot(direction) > 0) reach = std::max(reach, normal.dot(a) / normal.dot(direction));
  }
  return reach;
}

struct Agreement {
  double over = 0, under = 0;  ///< how far the mesh is beyond what query says, and short of it, in parts of that
};

/// Along some directions, most of them near the target's plane. Where the range ends the view the mesh may be short by
/// its tolerance.
Agreement compare_with_query(const PreparedScene& scene, const Case& made, const Volume& volume) {
  constexpr int kDirections = 40;
  const TargetFrame& frame = volume.frame;
  std::vector<Vec3> points;
  std::vector<double> reaches;
  for (int i = 0; i < kDirections; ++i) {
    const double height = std::pow((i + 0.5) / kDirections, 1.7), angle = 2.399963 * i;
    const double across = std::sqrt(1 - height * height);
    const Vec3 direction =
        across * std::cos(angle) * frame.axis_u + across * std::sin(angle) * frame.axis_v + height * frame.normal;
    reaches.push_back(reach_of_mesh(volume, direction));
    points.emplace_back(frame.origin + 0.5 * reaches.back() * direction);
  }
  const auto answers = query_points(PreparedTarget(scene, made.target, {made.range}), {}, points);
  Agreement worst;
  for (int i = 0; i < kDirections; ++i) {
    const double seen = answers[i].margin_m + (points[i] - frame.origin).norm();
    worst.over = std::max(worst.over, reaches[i] / seen - 1);
    if (seen < 0.8 * made.range) worst.under = std::max(worst.under, 1 - reaches[i] / seen);
  }
  return worst;
}

Volume compute(const PreparedScene& scene, const Case& made) {
  Volume volume = compute_visibility(PreparedTarget(scene, made.target, {made.range}), {1e-3 * made.range, 0});
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures m = measure(volume.mesh);
  EXPECT_TRUE(m.closed && m.oriented && m.euler == 2 && m.pieces == 1);
  return volume;
}

/// Bases from nothing to a tenth of a millimetre over the plane, in parts of a world of metres: nothing is lost that
/// the wall leaves when it stands on the plane, and query and mesh agree.
TEST(NearPlane, WallsAHairOverTheTarget) {
  for (const double scale : {1e-3, 1e-1, 1.0, 1e2, 1e4}) {
    for (const Vec3& shift : {kOrigin, kMap}) {
      const bool on_map = shift != kOrigin;
      if (on_map && scale < 1) continue;  // coordinates are a nanometre apart there
      for (const Pose& pose : poses(shift, on_map ? ", on a map" : "")) {
        for (const auto& outline : outlines()) {
          for (std::size_t edge = 0; edge < outline.size(); edge += 2) {
            const double overhang = edge % 4 == 0 ? 7 : 0;
            double whole = 0;
            for (const double base : {0.0, 1e-10, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6, 1e-4}) {
              SCOPED_TRACE(pose.name + ", " + std::to_string(outline.size()) + " corners, edge " +
                           std::to_string(edge));
              SCOPED_TRACE(::testing::Message() << "scale " << scale << ", base " << base);
              const Case made = make_case(outline, pose, scale, {edge, overhang, base * scale, 0});
              const PreparedScene scene(made.scene);
              const Volume volume = compute(scene, made);
              const double size = enclosed_volume(volume.mesh) / std::pow(scale, 3);
              if (base == 0) whole = size;
              EXPECT_NEAR(size, whole, (on_map ? 3e-5 : 3e-6) * whole + 2 * base * whole);
              const Agreement a = compare_with_query(scene, made, volume);
              EXPECT_LT(a.over, 1e-8);
              EXPECT_LT(a.under, 1e-6);
            }
          }
        }
      }
    }
  }
}

/// Nothing if the target is refused as pierced, 0 if the view is blocked at once.
std::optional<double> volume_of(const Scene& scene, const Target& target, double range) {
  try {
    const Volume volume = compute_visibility(PreparedTarget(PreparedScene(scene), target, {range}), {1e-3 * range, 0});
    return volume.outcome == Outcome::computed ? enclosed_volume(volume.mesh) : 0;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::target_pierced) << error.what();
    return std::nullopt;
  }
}

/// What reaches less than the slack into the outline stands on it, whatever its base: the strip that is given away.
/// What reaches ten times as far in hides what it hides.
TEST(NearPlane, WallsWithinTheSlackStandOnTheEdge) {
  struct World {
    Vec3 shift;
    double scale, slack;
  };
  for (const World& world : {World{kOrigin, 1e-3, 4e-12}, World{kOrigin, 1, 1e-9}, World{kMap, 1, 8.9e-9}}) {
    for (const Pose& pose : poses(world.shift, world.shift == kOrigin ? "" : ", on a map")) {
      for (const auto& outline : outlines()) {
        SCOPED_TRACE(pose.name + ", " + std::to_string(outline.size()) + " corners, scale " +
                     std::to_string(world.scale));
        const auto volume = [&](double base, double inward) {
          const Case made = make_case(outline, pose, world.scale, {1, 0, base * world.slack, inward * world.slack});
          return volume_of(made.scene, made.target, made.range);
        };
        const std::optional<double> whole = volume(0, 0);
        ASSERT_TRUE(whole);
        for (const double base : {0.0, 2.0, 30.0}) {
          const std::optional<double> in_strip = volume(base, 0.4);
          ASSERT_TRUE(in_strip) << base;
          EXPECT_NEAR(*in_strip, *whole, 2e-4 * *whole) << base;
        }
        EXPECT_FALSE(volume(0, 10)) << "pierced";
        const std::optional<double> inside = volume(10, 10);  // hides the strip from all that is above 45 degrees
        ASSERT_TRUE(inside);
        EXPECT_LT(*inside, 0.8 * *whole);
      }
    }
  }
}

/// A few walls on, beside and just inside the target's edges, ground, and a block; some of it a hair over the plane.
Scene world(Random& random, const std::vector<Vec3>& outline) {
  const auto any = [&](std::initializer_list<double> values) {
    return *(values.begin() + random.integer(0, static_cast<int>(values.size()) - 1));
  };
  testing::SceneBuilder scene;
  if (random.chance(0.5)) scene.ground("ground", 60, any({0, 0, -1e-3}));
  for (int k = random.integer(1, 3); k > 0; --k) {
    const auto edge = static_cast<std::size_t>(random.integer(0, static_cast<int>(outline.size()) - 1));
    const double base = any({0, 3e-8, 1e-6, 1e-4, 1e-2});
    const double inward = any({0, 0, -1e-6, -1e-2, base > 0 ? 3e-8 : 0, base > 0 ? 1e-5 : 0});
    const Pose identity{"", Eigen::Matrix3d::Identity(), kOrigin};
    scene.add("wall", make_case(outline, identity, 1, {edge, any({-0.5, 0, 7}), base, inward}).scene.mesh);
  }
  const Vec3 corner(random.uniform(5, 20), random.uniform(-9, 9), any({0, 1e-5, 2}));
  return scene.box("block", corner, corner + Vec3(4, 3, 6));
}

/// All lengths times the same factor: volumes go with its cube, and the same targets are refused.
TEST(NearPlane, SmallWorldsAreLikeLargeOnes) {
  Random random(71);
  int compared = 0;
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(draw);
    const std::vector<Vec3> outline = outlines()[static_cast<std::size_t>(draw % 3)];
    const Scene scene = world(random, outline);
    const std::optional<double> expected = volume_of(scene, target_of(outline), 50);
    for (const double scale : {1e-4, 1e-3, 1e-1, 1e2, 1e4}) {
      SCOPED_TRACE(scale);
      Scene scaled = scene;
      for (Vec3& v : scaled.mesh.vertices) v *= scale;
      Target target = target_of(outline);
      for (Vec3& v : target.parts[0]) v *= scale;
      const std::optional<double> found = volume_of(scaled, target, 50 * scale);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!found || *expected < 1e3) continue;  // a hand's breadth is one in large worlds only
      EXPECT_NEAR(*found / std::pow(scale, 3), *expected, 2e-4 * *expected);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace vantage
