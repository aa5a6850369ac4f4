// How far a target may be raised: never less than the engine raises it, and never over what is not its own surface.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Random;
using testing::SceneBuilder;

/// Polygons of all kinds about a place: near the plane and far above, level and steep, over the target and beside it.
Scene cluttered(Random& random, const Vec3& shift, double scale) {
  SceneBuilder builder;
  const auto at = [&](double x, double y, double z) { return Vec3(shift + scale * Vec3(x, y, z)); };
  if (random.chance(0.8)) {
    const double z = random.chance(0.5) ? 0 : random.uniform(-2e-3, 2e-3);
    builder.polygon("ground", {at(-9, -9, z), at(9, -9, z), at(9, 9, z), at(-9, 9, z)});
  }
  for (int k = random.integer(0, 6); k > 0; --k) {
    const double height = std::pow(10.0, random.uniform(-7, -2)) * (random.chance(0.3) ? -1 : 1);
    const double slope = random.chance(0.5) ? 0 : std::pow(10.0, random.uniform(-7, 0));
    const Vec3 middle = random.chance(0.6) ? Vec3::Zero() : random.point(-4, 4);
    const double half = std::pow(10.0, random.uniform(-4, 0.5));
    std::vector<Vec3> corners;
    for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -0.9}, {0.8, 1.0}}) {
      corners.push_back(at(middle.x() + half * x, middle.y() + half * y, height + slope * half * x));
    }
    builder.polygon("plate", corners);
  }
  return builder;
}

TEST(ProveLift, IsNotLessThanTheEngineRaises) {
  Random random(2201);
  std::size_t raised = 0, computed = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 shift = random.chance(0.3) ? Vec3(5e5, 5e6, 100) : Vec3(0, 0, 0);
    const double scale = random.chance(0.3) ? 0.05 : 1;
    const Scene scene = cluttered(random, shift, scale);
    const auto at = [&](double x, double y) { return Vec3(shift + scale * Vec3(x, y, 0)); };
    Target target;
    if (random.chance(0.5)) {
      target = testing::target_of({at(-1, -1), at(1, -1.1), at(0.9, 1)});
      target.front = Vec3(0, 0, 1);
    } else {
      target = Target::point(at(0, 0));
      if (random.chance(0.5)) target.front = Vec3(0, 0, 1);
    }
    const Sensor sensor{.max_range_m = 60 * scale};
    const double needed = lifts_needed_m(scene, target, sensor.max_range_m).at(0);
    // 2 mm and a few micrometres; for a point that is seen from all sides, to clear its slopes, 4 mm.
    const double most = (target.is_point() && !target.front ? 4e-3 : 2e-3) * std::min(1.0, sensor.max_range_m / 20);
    EXPECT_LE(needed, most + 2e-5) << "scene " << i;
    try {
      const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor));
      ++computed;
      if (volume.lift_m.at(0) > 0) ++raised;
      EXPECT_LE(volume.lift_m[0], needed) << "scene " << i;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::target_pierced);
    }
  }
  EXPECT_GT(computed, 100U);
  EXPECT_GT(raised, 50U);
}

/// A point on a ridge of 2 mm, and a cover 5.9 mm above it, which is no surface that the point lies on.
TEST(ProveLift, ACoverOverARidgeIsNotTheSurfaceOfAPoint) {
  const auto scene_with = [](double cover_m) {
    SceneBuilder builder;
    builder.ground("ground", 40);
    builder.polygon("ridge", {{-1, -1e-4, 1.99e-3}, {1, -1e-4, 1.99e-3}, {1, 1e-4, 1.99e-3}, {-1, 1e-4, 1.99e-3}});
    const double z = cover_m;
    if (z > 0) builder.polygon("cover", {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}});
    return builder.scene();
  };
  const Target point = Target::point(Vec3(0, 0, 0));
  const Sensor sensor{.max_range_m = 50};
  const double without = lifts_needed_m(scene_with(0), point, 50).at(0);
  EXPECT_NEAR(without, 3.99e-3, 1e-5);
  EXPECT_EQ(lifts_needed_m(scene_with(5.9e-3), point, 50).at(0), without);
  const Mesh volume = testing::make_box_mesh({-5, -5, 1}, {5, 5, 9});
  const auto sight = [&](const Scene& scene) {
    return prove_volume(scene, point, sensor, {}, volume, {.lift_m = {0.006}}).claims[0].verdict;
  };
  EXPECT_EQ(sight(scene_with(0)), ProofVerdict::proved);
  EXPECT_EQ(sight(scene_with(5.9e-3)), ProofVerdict::wrong);
  // Nor does the engine raise it over the cover: what it computes lies below.
  const Volume computed = compute_volume(PreparedTarget(PreparedScene(scene_with(5.9e-3)), point, sensor));
  EXPECT_LE(computed.lift_m.at(0), without);
}

TEST(ProveLift, VerticesThatNoTriangleHasAndTrianglesWithoutAreaAreNotThere) {
  Scene scene = SceneBuilder().ground("ground", 40);
  const Target target = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
  const double needed = lifts_needed_m(scene, target, 50).at(0);
  EXPECT_LT(needed, 1e-5);
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (const double x : {1.0, 2.0, 3.0}) scene.mesh.vertices.emplace_back(3e8 * x, 3e8 * x, 0);
  EXPECT_EQ(lifts_needed_m(scene, target, 50).at(0), needed);
  scene.mesh.triangles.push_back({first, first + 1, first + 2});
  scene.object_of.push_back(0);
  EXPECT_EQ(lifts_needed_m(scene, target, 50).at(0), needed);
  scene.mesh.vertices[first].y() = -3e8;  // one with area: numbers there are rounded by a micrometre
  EXPECT_GT(lifts_needed_m(scene, target, 50).at(0), needed);
  EXPECT_LT(lifts_needed_m(scene, target, 50).at(0), 0.005);
}

TEST(ProveLift, AllPartsAtOnceAndAsOneByOne) {
  Random random(2202);
  const Scene scene = testing::random_city(random, 30, 12);
  Target all;
  all.parts.clear();
  for (int k = 0; k < 20; ++k) {
    const Vec3 middle(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-1e-3, 1e-3));
    all.parts.push_back({middle + Vec3(-0.5, -0.5, 0), middle + Vec3(0.5, -0.5, 0), middle + Vec3(0, 0.5, 0)});
  }
  const std::vector<double> needed = lifts_needed_m(scene, all, 50);
  ASSERT_EQ(needed.size(), 20U);
  for (std::size_t part = 0; part < 20; ++part) {
    EXPECT_EQ(lifts_needed_m(scene, all.part(part), 50).at(0), needed[part]);
  }
  testing::check_progress([&](const Progress& progress) { lifts_needed_m(scene, all, 50, progress); });
}

}  // namespace
}  // namespace vantage
