// Volumes of the method of spheres, judged by the proof: whatever sampling finds to claim too much is refuted.
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>

#include "support/random.h"
#include "support/ray_caster.h"
#include "support/scenes.h"
#include "vantage/prove.h"
#include "vantage/spheres.h"
#include "vantage/target.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

TEST(ProveSpheres, WhateverVerifyFindsIsRefuted) {
  int over_claimed = 0, refuted = 0, proved = 0;
  for (std::uint64_t seed = 41; seed < 43; ++seed) {
    testing::Random random(seed);
    const Scene scene = testing::random_city(random, 20, 8);
    const Target target = testing::random_target(random, 4, 3, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
    const Sensor sensor{.max_range_m = 50};
    const PreparedTarget prepared(PreparedScene(scene), target, sensor);
    for (const auto sphere : {SpheresOptions::Sphere::conservative, SpheresOptions::Sphere::centers}) {
      for (const int max_splits : {0, 1}) {
        SpheresOptions options;
        options.cubemap = 32;
        options.sphere = sphere;
        options.split = SpheresOptions::Split::always;
        options.max_splits = max_splits;
        options.device.kind = DeviceChoice::Kind::cpu;
        const Volume volume = compute_visibility_spheres(prepared, options);
        ASSERT_FALSE(volume.empty());
        const VerifyReport sampled = verify_volume(scene, target, sensor, {}, volume.mesh);
        const ProofReport proof = prove_volume(scene, target, sensor, {}, volume.mesh);
        const ProofVerdict sight = proof.claims[0].verdict;
        over_claimed += sampled.over_claimed > 0 ? 1 : 0;
        refuted += sight == ProofVerdict::wrong ? 1 : 0;
        proved += sight == ProofVerdict::proved ? 1 : 0;
        if (sampled.over_claimed > 0) {
          EXPECT_EQ(sight, ProofVerdict::wrong) << sampled.worst_over_depth_m;
        }
        if (!proof.witness) continue;
        const Vec3 way = proof.witness->target_point - proof.witness->viewpoint;
        const testing::RayCaster rays(scene.mesh, proof.witness->viewpoint);
        EXPECT_LT(rays.first_hit(way.normalized(), way.norm()), way.norm() - 1e-6);
      }
    }
  }
  std::cout << "over-claimed " << over_claimed << ", refuted " << refuted << ", proved " << proved << " of 8\n";
  EXPECT_GT(over_claimed, 2);
}

}  // namespace
}  // namespace vantage
