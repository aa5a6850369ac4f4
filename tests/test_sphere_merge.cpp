// Joined facets: fewer, closed, close to those they replace, and never outside of them where that is promised.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "spheres/merge.h"
#include "spheres/sphere_mesh.h"
#include "support/brute_depth.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using spheres::bound_corners;
using spheres::join_centers;
using spheres::placed;
using spheres::StarMesh;
using testing::Random;

constexpr double kBallRange = 50, kMerge = 0.01;

/// Depths of a made-up city, or of a room with five walls.
std::vector<float> depths(const Mesh& mesh, const Vec3& from, int n, depth::Sampling sampling) {
  testing::BruteDepth renderer(mesh);
  const std::vector<Vec3> viewpoints{from};
  std::vector<float> kept;
  renderer.render({viewpoints, n, sampling, kBallRange},
                  [&](std::size_t, std::span<const float> w) { kept.assign(w.begin(), w.end()); });
  return kept;
}

Mesh room() {
  testing::SceneBuilder builder;
  builder.polygon("floor", {{-9, -8, -1.5}, {11, -8, -1.5}, {11, 7, -1.5}, {-9, 7, -1.5}});
  builder.polygon("east", {{11, -8, -1.5}, {11, 7, -1.5}, {11, 7, 6}, {11, -8, 6}});
  builder.polygon("west", {{-9, -8, -1.5}, {-9, 7, -1.5}, {-9, 7, 6}, {-9, -8, 6}});
  builder.polygon("north", {{-9, 7, -1.5}, {11, 7, -1.5}, {11, 7, 6}, {-9, 7, 6}});
  builder.polygon("south", {{-9, -8, -1.5}, {11, -8, -1.5}, {11, -8, 6}, {-9, -8, 6}});
  return builder.scene().mesh;
}

/// Where the ray from the origin leaves a mesh that is star-shaped about it.
double reach(const StarMesh& star, const Vec3& direction) {
  double farthest = 0;
  for (const Triangle& t : star.triangles) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = star.rays[t[i]];
    const Vec3 weight = corners.inverse() * direction;
    if (weight.minCoeff() >= -1e-9 * weight.cwiseAbs().maxCoeff() && weight.sum() > 0)
      farthest = std::max(farthest, 1 / weight.sum());
  }
  return farthest;
}

void expect_near(const StarMesh& plain, const StarMesh& merged, bool is_inward, Random& random) {
  for (int k = 0; k < 300; ++k) {
    const Vec3 direction = random.direction();
    const double before = reach(plain, direction), after = reach(merged, direction);
    ASSERT_GT(before, 0);
    EXPECT_LE(after, before * (1 + (is_inward ? 1e-9 : 1.01 * kMerge))) << direction.transpose();
    EXPECT_GE(after, before * (1 - (is_inward ? 2.1 : 1.1) * kMerge)) << direction.transpose();
  }
}

TEST(SphereMerge, MakesAWallOfFewFacets) {
  const int n = 48;
  const std::vector<float> nearest = depths(room(), {0, 0, 0}, n, depth::Sampling::nearest);
  const StarMesh plain = bound_corners({n, nearest}, kBallRange),
                 merged = bound_corners({n, nearest}, kBallRange, nullptr, kMerge);
  EXPECT_LT(merged.triangles.size() * 3, plain.triangles.size());
  const std::vector<float> centres = depths(room(), {0, 0, 0}, n, depth::Sampling::centers);
  const StarMesh joined = join_centers({n, centres}, kBallRange, kMerge);
  EXPECT_LT(joined.triangles.size() * 3, plain.triangles.size());
}

TEST(SphereMerge, StaysCloseAndInsideWhereThatIsPromised) {
  Random random(11);
  for (int round = 0; round < 6; ++round) {
    const Mesh mesh = round == 0 ? room() : testing::random_city(random, 8, 6).mesh;
    const Vec3 from = round == 0 ? Vec3(0.3, -0.2, 0.1) : Vec3(random.uniform(-3, 3), random.uniform(-3, 3), 0.5);
    const int n = random.integer(15, 24);
    const std::vector<float> nearest = depths(mesh, from, n, depth::Sampling::nearest);
    const std::vector<float> centres = depths(mesh, from, n, depth::Sampling::centers);
    const StarMesh bound = bound_corners({n, nearest}, kBallRange, nullptr, kMerge);
    const StarMesh joined = join_centers({n, centres}, kBallRange, kMerge);
    expect_near(bound_corners({n, nearest}, kBallRange), bound, true, random);
    expect_near(join_centers({n, centres}, kBallRange), joined, false, random);
    for (const StarMesh* star : {&bound, &joined}) {
      const MeshMeasures m = measure(placed(*star, {}).mesh);
      EXPECT_TRUE(m.closed && m.oriented);
      EXPECT_EQ(m.euler, 2);
    }
  }
}

// Rectangles of facets on the range sphere: chords lie in the ball, and not deeper than is allowed.
TEST(SphereMerge, FollowsTheRangeFromWithin) {
  Random random(12);
  for (const int n : {32, 40, 41}) {
    const std::vector<float> nothing(6 * static_cast<std::size_t>(n) * n, 0);
    const StarMesh ball = bound_corners({n, nothing}, kBallRange, nullptr, kMerge);
    EXPECT_LT(2 * ball.triangles.size(), 12U * n * n + 100);
    for (int k = 0; k < 500; ++k) {
      const double r = reach(ball, random.direction());
      EXPECT_LE(r, kBallRange);
      EXPECT_GE(r, kBallRange * (1 - 1.01 * kMerge));
    }
  }
}

TEST(SphereMerge, DropsWhatNoFacetUses) {
  StarMesh star;
  star.rays = {{1, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}};
  star.at_range = {0, 1, 1, 0};
  star.triangles = {{0, 2, 3}};
  spheres::drop_unused_vertices(star);
  EXPECT_EQ(star.rays, (std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(star.at_range, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(star.triangles.front(), (Triangle{0, 1, 2}));
}

}  // namespace
}  // namespace vantage
