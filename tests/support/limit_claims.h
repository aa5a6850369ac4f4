// Claims about limits of a volume over a small square, in a scene without anything else, at several scales.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "support/solids.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage::testing {

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
inline std::vector<World> worlds() {
  std::vector<World> all;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(5e5, 5e5, 100), Vec3(5e5, 5e6, 100)}) all.push_back({scale, shift});
  }
  return all;
}

/// Of a mesh over a small square that looks up, in a scene without anything else.
inline ProofReport report_of(const World& world, const Navigation& navigation, const Mesh& mesh) {
  const Target target =
      Target::polygon({world.at(-1, -1, 0), world.at(1, -1, 0), world.at(1, 1, 0), world.at(-1, 1, 0)});
  const Sensor sensor{.max_range_m = 1000 * world.scale};
  return prove_volume({}, target, sensor, navigation, mesh);
}

inline ClaimProof claim_of(const World& world, const Navigation& navigation, const Mesh& mesh) {
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

inline void expect_proved(const World& world, const Navigation& navigation, const Mesh& mesh) {
  const ClaimProof claim = claim_of(world, navigation, mesh);
  EXPECT_EQ(claim.verdict, ProofVerdict::proved) << claim.text << " scale " << world.scale;
}

/// `breaks`: of a place in the world of scale 1 about the origin, metres by which the limit is broken there.
inline void expect_wrong(const World& world, const Navigation& navigation, const Mesh& mesh,
                         const std::function<double(const Vec3&)>& breaks) {
  const ClaimProof claim = claim_of(world, navigation, mesh);
  ASSERT_EQ(claim.verdict, ProofVerdict::wrong) << claim.text << " scale " << world.scale;
  const double by = breaks(world.back(*claim.place));
  EXPECT_GT(by, 0);
  EXPECT_LE(claim.broken_by_m, by * world.scale + 1e-6 * world.scale + 1e-8) << claim.text;
}

}  // namespace vantage::testing
