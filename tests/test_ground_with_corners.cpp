// The space above grounds whose triangles have corners on each other's sides.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/grounds.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/navigation.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::above;
using testing::first_open_edge;
using testing::GroundCase;
using testing::kGroundCases;
using testing::make_hemisphere;
using testing::make_hills;
using testing::Random;
using testing::walls_inside;

/// Each triangle in two, at a corner on one of its sides that its neighbour there may not have.
Mesh split_in_two(const Mesh& mesh, Random& random) {
  Mesh result = mesh;
  for (Triangle& t : result.triangles) std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
  for (std::size_t i = 0, count = mesh.triangles.size(); i < count; ++i) {
    const auto [a, b, c] = result.triangles[i];
    const auto corner = static_cast<std::uint32_t>(result.vertices.size());
    const double share = random.uniform(0.1, 0.9);
    result.vertices.emplace_back(result.vertices[a] + share * (result.vertices[b] - result.vertices[a]));
    result.triangles[i] = {a, corner, c};
    result.triangles.push_back({corner, b, c});
  }
  return result;
}

TEST(GroundWithCorners, NoWallsStandWhereTheGroundGoesOn) {
  Random random(47);
  for (const GroundCase& at : kGroundCases) {
    SCOPED_TRACE(at.scale);
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    Mesh ground = make_hills(random, 50 * at.scale, 6 * at.scale, 6, at.origin);
    const Volume whole = cut_to_navigation(dome, above(ground, 4 * at.scale, 25 * at.scale));
    for (int times = 1; times <= 3; ++times) {
      ground = split_in_two(ground, random);
      const Volume cut = cut_to_navigation(dome, above(ground, 4 * at.scale, 25 * at.scale));
      ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
      EXPECT_EQ(first_open_edge(cut.mesh), "");
      EXPECT_EQ(walls_inside(cut, at.origin, 50 * at.scale), 0) << "of " << cut.mesh.triangles.size() << " facets";
      const double rounding = 1e-9 + 1e-15 * at.origin.cwiseAbs().maxCoeff() / at.scale;
      EXPECT_NEAR(enclosed_volume(cut.mesh) / enclosed_volume(whole.mesh), 1, rounding);
      EXPECT_NEAR(surface_area(cut.mesh) / surface_area(whole.mesh), 1, 1e-6 + rounding);
    }
  }
}

TEST(GroundWithCorners, AStepOfTheGroundIsNoWallAboveIt) {
  Mesh ground;  // two halves, at x = 0 one 2 m over the other, with corners of their own
  ground.vertices = {{-50, -50, 0}, {0, -50, 0},  {0, 50, 0},  {-50, 50, 0},
                     {0, -50, 2},   {50, -50, 2}, {50, 50, 2}, {0, 50, 2}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const Volume cut = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), above(ground, 4, 25));
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(walls_inside(cut, Vec3::Zero(), 50), 0) << "of " << cut.mesh.triangles.size() << " facets";
  // The upper half of the dome has no hole: the step alone is upright.
  double upright_m2 = 0;
  for (const Triangle& t : cut.mesh.triangles) {
    const Vec3 &a = cut.mesh.vertices[t[0]], &b = cut.mesh.vertices[t[1]], &c = cut.mesh.vertices[t[2]];
    if (std::max({std::abs(a.x()), std::abs(b.x()), std::abs(c.x())}) < 1e-9)
      upright_m2 += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_GT(upright_m2, 2 * 90);
  EXPECT_LT(upright_m2, 2 * 2 * 100 + 1);  // at the bottom and at the top of the band
}

}  // namespace
}  // namespace vantage
