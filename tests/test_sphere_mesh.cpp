// Depth cube maps as meshes: closed, genus 0, star-shaped, and the conservative ones inside what is seen.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "options/spheres_options.h"
#include "spheres/cube_grid.h"
#include "spheres/numerics.h"
#include "spheres/sphere_mesh.h"
#include "support/brute_depth.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using spheres::bound_corners;
using spheres::bound_lonlat;
using spheres::CubeMap;
using spheres::join_centers;
using spheres::join_lonlat;
using spheres::placed;
using spheres::Placement;
using spheres::StarMesh;
using testing::Random;

constexpr double kReach = 50;

struct Form {
  const char* name;
  bool is_bound;
  std::optional<std::array<int, 2>> grid;
  double merge = 0;
};
const Form kForms[] = {{"centers", false, {}},
                       {"corners", true, {}},
                       {"lonlat", false, std::array{9, 5}},
                       {"bound lonlat", true, std::array{9, 6}},
                       {"coarsest bound lonlat", true, std::array{3, 2}},
                       {"merged centers", false, {}, 0.02},
                       {"merged corners", true, {}, 0.02}};

StarMesh make(const Form& form, const CubeMap& cube, const Vec3* front = nullptr) {
  if (!form.grid)
    return form.is_bound ? bound_corners(cube, kReach, front, form.merge) : join_centers(cube, kReach, form.merge);
  return form.is_bound ? bound_lonlat(cube, *form.grid, kReach, front) : join_lonlat(cube, *form.grid, kReach);
}

std::vector<float> random_depths(Random& random, int n) {
  std::vector<float> inverse(6 * static_cast<std::size_t>(n) * n);
  for (float& w : inverse) {
    const int kind = random.integer(0, 9);
    w = kind == 0 ? 0 : kind == 1 ? INFINITY : kind == 2 ? 1e-3F : static_cast<float>(1 / random.uniform(0.01, 80));
  }
  return inverse;
}

void expect_sphere(const Mesh& mesh, const char* what) {
  const MeshMeasures m = measure(mesh);
  EXPECT_TRUE(m.closed && m.oriented) << what;
  EXPECT_EQ(m.euler, 2) << what;
  EXPECT_EQ(m.pieces, 1U) << what;
  EXPECT_GT(m.volume_m3, 0) << what;
}

/// How far the ray from the origin goes in a mesh that is star-shaped about it: the largest of what it hits.
double reach(const Mesh& mesh, const Vec3& direction) {
  double farthest = 0;
  for (const Triangle& t : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = mesh.vertices[t[i]];
    const Vec3 weight = corners.inverse() * direction;
    if (weight.minCoeff() >= -1e-9 * weight.cwiseAbs().maxCoeff() && weight.sum() > 0)
      farthest = std::max(farthest, 1 / weight.sum());
  }
  return farthest;
}

TEST(SphereMesh, HasTheStatedNumbersOfVerticesAndFacets) {
  for (const int n : {1, 2, 3, 8}) {
    const std::vector<float> nothing(6 * static_cast<std::size_t>(n) * n, 0);
    const StarMesh centers = join_centers({n, nothing}, kReach), corners = bound_corners({n, nothing}, kReach);
    EXPECT_EQ(centers.rays.size(), 6U * n * n);
    EXPECT_EQ(centers.triangles.size(), 12U * n * n - 4);
    EXPECT_EQ(corners.rays.size(), 6U * n * n + 2);
    EXPECT_EQ(corners.triangles.size(), 12U * n * n);
  }
  const std::vector<float> nothing(6 * 4 * 4, 0);
  const StarMesh grid = join_lonlat({4, nothing}, {160, 80}, kReach);
  EXPECT_EQ(grid.rays.size(), 160U * 79 + 2);
  EXPECT_EQ(grid.triangles.size(), 2U * 160 * 79);
}

TEST(SphereMesh, IsClosedOfGenusZeroAndStarShapedWhateverTheDepths) {
  Random random(1);
  for (const Form& form : kForms) {
    for (const int n : {1, 2, 3, 7}) {
      const std::vector<float> inverse = random_depths(random, n);
      const StarMesh star = make(form, {n, inverse});
      expect_sphere(placed(star, {}).mesh, form.name);
      for (const Triangle& t : star.triangles) {
        ASSERT_GT(star.rays[t[0]].normalized().dot(star.rays[t[1]].normalized().cross(star.rays[t[2]].normalized())), 0)
            << form.name << ", " << n;
      }
    }
  }
}

TEST(SphereMesh, EndsAtTheRange) {
  Random random(2);
  for (const Form& form : kForms) {
    const int n = 8;
    const std::vector<float> inverse = random_depths(random, n), nothing(6 * n * n, 0);
    for (const Vec3& ray : make(form, {n, inverse}).rays) EXPECT_LE(ray.norm(), kReach * (1 + 1e-15));
    const StarMesh ball = make(form, {n, nothing});
    for (const Vec3& ray : ball.rays) EXPECT_NEAR(ray.norm(), kReach, 1e-7) << form.name;
    const auto labels = placed(ball, {}).labels;
    EXPECT_TRUE(std::all_of(labels.begin(), labels.end(), [](auto label) { return label == spheres::kRange; }));
  }
}

// Cut by planes that lie along the grid, across it, and a hair beside it.
TEST(SphereMesh, FrontHalfIsClosedAndEndsInThePlane) {
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    const Form& form = kForms[round % 7];
    const int n = random.integer(1, 7);
    const std::vector<float> inverse = random_depths(random, n);
    Vec3 normal = random.direction();
    if (round % 4 == 1) normal = Vec3::Unit(random.integer(0, 2)) * (random.chance(0.5) ? 1 : -1);
    if (round % 4 == 2) normal = (Vec3::UnitZ() + random.uniform(0, 1e-8) * random.direction()).normalized();
    if (round % 4 == 3) normal = Vec3(1, random.integer(-1, 1), random.integer(-1, 1)).normalized();
    Placement placement;
    placement.to_mesh.row(2) = normal;
    placement.to_mesh.row(0) = normal.unitOrthogonal();
    placement.to_mesh.row(1) = normal.cross(Vec3(placement.to_mesh.row(0)));
    placement.viewpoint = Vec3(3, -4, 0);
    placement.front_only = true;
    const StarMesh star = make(form, {n, inverse});
    const solid::LabelledMesh half = placed(star, placement);
    expect_sphere(half.mesh, form.name);
    ASSERT_EQ(half.labels.size(), half.mesh.triangles.size());
    for (std::size_t t = 0; t < half.labels.size(); ++t) {
      bool is_flat = true;
      for (const auto v : half.mesh.triangles[t]) {
        ASSERT_GE(half.mesh.vertices[v].z(), 0);
        is_flat = is_flat && half.mesh.vertices[v].z() == 0;
      }
      EXPECT_EQ(is_flat, half.labels[t] == spheres::kTargetPlane);
    }
    // The two halves make the whole.
    Placement other = placement;
    other.to_mesh.row(2) *= -1;
    other.to_mesh.row(0) *= -1;
    const double whole = enclosed_volume(placed(star, {}).mesh);
    EXPECT_NEAR(enclosed_volume(half.mesh) + enclosed_volume(placed(star, other).mesh), whole, 1e-6 * whole);
  }
}

// A texel of each face has a depth of its own: the mesh must show it in that direction and nowhere else.
TEST(SphereMesh, PutsEachTexelWhereTheFacesSay) {
  const int n = 5;
  const spheres::CubeGrid grid(n);
  std::vector<float> inverse(6 * n * n, 1.0F / 20);
  for (int face = 0; face < 6; ++face) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const depth::CubeFace& axes = depth::cube_faces()[face];
        const Vec3 direction = axes.forward + ((2.0 * i + 1) / n - 1) * axes.right + ((2.0 * j + 1) / n - 1) * axes.up;
        const std::size_t texel = (face * n + j) * n + i;
        inverse[texel] = 1.0F / 4;
        EXPECT_EQ(grid.texel_index(grid.texel_at(direction)), texel);
        const Mesh centers = placed(join_centers({n, inverse}, kReach), {}).mesh;
        EXPECT_NEAR(reach(centers, direction), 4, 1e-6);
        const Mesh corners = placed(bound_corners({n, inverse}, kReach), {}).mesh;
        EXPECT_NEAR(reach(corners, direction), 4, 1e-6);
        EXPECT_NEAR(reach(corners, -direction), 20, 1e-6);
        inverse[texel] = 1.0F / 20;
      }
    }
  }
}

// Random directions, and such that pass a corner of the scene closely.
TEST(SphereMesh, ConservativeOnesLieInWhatIsSeen) {
  Random random(4);
  for (int round = 0; round < 6; ++round) {
    const Scene scene = testing::random_city(random, 8, 6);
    const Vec3 from(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(0.001, 5));
    testing::BruteDepth renderer(scene.mesh);
    for (const Form& form : kForms) {
      if (!form.is_bound) continue;
      const int n = form.grid ? 14 : random.integer(9, 14);
      const std::vector<Vec3> viewpoints{from};
      Mesh mesh;
      const bool front_only = round % 2 == 1;
      const Vec3 up = Vec3::UnitZ();
      renderer.render({viewpoints, n, depth::Sampling::nearest, kReach}, [&](std::size_t, std::span<const float> w) {
        Placement placement;
        placement.front_only = front_only;
        mesh = placed(make(form, {n, w}, front_only ? &up : nullptr), placement).mesh;
      });
      for (int k = 0; k < 400; ++k) {
        const Vec3& corner = scene.mesh.vertices[random.integer(0, static_cast<int>(scene.mesh.vertices.size()) - 1)];
        Vec3 direction = random.direction();
        if (k % 2 == 1) direction = (corner - from + 0.2 * random.direction()).normalized();
        if (front_only && direction.z() < 0) direction.z() *= -1;
        const double seen = std::min(testing::first_hit(scene.mesh, from, direction), kReach);
        EXPECT_LE(reach(mesh, direction), std::max(seen, 2 * spheres::numerics::kFloor) * (1 + 1e-12)) << form.name;
      }
    }
  }
}

// Not so cautious that nothing is left: on a plain wall a bound loses about a texel.
TEST(SphereMesh, ConservativeOnesComeCloseToWhatIsSeen) {
  testing::SceneBuilder builder;
  builder.polygon("wall", {{10, -60, -60}, {10, 60, -60}, {10, 60, 60}, {10, -60, 60}});
  testing::BruteDepth renderer(builder.scene().mesh);
  const std::vector<Vec3> viewpoints{Vec3::Zero()};
  const int n = 40;
  renderer.render({viewpoints, n, depth::Sampling::nearest, kReach}, [&](std::size_t, std::span<const float> w) {
    const double half_ball = 2 * std::numbers::pi / 3 * std::pow(kReach, 3);
    const double cut = std::numbers::pi * std::pow(kReach - 10, 2) * (2 * kReach + 10) / 3;
    const double truth = 2 * half_ball - cut;
    const double corners = enclosed_volume(placed(bound_corners({n, w}, kReach), {}).mesh);
    EXPECT_LE(corners, truth);
    EXPECT_GT(corners, 0.95 * truth);
    const double lonlat = enclosed_volume(placed(bound_lonlat({n, w}, {40, 20}, kReach), {}).mesh);
    EXPECT_LE(lonlat, truth);
    EXPECT_GT(lonlat, 0.8 * truth);
  });
}

TEST(SphereMesh, IsTheSameOnAnyNumberOfThreads) {
  Random random(5);
  const int n = 64;
  const std::vector<float> inverse = random_depths(random, n);
  for (const Form& form : kForms) {
    std::vector<Vec3> rays;
    for (const int threads : {1, 4}) {
      parallel::with_threads(threads, [&] {
        const StarMesh star = make(form, {n, inverse});
        if (threads == 1) rays = star.rays;
        EXPECT_TRUE(star.rays == rays);
      });
    }
  }
}

TEST(SphereMesh, TexelsForAGridAreAtMostHalfItsStep) {
  for (const std::array<int, 2> grid : {std::array{160, 80}, {3, 2}, {1000, 30}, {30, 1000}}) {
    const double step = std::min(2 * std::numbers::pi / grid[0], std::numbers::pi / grid[1]);
    EXPECT_LE(2.0 / options::face_size_for(grid), step / 2);
    EXPECT_GE(2.0 / (options::face_size_for(grid) - 2.1), step / 2);
  }
}

}  // namespace
}  // namespace vantage
