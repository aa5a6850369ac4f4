#include "prove/limits_sensor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "prove/limits_distance.h"
#include "prove/limits_frame.h"
#include "prove/limits_sun.h"
#include "vantage/error.h"

namespace vantage::internal::prove {
namespace {

/// The largest of what a function says of a position relative to a corner, and the normal of its part.
template <typename Excess>
double largest_of_corners(const std::vector<View>& parts, const Vec3& origin, const Vec3& position,
                          const Excess& excess) {
  double most = -std::numeric_limits<double>::infinity();
  for (const View& part : parts) {
    for (const Vec3& corner : part.whole) {
      most = std::max(most, excess(Vec3(position - (part.origin - origin + corner)), part.normal));
    }
  }
  return most;
}

/// Cones about the normals, one at each corner.
ClaimProof prove_incidence(const LimitedVolume& volume, double incidence_deg, const std::vector<View>& parts) {
  const double sine = std::sin(incidence_deg * std::numbers::pi / 180);
  const double cosine = std::cos(incidence_deg * std::numbers::pi / 180);
  return volume.judged_at_vertices("incidence", [&](const Vec3& vertex) {
    return largest_of_corners(parts, volume.origin(), vertex, [&](const Vec3& from, const Vec3& normal) {
      const double height = normal.dot(from);
      return (from - height * normal).norm() * cosine - height * sine;
    });
  });
}

/// d * d / (f h) <= size: the ball that touches the target's plane in the corner and is size * f high.
ClaimProof prove_pixel(const LimitedVolume& volume, double height_m, const std::vector<View>& parts) {
  return volume.judged_at_vertices("pixel", [&](const Vec3& vertex) {
    return largest_of_corners(parts, volume.origin(), vertex, [&](const Vec3& from, const Vec3& normal) {
      return (from - height_m / 2 * normal).norm() - height_m / 2;
    });
  });
}

}  // namespace

// All members are named: a limit that is added does not compile here before it is proved or named.
std::vector<ClaimProof> prove_sensor(const LimitedVolume& volume, const Sensor& sensor, const std::vector<View>& parts,
                                     const core::ProgressReporter& progress) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor;
  const bool is_worst_pixel = pixel && pixel->kind == PixelLimit::Kind::worst;
  if (parts.front().all_sides && (incidence_deg || is_worst_pixel)) {
    throw Error(ErrorCode::direction_invalid, "a point without a front has no plane, which the limit is about",
                incidence_deg ? "sensor incidence" : "sensor pixel", "give the target a front");
  }
  std::vector<ClaimProof> claims;
  if (min_range_m > 0) claims.push_back(prove_min_range(volume, min_range_m, parts, progress));
  if (incidence_deg) claims.push_back(prove_incidence(volume, *incidence_deg, parts));
  if (camera) claims.push_back(prove_frame(volume, sensor, parts, progress));
  if (is_worst_pixel) claims.push_back(prove_pixel(volume, pixel->size_m * *camera->focal_px, parts));
  if (sun) claims.push_back(prove_sun(volume, *sun, parts, progress));
  return claims;
}

}  // namespace vantage::internal::prove
