// Booleans and comparisons of solids that all but coincide: the same volume computed in another order of the target's
// vertices, or moved by about as much as rounding.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "solid/csg.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

using solid::Solid;

Solid solid_of(const Mesh& mesh) {
  return Solid({mesh, std::vector<std::uint32_t>(mesh.triangles.size(), 0)}, "volume");
}

/// All that the booleans of two solids say must fit together. Returns the largest misfit as a thickness over the whole
/// surface, in parts of the size.
double misfit(const Mesh& mesh_a, const Mesh& mesh_b, double size) {
  const Solid a = solid_of(mesh_a), b = solid_of(mesh_b);
  const double only_a = subtract(a, b).volume(), only_b = subtract(b, a).volume(), both = intersect(a, b).volume();
  const double whole = unite(a, b).volume();
  return std::max({std::abs(a.volume() - only_a - both), std::abs(b.volume() - only_b - both),
                   std::abs(a.volume() + only_b - whole)}) /
         (a.area() * size);
}

Target reversed(Target target) {
  std::reverse(target.parts[0].begin(), target.parts[0].end());
  return target;
}

// The boolean put a corner of a facet in the wrong place: a tetrahedron of 8 litres, 4 m2 in area, facing inward.
TEST(Compare, TheSameVolumeFromTheTargetReversed) {
  Scene scene = SceneBuilder()
                    .polygon("triangle", {{-24.56262260393362, -16.49216574772089, 27.4606390679501},
                                          {-26.543190669389926, -15.273714401760344, 31.589973940968335},
                                          {-29.652417417466154, -16.354364061844898, 28.745639329681975}})
                    .scene();
  Target target = target_of({{2.8696603622185943, 0.749953284376773, 0},
                             {1.2073070821915839, 2.2135809131734514, 0},
                             {-2.8811115758073962, -0.72130701187448787, 0},
                             {1.3565686170578746, -2.1575495649085195, 0},
                             {2.2946958148060452, -1.5693297373170567, 0},
                             {2.999151966005408, -0.27577943994423609, 0}});
  target.front = Vec3::UnitZ();
  const PreparedScene prepared(scene);
  const Sensor sensor{50.52257686141341};
  const Volume a = compute_visibility(PreparedTarget(prepared, target, sensor)),
               b = compute_visibility(PreparedTarget(prepared, reversed(target), sensor));
  EXPECT_LT(misfit(a.mesh, b.mesh, sensor.max_range_m), 1e-12);
  for (const bool swapped : {false, true}) {
    const Comparison c = swapped ? compare_volumes(b.mesh, a.mesh) : compare_volumes(a.mesh, b.mesh);
    EXPECT_LT(c.only_a_m3, 1e-9 * c.volume_a_m3);
    EXPECT_LT(c.only_b_m3, 1e-9 * c.volume_a_m3);
    EXPECT_LT(c.worst_only_a_m, 1e-9);
    EXPECT_LT(c.worst_only_b_m, 1e-9);
  }
}

// Without the correction of Manifold (cmake/MendManifold.cmake) one pair in fifty is wrong.
TEST(HeavyCompare, PairsThatDifferByRounding) {
  Random random(1701);
  for (int round = 0; round < 60; ++round) {
    const double range = random.uniform(20, 80);
    Target target = random_target(random, random.integer(3, 8), 3, Vec3::Zero(), Vec3::UnitZ());
    target.front = Vec3::UnitZ();
    SceneBuilder scene;
    for (int k = random.integer(1, 4); k > 0; --k) {
      const Vec3 place(random.uniform(-0.5, 0.5) * range, random.uniform(-0.5, 0.5) * range,
                       random.uniform(0.15, 0.7) * range);
      const auto corner = [&] { return Vec3(place + 0.1 * range * random.point(-1, 1)); };
      scene.polygon("triangle", {corner(), corner(), corner()});
    }
    const PreparedScene prepared(scene);
    const ExactOptions options{range * (round % 2 == 0 ? 1e-3 : 3e-4), 0};
    const Volume a = compute_visibility(PreparedTarget(prepared, target, {range}), options);
    Mesh b = compute_visibility(PreparedTarget(prepared, reversed(target), {range}), options).mesh;
    ASSERT_EQ(a.outcome, Outcome::computed);
    const double step = round % 4 == 0 ? 0 : std::pow(10, random.uniform(-14, -3));
    const bool grows = random.chance(0.5);
    for (Vec3& v : b.vertices) v += step * (grows ? v : Vec3(1, 0.3, 0.7));
    EXPECT_LT(misfit(a.mesh, b, range), 1e-11) << "round " << round << ", moved by " << step;
  }
}

}  // namespace
}  // namespace vantage::testing
