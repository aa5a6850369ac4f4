#include "prove/limits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "prove/limit_checks.h"
#include "prove/limits_distance.h"
#include "prove/limits_ground.h"
#include "prove/limits_mesh.h"
#include "prove/limits_sensor.h"
#include "prove/limits_zones.h"

namespace vantage::internal::prove {
namespace {

/// Cut faces are put into such planes exactly: what a file rounded is all that is allowed.
ClaimProof prove_within_box(const std::string& name, const LimitedVolume& volume, const Box& box) {
  Broken worst;
  for (const Triangle& triangle : volume.solid().triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3& at = volume.solid().vertices[v];
      worst.see((box.min - at).cwiseMax(at - box.max).maxCoeff(), at - volume.origin());
    }
  }
  if (worst.by_m > volume.rounding_m()) return volume.wrong(name, worst, "the limit");
  return proved(name, "it holds at every vertex, and what it allows is convex");
}

}  // namespace

// All members are named: a limit that is added does not compile here before it is proved or named.
std::vector<ClaimProof> prove_limits(const LimitedVolume& volume, const LimitedVolume& seen,
                                     const std::vector<View>& parts, const Sensor& sensor, const Navigation& navigation,
                                     const core::ProgressReporter& progress) {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  check_limits(navigation);
  std::vector<ClaimProof> claims;
  if (altitude) {
    const double all = std::numeric_limits<double>::infinity();
    claims.push_back(
        prove_within_box("altitude", volume, {{-all, -all, altitude->min_m}, {all, all, altitude->max_m}}));
  }
  if (keep_in.size() == 1 && keep_in[0].is_box) {
    claims.push_back(prove_within_box("keep_in", volume, keep_in[0].box()));
  } else if (!keep_in.empty()) {
    claims.push_back(prove_keep_in(volume, navigation, progress.part(0, 0.2)));
  }
  if (!keep_out.empty()) {
    claims.push_back(prove_keep_out(volume, navigation, progress.part(0.2, 0.4)));
  }
  if (!meshes.empty()) claims.push_back(prove_meshes(volume, meshes));
  if (above_ground) claims.push_back(prove_above_ground("agl", volume, *above_ground, progress.part(0.4, 0.5)));
  if (clearance) claims.push_back(prove_clearance(volume, *clearance, progress.part(0.5, 0.7)));
  const std::vector<ClaimProof> of_sensor = prove_sensor(seen, sensor, parts, progress.part(0.7, 1));
  claims.insert(claims.end(), of_sensor.begin(), of_sensor.end());
  return claims;
}

}  // namespace vantage::internal::prove
